//! A wave and a plane that cross, each with its own pen, and their line of intersection.

use hiddenline::{
    Error, Legend, Paper, PenRole, PenRule, Sheet, StrokeKind, Surface, SurfaceLines, View,
};

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let sheets = Surface::formula("sin(x)*cos(y)")?.sheet("0.3*x")?;
    let sheets = sheets.x(-3.0, 3.0).y(-3.0, 3.0).samples(41, 41);
    let sheets = sheets.names(["sin x cos y", "0.3 x"]);
    let lines = SurfaceLines::default().intersections().legend(Legend::default());
    let crossing = PenRule::new(PenRole::Kind(StrokeKind::Intersection), 3).width_mm(0.6);
    sheets.draw(&View::default(), &lines).pens([crossing]).title("Two sheets").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_sheets.svg")?;
    sheet.save_png("plots/surface_sheets.png", 1000)
}
