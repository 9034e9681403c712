//! What all pictures have in common: from a mesh and its settings to `plots/NAME.svg` and `.png`.

use std::error::Error;
use std::fs::{File, create_dir_all};
use std::io::BufWriter;
use std::path::Path;

use hiddenline::draw::{DrawOptions, draw};
use hiddenline::framing::Framing;
use hiddenline::mesh::Mesh;
use hiddenline::page::{Dash, Page, PageOptions, PlotOptions};
use hiddenline::plot::Plot;
use hiddenline::scene::Scene;
use hiddenline::stats::Stats;
use hiddenline::strokes::Drawing;
use hiddenline::writers::png::{self, Resolution};
use hiddenline::writers::svg::{self, StrokeElement};

pub(crate) type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// A mesh, from where it is seen, how it is drawn, and on what paper.
#[allow(dead_code, reason = "surfaces are drawn without a mesh")]
pub(crate) struct Sheet {
    pub(crate) title: &'static str,
    pub(crate) mesh: Mesh,
    pub(crate) framing: Framing,
    pub(crate) draw: DrawOptions,
    pub(crate) page: PageOptions,
}

#[allow(dead_code, reason = "surfaces are drawn without a mesh")]
impl Sheet {
    /// The finished page.
    pub(crate) fn plot(self) -> Result<Plot> {
        let camera = self.framing.camera(self.mesh.bounds().unwrap_or_default())?;
        let scene = Scene::new(self.mesh);
        let mm_per_unit = |drawing: &Drawing| {
            Page::new(drawing, &camera, &self.page).map_or(1.0, |page| page.mm_per_image_unit())
        };
        let drawing = draw(&scene, &camera, &self.draw, mm_per_unit, &mut Stats::default());
        let options = PlotOptions {
            pen_width_mm: 0.3,
            pens: Vec::new(),
            hidden: self.draw.hidden,
            dash: Dash::default(),
            title: self.title.into(),
            source: String::new(),
        };
        Ok(Page::new(&drawing, &camera, &self.page)?.plot(&drawing, options).plot)
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
