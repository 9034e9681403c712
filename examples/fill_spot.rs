//! Spot, a cow, in five inks that lie beside each other, below her visible lines.

mod plots;

use std::path::Path;

use hiddenline::stages::camera::framing::{Standpoint, View};
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::model::arrange::{Arrangement, Pose, UpAxis};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::page::{Page, PageOptions};
use hiddenline::stages::plot::Plot;
use hiddenline::stages::read::read_file;
use hiddenline::stages::shading::fill::{DEFAULT_SEAM_MM, FillOptions, Palette, fill};

use plots::{Result, plot_options, save};

/// From night to noon.
const INKS: [[u8; 3]; 5] = [
    [0x2b, 0x2d, 0x42],
    [0x5a, 0x4a, 0x6a],
    [0xa8, 0x5d, 0x6e],
    [0xe5, 0x98, 0x72],
    [0xf8, 0xdc, 0xa8],
];

pub(crate) fn plot() -> Result<Plot> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/models/spot.obj");
    let model = read_file(Path::new(path), None)?;
    let upright = Arrangement { up_axis: UpAxis::Y, ..Arrangement::default() };
    let (mesh, _) = upright.arrange(vec![(model.mesh, Pose::default())])?;
    let standpoint =
        Standpoint::Angles { azimuth_deg: 215.0, elevation_deg: 14.0, distance: Some(4.5) };
    let framing = View { standpoint, ..View::default() };
    let camera = framing.camera(mesh.bounds().unwrap_or_default())?;
    let scene = Scene::new(mesh);
    let palette = Some(Palette::Inks(INKS.to_vec()));
    let options = FillOptions { palette, paint: Some([255, 240, 210]), ..FillOptions::default() };
    let filled = fill(&scene, &camera, &options)?;
    let page = Page::place(&scene.extent(&camera), &camera, &PageOptions::default())?;
    let edges = draw(&scene, &camera, &DrawOptions::default(), page.mm_per_image_unit()).drawing;
    Ok(page
        .plot(&edges, plot_options("Spot in five inks"))
        .with_fills(&page, &filled.layers, DEFAULT_SEAM_MM)
        .plot)
}

fn main() -> Result<()> {
    save("fill_spot", &plot()?)
}
