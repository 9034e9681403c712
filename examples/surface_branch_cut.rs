//! The angle of a point in the plane, open along its cut.

use hiddenline::{Axes, Error, Paper, Sheet, Surface, SurfaceLines, TickRule, Titles, View};

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let angle = Surface::formula("atan2(y, x)")?.x(-2.0, 2.0).y(-2.0, 2.0).samples(60, 60);
    let ticks = [TickRule::Round, TickRule::Round, TickRule::Pi];
    let axes = Axes::from(Titles::of_drawing("θ = atan2(y, x)")).ticks(ticks);
    let lines = SurfaceLines::default().axes(axes);
    angle.draw(&View::default(), &lines).title("A branch cut").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_branch_cut.svg")?;
    sheet.save_png("plots/surface_branch_cut.png", 1000)
}
