//! A map of a volcano whose heights are whole meters, every fifth curve heavy and labeled.

use hiddenline::{
    Axes, Error, Formula, Grid, LegendPlace, Levels, Paper, Sheet, Surface, SurfaceLines, Titles,
    Variables, View,
};

/// A cone with gullies, less its crater, in meters.
const VOLCANO: &str = "95 + 100*(exp(-(r/3.2)^1.5)*(1 + 0.03*sin(7*theta + 2*sin(r))*min(1, r/2)) \
                       - 0.75*exp(-(r/0.85)^2)) + 6*sin(0.7*x - 1)*cos(0.5*y)";

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let volcano = Formula::parse(VOLCANO, Variables::Plane)?;
    let height = |x, y| volcano.value(x / 90.0 - 4.4, y / 90.0 - 3.4).round();
    let map = Surface::grid(Grid::from_fn((0.0, 860.0), (0.0, 600.0), (87, 61), height)?);
    let levels = Levels::Every { step: 5.0, offset: 0.0 };
    let lines = SurfaceLines::default().no_grid_lines().levels(levels).legend(LegendPlace::Bottom);
    let titles = ["x in m", "y in m", ""].map(str::to_owned);
    let lines = lines.axes(Axes::from(Titles { axes: titles, drawing: String::new() }));
    map.draw(&View::top(), &lines).title("Map of a volcano").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_map.svg")?;
    sheet.save_png("plots/surface_map.png", 1000)
}
