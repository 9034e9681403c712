//! Three peaks above their level curves.

use hiddenline::{
    Aspect, Axes, AxesStyle, Error, Levels, Paper, PenRole, PenRule, Sheet, StrokeKind, Surface,
    SurfaceLines, View,
};

/// The peaks of MATLAB.
const PEAKS: &str = "3*(1 - x)^2*exp(-x^2 - (y + 1)^2) - 10*(x/5 - x^3 - y^5)*exp(-x^2 - y^2) \
                     - exp(-(x + 1)^2 - y^2)/3";

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let peaks = Surface::formula(PEAKS)?.x(-3.0, 3.0).y(-3.0, 3.0).samples(51, 51);
    let peaks = peaks.z(-20.0, 10.0).aspect(Aspect::Lengths([4.0, 4.0, 3.0]));
    let levels = Levels::Every { step: 1.0, offset: 0.0 };
    let lines = SurfaceLines::default().silhouette().levels(levels).project_levels();
    let lines = lines.negative_dashed().axes(Axes::new(AxesStyle::Back));
    let pens = [(StrokeKind::Back, 2), (StrokeKind::Index, 3)]
        .map(|(kind, number)| PenRule::new(PenRole::Kind(kind), number))
        .map(|rule| match rule.number {
            2 => rule.width_mm(0.2),
            _ => rule.width_mm(0.5).color("#000000"),
        });
    peaks.draw(&View::default(), &lines).pens(pens).title("Peaks and levels").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_levels.svg")?;
    sheet.save_png("plots/surface_levels.png", 1000)
}
