//! What the pen travels between strokes.

use glam::{DVec3, dvec3};
use hiddenline::stages::chain::grid_lines::{GridLines, strokes};
use hiddenline::stages::engines::surface::{CellOrder, max_min};
use hiddenline::stages::surface::formula::{Formula, Variables};
use hiddenline::stages::surface::{CutGrid, Grid, GridCuts};

use super::max_min::{PERSPECTIVE, camera};

#[test]
fn the_pen_is_up_for_less_than_half_of_what_it_draws() {
    for (text, height) in
        [("sinc(r)", 8.0), ("sin(x)*cos(y)", 1.0), ("max(0, sin(x)*sin(y))^4", 3.0)]
    {
        let formula = Formula::parse(text, Variables::Plane).expect("a formula");
        let mut grid =
            Grid::sample(&formula, (-12.0, 12.0), (-12.0, 12.0), (121, 121)).expect("a grid");
        grid.scale_heights(height);
        for eye in [dvec3(20.0, -30.0, 25.0), dvec3(20.0, -30.0, 6.0), dvec3(1.0, -25.0, 4.0)] {
            let camera = camera(eye, DVec3::ZERO, PERSPECTIVE);
            let pieces = max_min::solve(&grid, &camera, CellOrder::Rows).expect("a drawing");
            let drawing = strokes(
                &CutGrid { grid: &grid, cuts: &GridCuts::NONE },
                &pieces,
                &camera,
                &GridLines::default(),
            );
            let (mut up, mut down, mut pen) = (0.0, 0.0, None);
            for stroke in drawing.iter() {
                up += pen.map_or(0.0, |pen: glam::DVec2| pen.distance(stroke.points[0]));
                down += stroke.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>();
                pen = stroke.points.last().copied();
            }
            eprintln!("{text} from {eye}: {:.3} up for 1 down", up / down);
            assert!(up <= 0.5 * down, "{text} from {eye}: {up} up, {down} down");
        }
    }
}
