//! How an oscillator answers, on logarithmic axes: the damping runs backward, and the box has lengths
//! of its own.

use hiddenline::{
    Aspect, Axes, AxesStyle, Error, Paper, Sheet, Surface, SurfaceLines, Titles, View,
};

pub(crate) fn sheet() -> Result<Sheet, Error> {
    let gain = Surface::formula("1 / sqrt((1 - (x/10)^2)^2 + (2*y*x/10)^2)")?;
    let gain = gain.x(0.1, 1000.0).y(1.0, 0.05).samples(241, 81);
    let gain = gain.log([true, false, true]).aspect(Aspect::Lengths([4.0, 4.0, 3.0]));
    let axes = ["ω in rad s⁻¹", "ζ", "|H|"].map(str::to_owned);
    let titles = Titles { axes, ..Titles::default() };
    let lines = SurfaceLines::default().every(4).smoothness_mm(0.0);
    let lines = lines.axes(Axes::new(AxesStyle::Back).titles(titles));
    gain.draw(&View::default(), &lines).title("Gain of an oscillator").on(Paper::A5)
}

fn main() -> Result<(), Error> {
    let sheet = sheet()?;
    sheet.save("plots/surface_resonance.svg")?;
    sheet.save_png("plots/surface_resonance.png", 1000)
}
