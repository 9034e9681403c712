//! What all pictures have in common: how they are drawn on paper, and kept as `plots/NAME.svg` and `.png`.

use std::error::Error;
use std::fs::{File, create_dir_all};
use std::io::BufWriter;
use std::path::Path;

use hiddenline::stages::page::{Dash, PlotOptions};
use hiddenline::stages::plot::Plot;
use hiddenline::stages::strokes::HiddenLines;
use hiddenline::stages::write::png::{self, Resolution};
use hiddenline::stages::write::svg::{self, StrokeElement};

pub(crate) type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// One pen, and no hidden lines.
pub(crate) fn plot_options(title: &str) -> PlotOptions {
    PlotOptions {
        pen_width_mm: 0.3,
        pens: Vec::new(),
        hidden: HiddenLines::None,
        dash: Dash::default(),
        keep_dashes_whole: false,
        title: title.into(),
        source: String::new(),
    }
}

/// Writes `plots/NAME.svg` and `plots/NAME.png`.
pub(crate) fn save(name: &str, plot: &Plot) -> Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("plots");
    create_dir_all(&folder)?;
    let create = |extension| File::create(folder.join(name).with_extension(extension));
    svg::write(plot, StrokeElement::Path, &mut BufWriter::new(create("svg")?))?;
    png::write(plot, Resolution::WidthPx(1000), &mut BufWriter::new(create("png")?))?;
    Ok(())
}
