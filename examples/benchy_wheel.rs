//! The steering wheel of a small boat, with the edges that it hides dashed.

mod plots;
mod sheet;

use std::path::Path;

use hiddenline::stages::camera::framing::{Standpoint, View};
use hiddenline::stages::draw::DrawOptions;
use hiddenline::stages::page::PageOptions;
use hiddenline::stages::plot::Plot;
use hiddenline::stages::read::read_file;
use hiddenline::stages::strokes::HiddenLines;

use plots::{Result, save};
use sheet::Sheet;

pub(crate) fn plot() -> Result<Plot> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/models/benchy_wheel.stl");
    let mesh = read_file(Path::new(path), None)?.mesh;
    let standpoint = Standpoint::Angles { azimuth_deg: 205.0, elevation_deg: 20.0, distance: None };
    Sheet {
        title: "Wheel of a 3DBenchy",
        mesh,
        framing: View { standpoint, ..View::default() },
        draw: DrawOptions { hidden: HiddenLines::Dashed, ..DrawOptions::default() },
        page: PageOptions::default(),
    }
    .plot()
}

fn main() -> Result<()> {
    save("benchy_wheel", &plot()?)
}
