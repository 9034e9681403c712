//! One formula for three values of a parameter.

use hiddenline::{
    Axes, AxesStyle, Error, Legend, Paper, ParameterList, Sheet, Surface, SurfaceLines, View,
};

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let a = ParameterList::new("a", [1.0, 2.0, 3.0])?;
    let bells = Surface::formula_for("a + exp(-a*r^2/2)", &[a])?.x(-3.0, 3.0).y(-3.0, 3.0);
    let bells = bells.samples(41, 41).aspect(hiddenline::Aspect::Lengths([4.0, 4.0, 3.0]));
    let lines = SurfaceLines::default().legend(Legend::default()).axes(Axes::new(AxesStyle::Box));
    bells.draw(&View::default(), &lines).title("Three values of a").on(Paper::A4)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_bells.svg")?;
    sheet.save_png("plots/surface_bells.png", 1000)
}
