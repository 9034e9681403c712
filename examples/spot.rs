//! Spot, a cow: every visible edge of her mesh.

mod plots;
mod sheet;

use std::path::Path;

use hiddenline::stages::camera::framing::{Standpoint, View};
use hiddenline::stages::classify::LineSelection;
use hiddenline::stages::draw::DrawOptions;
use hiddenline::stages::model::arrange::{Arrangement, Pose, UpAxis};
use hiddenline::stages::page::PageOptions;
use hiddenline::stages::plot::Plot;
use hiddenline::stages::read::read_file;

use plots::{Result, save};
use sheet::Sheet;

pub(crate) fn plot() -> Result<Plot> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/models/spot.obj");
    let model = read_file(Path::new(path), None)?;
    let upright = Arrangement { up_axis: UpAxis::Y, ..Arrangement::default() };
    let (mesh, _) = upright.arrange(vec![(model.mesh, Pose::default())])?;
    let standpoint =
        Standpoint::Angles { azimuth_deg: 215.0, elevation_deg: 14.0, distance: Some(4.5) };
    Sheet {
        title: "Spot",
        mesh,
        framing: View { standpoint, ..View::default() },
        draw: DrawOptions { lines: LineSelection::all_edges(), ..DrawOptions::default() },
        page: PageOptions::default(),
    }
    .plot()
}

fn main() -> Result<()> {
    save("spot", &plot()?)
}
