//! The pictures in `plots/` are what the examples draw. `UPDATE=1 cargo test` draws them anew.

use std::path::Path;

use hiddenline::plot::Plot;
use hiddenline::writers::png::{self, Resolution};
use hiddenline::writers::svg::{self, StrokeElement};

fn is_up_to_date(name: &str, plot: &Plot) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("plots").join(name);
    let mut drawn = Vec::new();
    svg::write(plot, StrokeElement::Path, &mut drawn).expect("memory takes everything");
    let drawn = String::from_utf8(drawn).expect("an SVG is text");
    let path = path.with_extension("svg");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &drawn).expect("plots/ can be written");
        let mut picture = Vec::new();
        png::write(plot, Resolution::WidthPx(1000), &mut picture).expect("a picture");
        std::fs::write(path.with_extension("png"), picture).expect("plots/ can be written");
    }
    let kept = std::fs::read_to_string(&path).expect("the picture is in plots/");
    let different = kept.lines().zip(drawn.lines()).position(|(kept, drawn)| kept != drawn);
    assert!(
        kept == drawn,
        "{} is not what the example draws, first in line {:?} (counted from 0) of {} and {}; \
         UPDATE=1 draws it anew",
        path.display(),
        different,
        kept.lines().count(),
        drawn.lines().count(),
    );
}

/// One test for each example, which is compiled into this binary.
macro_rules! pictures {
    ($($name:ident $test:ident $path:literal;)*) => {
        $(
            #[path = $path]
            #[allow(dead_code, clippy::duplicate_mod)]
            mod $name;

            #[test]
            fn $test() {
                is_up_to_date(stringify!($name), &$name::plot().expect("a drawing"));
            }
        )*
    };
}

pictures! {
    benchy_wheel the_wheel_is_up_to_date "../../examples/benchy_wheel.rs";
    city the_city_is_up_to_date "../../examples/city.rs";
    fill_spot the_cow_in_inks_is_up_to_date "../../examples/fill_spot.rs";
    menger the_sponge_is_up_to_date "../../examples/menger.rs";
    platonic the_solids_are_up_to_date "../../examples/platonic.rs";
    spiral_stair the_stair_is_up_to_date "../../examples/spiral_stair.rs";
    spot the_cow_is_up_to_date "../../examples/spot.rs";
    surface_klein the_bottle_is_up_to_date "../../examples/surface_klein.rs";
    surface_saddle the_saddle_is_up_to_date "../../examples/surface_saddle.rs";
    surface_sinc the_hat_is_up_to_date "../../examples/surface_sinc.rs";
    surface_sphere the_sphere_is_up_to_date "../../examples/surface_sphere.rs";
    surface_spikes the_spikes_are_up_to_date "../../examples/surface_spikes.rs";
    surface_terrain the_landscape_is_up_to_date "../../examples/surface_terrain.rs";
    surface_torus the_torus_is_up_to_date "../../examples/surface_torus.rs";
    surface_volcano the_volcano_is_up_to_date "../../examples/surface_volcano.rs";
    surface_peaks the_peaks_are_up_to_date "../../examples/surface_peaks.rs";
    torus_knot the_knot_is_up_to_date "../../examples/torus_knot.rs";
}

#[test]
fn every_picture_has_its_example() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let names = |folder: &str, extension: &str| -> Vec<String> {
        let entries = root.join(folder).read_dir().expect("the folder is there");
        let paths = entries.map(|entry| entry.expect("it can be listed").path());
        let mut names: Vec<_> = paths
            .filter(|path| path.extension().is_some_and(|found| found == extension))
            .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    };
    let examples = names("examples", "rs");
    assert_eq!(names("plots", "svg"), examples);
    assert_eq!(names("plots", "png"), examples);
    let tests = include_str!("gallery.rs");
    assert!(examples.iter().all(|name| tests.contains(&format!("/examples/{name}.rs"))));
}
