//! Draws sinc hat, saddle, peaks and a generated volcano as SVG into a folder.

use std::fmt::Write as _;

use glam::{DVec3, dvec3};
use hiddenline::engines::surface::{Lines, Order, max_min, strokes};
use hiddenline::formula::{Formula, Variables};
use hiddenline::surface::Grid;
use hiddenline::view::{Camera, Projection};

const SURFACES: [(&str, &str, f64, usize, f64); 6] = [
    ("sinc", "sinc(r)", 12.0, 81, 8.0),
    ("saddle", "x*y*(x^2 - y^2)/(x^2 + y^2 + 1e-30)", 2.0, 41, 1.0),
    (
        "peaks",
        "3*(1-x)^2*exp(-x^2-(y+1)^2) - 10*(x/5-x^3-y^5)*exp(-x^2-y^2) - exp(-(x+1)^2-y^2)/3",
        3.0,
        61,
        0.3,
    ),
    (
        "volcano",
        "3*exp(-r^2/6) - 2.2*exp(-r^2/0.5) + 0.12*sin(9*theta + 3*r)*exp(-r/2)",
        5.0,
        121,
        1.4,
    ),
    ("ripple", "cos(3*r)/(1 + r)", 6.0, 161, 2.0),
    ("spikes", "max(0, sin(5*x)*sin(5*y))^8", 2.0, 121, 2.0),
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".to_owned());
    for (name, text, half, n, height) in SURFACES {
        let formula = Formula::parse(text, Variables::Plane)?;
        let mut grid = Grid::sample(&formula, (-half, half), (-half, half), (n, n))?;
        grid.scale_heights(height);
        let projection = Projection::Perspective { fov_deg: 30.0, near: 1e-6 };
        let eye = dvec3(0.5, -1.0, 0.75) * half * 3.5;
        let camera = Camera::new(eye, DVec3::ZERO, DVec3::Z, projection)?;
        let pieces = max_min::solve(&grid, &camera, Order::Rows)?;
        let drawing = strokes(&grid, &pieces, &camera, &Lines::default());
        let (low, high) = drawing.bounds().ok_or("nothing to draw")?;
        let scale = 277.0 / (high - low).max_element();
        let mut svg = String::new();
        for stroke in drawing.iter() {
            for (k, p) in stroke.points.iter().enumerate() {
                let letter = if k == 0 { 'M' } else { 'L' };
                write!(
                    svg,
                    "{letter}{:.3} {:.3}",
                    10.0 + (p.x - low.x) * scale,
                    10.0 + (high.y - p.y) * scale
                )?;
            }
        }
        let size = (high - low) * scale + 20.0;
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0}mm\" height=\"{1:.0}mm\" viewBox=\"0 0 {0:.0} {1:.0}\"><path d=\"{svg}\" fill=\"none\" stroke=\"#000\" stroke-width=\"0.2\"/></svg>\n",
            size.x, size.y
        );
        std::fs::write(format!("{folder}/{name}.svg"), svg)?;
    }
    Ok(())
}
