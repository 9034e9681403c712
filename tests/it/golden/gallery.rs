//! The pictures in `plots/` are what the examples draw. `UPDATE=1 cargo test` draws them anew.

use std::path::Path;

use hiddenline::stages::plot::Plot;
use hiddenline::stages::write::png::{self, Resolution};
use hiddenline::stages::write::svg::{self, StrokeElement};

use crate::program::hiddenline;

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
                is_up_to_date(stringify!($name), &$name::sheet().expect("a drawing").into());
            }
        )*
    };
}

pictures! {
    benchy_wheel the_wheel_is_up_to_date "../../../examples/benchy_wheel.rs";
    city the_city_is_up_to_date "../../../examples/city.rs";
    fill_spot the_cow_in_inks_is_up_to_date "../../../examples/fill_spot.rs";
    hatch_ripples the_ripples_are_up_to_date "../../../examples/hatch_ripples.rs";
    hatch_spot the_hatched_cow_is_up_to_date "../../../examples/hatch_spot.rs";
    hatch_temple the_temple_is_up_to_date "../../../examples/hatch_temple.rs";
    menger the_sponge_is_up_to_date "../../../examples/menger.rs";
    platonic the_solids_are_up_to_date "../../../examples/platonic.rs";
    spiral_stair the_stair_is_up_to_date "../../../examples/spiral_stair.rs";
    spot the_cow_is_up_to_date "../../../examples/spot.rs";
    torus_knot the_knot_is_up_to_date "../../../examples/torus_knot.rs";
    surface_branch_cut the_cut_is_up_to_date "../../../examples/surface_branch_cut.rs";
    surface_pole_ring the_ring_is_up_to_date "../../../examples/surface_pole_ring.rs";
    surface_klein the_bottle_is_up_to_date "../../../examples/surface_klein.rs";
    surface_saddle the_saddle_is_up_to_date "../../../examples/surface_saddle.rs";
    surface_sinc the_hat_is_up_to_date "../../../examples/surface_sinc.rs";
    surface_sphere the_sphere_is_up_to_date "../../../examples/surface_sphere.rs";
    surface_spikes the_spikes_are_up_to_date "../../../examples/surface_spikes.rs";
    surface_terrain the_landscape_is_up_to_date "../../../examples/surface_terrain.rs";
    surface_torus the_torus_is_up_to_date "../../../examples/surface_torus.rs";
    surface_volcano the_volcano_is_up_to_date "../../../examples/surface_volcano.rs";
    surface_walls the_walls_are_up_to_date "../../../examples/surface_walls.rs";
    surface_room the_room_is_up_to_date "../../../examples/surface_room.rs";
    surface_resonance the_resonance_is_up_to_date "../../../examples/surface_resonance.rs";
    surface_cross the_cross_is_up_to_date "../../../examples/surface_cross.rs";
    surface_map the_map_is_up_to_date "../../../examples/surface_map.rs";
    surface_levels the_levels_are_up_to_date "../../../examples/surface_levels.rs";
    surface_sheets the_sheets_are_up_to_date "../../../examples/surface_sheets.rs";
    surface_bells the_bells_are_up_to_date "../../../examples/surface_bells.rs";
    surface_peaks the_peaks_are_up_to_date "../../../examples/surface_peaks.rs";
}

/// The names of the files in a folder that have an extension, without it.
fn names(folder: &str, extension: &str) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = folder.read_dir().expect("the folder is there");
    let paths = entries.map(|entry| entry.expect("it can be listed").path());
    let mut names: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|found| found == extension))
        .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// Columns, rows and pixels of a PNG.
fn pixels(bytes: &[u8]) -> (u32, u32, Vec<u8>) {
    let decoder = ::png::Decoder::new(std::io::Cursor::new(bytes));
    let mut reader = decoder.read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut pixels).expect("a picture");
    (info.width, info.height, pixels)
}

/// The commands in the README make the pictures.
#[test]
fn previews_are_up_to_date() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = std::fs::read_to_string(root.join("README.md")).expect("a README");
    let readme = readme.replace("\\\n", " ");
    let names = names("plots/preview", "png");
    assert!(!names.is_empty());
    for name in names {
        let end = format!("-o {name}.png");
        let arguments = readme
            .lines()
            .filter_map(|line| line.strip_prefix("cargo run --release -- ")?.strip_suffix(&end))
            .find(|arguments| arguments.starts_with("preview "))
            .unwrap_or_else(|| panic!("no command in the README makes {name}.png"));
        let arguments: Vec<&str> = arguments.split_whitespace().collect();
        let output = hiddenline(root, &[&arguments[..], &["-o", "-"]].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let path = root.join("plots/preview").join(name).with_extension("png");
        if std::env::var_os("UPDATE").is_some() {
            std::fs::write(&path, &output.stdout).expect("plots/ can be written");
        }
        let kept = pixels(&std::fs::read(&path).expect("the picture is in plots/"));
        let drawn = pixels(&output.stdout);
        assert_eq!((kept.0, kept.1), (drawn.0, drawn.1), "{}", path.display());
        let different = kept.2.iter().zip(&drawn.2).filter(|(kept, drawn)| kept != drawn).count();
        assert!(
            different == 0,
            "{} is not what the README's command makes: {different} of {} bytes differ; \
             UPDATE=1 makes it anew",
            path.display(),
            kept.2.len(),
        );
    }
}

#[test]
fn every_picture_has_its_example() {
    let examples = names("examples", "rs");
    assert_eq!(names("plots", "svg"), examples);
    // The screenshot of the viewer is taken in a browser.
    let mut pictures = names("plots", "png");
    pictures.retain(|name| name != "viewer");
    assert_eq!(pictures, examples);
    let tests = include_str!("gallery.rs");
    assert!(examples.iter().all(|name| tests.contains(&format!("/examples/{name}.rs"))));
}
