//! `optimize` on paper and machines: pages, cropping, pens, and what plotters reach.

use std::fs;
use std::path::Path;

use hiddenline::stages::write::hpgl;
use tempfile::TempDir;

use super::{CUBE, assert_fails, hiddenline, text};

fn folder_with(name: &str, size: &str, content: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:inkscape=\
         'http://www.inkscape.org/namespaces/inkscape' {size} fill='none' stroke='black'>{content}</svg>"
    );
    fs::write(folder.path().join(name), svg).unwrap();
    folder
}

const A4: &str = "width='297mm' height='210mm' viewBox='0 0 297 210'";

/// Runs `optimize` and returns what it wrote and said.
#[track_caller]
fn optimized(folder: &Path, arguments: &[&str], output: &str) -> (String, String) {
    let all = [&["optimize", "a.svg", "-o", output], arguments].concat();
    let run = hiddenline(folder, &all);
    let said = text(&run.stderr);
    assert!(run.status.success(), "{said}");
    (fs::read_to_string(folder.join(output)).unwrap(), said)
}

/// All numbers after M and L in an SVG.
fn svg_points(svg: &str) -> Vec<[f64; 2]> {
    let paths = svg.split(" d=\"").skip(1).map(|rest| rest.split('"').next().unwrap());
    let points = paths.flat_map(|d| d.split(['M', 'L', 'Z']).filter(|p| !p.is_empty()));
    points
        .map(|p| {
            let mut numbers = p.split(' ').map(|n| n.parse().unwrap());
            [numbers.next().unwrap(), numbers.next().unwrap()]
        })
        .collect()
}

#[test]
fn ink_off_the_page_is_cropped_and_told() {
    let folder = folder_with("a.svg", A4, "<path d='M-50 100H400'/><path d='M100 -50V0.5'/>");
    let (svg, said) = optimized(folder.path(), &[], "o.svg");
    assert!(said.contains("203.0 mm of ink are cut off outside of the page"), "{said}");
    assert!(svg_points(&svg).iter().all(|&[x, y]| (0.0..=297.0).contains(&x) && y >= 0.0));
    let (svg, said) = optimized(folder.path(), &["--crop", "none"], "o.svg");
    assert!(!said.contains("warning"), "{said}");
    assert!(svg_points(&svg).contains(&[400.0, 100.0]));
    let (svg, said) = optimized(folder.path(), &["--crop", "margin", "--margin", "10"], "o.svg");
    assert_eq!(svg_points(&svg), [[10.0, 100.0], [287.0, 100.0]]);
    assert!(said.contains("outside of the margins"), "{said}");
    let strict = hiddenline(folder.path(), &["optimize", "a.svg", "--strict", "-o", "n.svg"]);
    assert_fails(&strict, 1, "ink are cut off");
    assert!(!folder.path().join("n.svg").exists());
}

#[test]
fn dots_off_the_page_are_lost_and_lines_that_no_machine_draws_are_not() {
    let layer = |label: &str, d: &str| {
        format!("<g inkscape:groupmode='layer' inkscape:label='{label}'><path d='{d}'/></g>")
    };
    let content = layer("%guide", "M100 100H400") + &layer("1 ink", "M-5 5h0M300 5h0M10 10h50");
    let folder = folder_with("a.svg", A4, &content);
    let (_, said) = optimized(folder.path(), &[], "o.svg");
    assert!(said.contains("warning: 2 dots are cut off outside of the page"), "{said}");
}

#[test]
fn drawings_are_put_on_other_sheets() {
    let folder = folder_with("a.svg", A4, "<path d='M100 100H200V150'/>");
    let page = |svg: &str, size: &str| assert!(svg.contains(size), "{}", &svg[..300]);
    let (svg, _) = optimized(folder.path(), &["--page", "a3", "--fit", "--margin", "20"], "o.svg");
    page(&svg, "width=\"420mm\"");
    let points = svg_points(&svg);
    let low = points.iter().fold([f64::MAX; 2], |m, p| [m[0].min(p[0]), m[1].min(p[1])]);
    let high = points.iter().fold([f64::MIN; 2], |m, p| [m[0].max(p[0]), m[1].max(p[1])]);
    // 100 x 50 in 380 x 257: as wide as the margins allow, in the middle.
    assert_eq!((low, high), ([20.0, 53.5], [400.0, 243.5]));
    let (svg, _) = optimized(folder.path(), &["--page", "a4", "--portrait", "--center"], "o.svg");
    page(&svg, "height=\"297mm\"");
    let points = svg_points(&svg);
    assert!(points.contains(&[55.0, 123.5]) && points.contains(&[155.0, 173.5]), "{points:?}");
    let all = ["optimize", "a.svg", "--margin", "200", "--fit", "-o", "n.svg"];
    assert_fails(&hiddenline(folder.path(), &all), 1, "margins of 200 mm");
}

/// Length with the pen down in millimeters, the pens, and the commands of an HPGL file.
fn hpgl_ink(plt: &str, unit: f64) -> (f64, Vec<u32>) {
    let (mut here, mut down, mut relative) = ([0.0, 0.0], false, false);
    let (mut length, mut pens) = (0.0, Vec::new());
    for instruction in plt.split(';').map(str::trim).filter(|i| i.len() >= 2) {
        let (name, rest) = instruction.split_at(2);
        let numbers: Vec<f64> =
            rest.split(',').filter(|n| !n.is_empty()).map(|n| n.parse().unwrap()).collect();
        match name {
            "PA" => relative = false,
            "PR" => relative = true,
            "PU" => down = false,
            "PD" => down = true,
            "SP" if numbers[0] > 0.0 => pens.push(numbers[0] as u32),
            _ => continue,
        }
        if name.starts_with('P') {
            for xy in numbers.chunks(2) {
                let to = if relative { [here[0] + xy[0], here[1] + xy[1]] } else { [xy[0], xy[1]] };
                if down {
                    length += f64::hypot(to[0] - here[0], to[1] - here[1]);
                }
                here = to;
            }
        }
    }
    (length * unit, pens)
}

#[test]
fn plotters_get_pens_by_color_and_numbers_from_labels() {
    let colors = "<path stroke='#808080' d='M50 50h100'/><path d='M50 60h100'/>\
                  <path stroke='#2ecc71' d='M50 70h100'/>";
    let folder = folder_with("a.svg", A4, colors);
    let (plt, _) = optimized(folder.path(), &["--machine", "hp7475a"], "o.plt");
    assert_eq!(hpgl_ink(&plt, 0.02488).1, [1, 2, 3]);
    let layer = |label: &str, y: u32| {
        format!(
            "<g inkscape:groupmode='layer' inkscape:label='{label}' stroke='#0000{y}'>\
             <path d='M50 {y}h100'/></g>"
        )
    };
    let labels = ["10 blue", "2 red", "%guide", "Background"];
    let content: String = labels.iter().zip([50, 60, 70, 80]).map(|(l, y)| layer(l, y)).collect();
    let folder = folder_with("a.svg", A4, &content);
    let (plt, said) = optimized(folder.path(), &["--machine", "hp7475a"], "o.plt");
    let (length, mut pens) = hpgl_ink(&plt, 0.02488);
    pens.sort_unstable();
    assert_eq!(pens, [1, 2, 3]);
    assert!((length - 300.0).abs() < 0.2, "{length}: % layers are not plotted");
    assert!(!said.contains("guide"), "{said}");
    let (svg, _) = optimized(folder.path(), &[], "o.svg");
    assert!(
        svg.contains("inkscape:label=\"%guide\"") && svg.contains("inkscape:label=\"Background\"")
    );
}

#[test]
fn more_colors_than_pens_are_told_with_the_remedy() {
    let line = |i: u32| format!("<path stroke='#0000{i:02x}' d='M50 {}h100'/>", 50 + i);
    let folder = folder_with("a.svg", A4, &(1..8).map(line).collect::<String>());
    let arguments = ["optimize", "a.svg", "--machine", "hp7475a", "-o", "o.plt"];
    let run = hiddenline(folder.path(), &arguments);
    assert_fails(&run, 1, "needs 7 pens and HP 7475A holds 6; use --pen visible=1");
    let (plt, _) =
        optimized(folder.path(), &["--machine", "hp7475a", "--pen", "visible=4"], "o.plt");
    assert_eq!(hpgl_ink(&plt, 0.02488).1, [4]);
}

/// For each machine and paper: a frame along what the pen reaches loses nothing; one along the
/// edges of the sheet does, and the program says how much.
#[test]
fn no_machine_loses_ink_silently() {
    for machine in hpgl::machines().unwrap() {
        let paper = &machine.paper[0];
        let [w, h] = paper.size;
        let size = format!("width='{w}mm' height='{h}mm' viewBox='0 0 {w} {h}'");
        let frame = format!("<rect x='1' y='1' width='{}' height='{}'/>", w - 2.0, h - 2.0);
        let folder = folder_with("a.svg", &size, &frame);
        let arguments = ["--machine", &machine.name];
        let (plt, _) = optimized(folder.path(), &[&arguments[..], &["--fit"]].concat(), "o.plt");
        let (fitted, _) = hpgl_ink(&plt, machine.unit);
        assert!(fitted > 1.4 * (w + h), "{}: {fitted} mm", machine.name);
        let strict = [&["optimize", "a.svg", "-o", "s.plt", "--strict", "--fit"], &arguments[..]];
        let run = hiddenline(folder.path(), &strict.concat());
        assert!(run.status.success(), "{}: {}", machine.name, text(&run.stderr));

        let (plt, said) = optimized(folder.path(), &arguments, "o.plt");
        let (drawn, _) = hpgl_ink(&plt, machine.unit);
        let lost = 2.0 * (w + h - 4.0) - drawn;
        let strict = [&["optimize", "a.svg", "-o", "n.plt", "--strict"], &arguments[..]].concat();
        let run = hiddenline(folder.path(), &strict);
        if lost > 0.5 {
            let told = said.split("warning: ").nth(1).unwrap().split(" mm").next().unwrap();
            let told: f64 = told.parse().unwrap();
            assert!((told - lost).abs() < 0.2, "{}: {told} told, {lost} lost", machine.name);
            assert_fails(&run, 1, "of ink are cut off");
        } else {
            assert!(run.status.success(), "{}: {said}", machine.name);
        }
    }
}

#[test]
fn drawings_of_models_fit_what_the_plotter_reaches() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    for machine in hpgl::machines().unwrap() {
        let size = machine.paper[0].names[0].clone();
        let run = hiddenline(
            folder.path(),
            &[
                "draw",
                "cube.obj",
                "--strict",
                "--margin",
                "0",
                "--page",
                &size,
                "--machine",
                &machine.name,
                "-o",
                "cube.plt",
            ],
        );
        // Papers have names that pages do not: those are given as they are.
        assert!(run.status.success(), "{}: {}", machine.name, text(&run.stderr));
    }
}

#[test]
fn dots_reach_every_format() {
    let dots: String = (0..12).map(|i| format!("<path d='M{} 50h0'/>", 20 + 20 * i)).collect();
    let folder = folder_with("a.svg", A4, &dots);
    let (svg, _) = optimized(folder.path(), &[], "o.svg");
    assert_eq!(svg.matches("<path d=\"M").count(), 12);
    assert!(svg.contains("M20 50L20 50"), "{svg}");
    let (dxf, _) = optimized(folder.path(), &[], "o.dxf");
    assert_eq!(dxf.matches("\r\nPOINT\r\n").count(), 12);
    let (plt, _) = optimized(folder.path(), &[], "o.plt");
    assert_eq!(plt.matches("PD;PU;").count(), 12);
    let (gcode, _) = optimized(folder.path(), &[], "o.gcode");
    assert_eq!(gcode.matches("\nM3 ").count(), 12);
    let run = hiddenline(folder.path(), &["optimize", "a.svg", "--dpi", "50", "-o", "o.png"]);
    assert!(run.status.success());
    let file = fs::File::open(folder.path().join("o.png")).unwrap();
    let mut picture = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut gray = vec![0; picture.output_buffer_size().unwrap()];
    let width = picture.next_frame(&mut gray).unwrap().width as usize;
    // 50 mm from the top at 50 dots an inch; each dot darkens its pixel or a neighbor.
    let row = (50.0 / 25.4 * 50.0) as usize;
    let near = |i: usize| i - 1..=i + 1;
    let dark = |x: usize| near(row).any(|y| near(x).any(|x| gray[y * width + x] < 250));
    let drawn = (0..12).filter(|i| dark((f64::from(20 + 20 * i) / 25.4 * 50.0) as usize)).count();
    assert_eq!(drawn, 12);
}

#[test]
fn pens_can_have_speed_and_pause_for_axidraw() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    let drawn = |pen: &str| {
        let run = hiddenline(folder.path(), &["draw", "cube.obj", "--pen", pen]);
        (run.status.success(), text(&run.stdout), text(&run.stderr))
    };
    let (_, svg, _) = drawn("visible=1:0.3mm:black:speed=30:pause");
    assert!(svg.contains("inkscape:label=\"!1 +S30 visible\""), "{svg}");
    let (_, svg, _) = drawn("visible=2:height=40:delay=500");
    assert!(svg.contains("inkscape:label=\"2 +H40 +D500 visible\""), "{svg}");
    let (_, svg, _) = drawn("visible=1:0.3mm:black");
    assert!(svg.contains("inkscape:label=\"1 visible\""), "{svg}");
    for bad in ["visible=1:speed=0", "visible=1:speed=fast", "visible=1:lift=3"] {
        let (succeeded, _, said) = drawn(bad);
        assert!(!succeeded && said.contains("expected"), "{said}");
    }
}

/// A polyline of a DXF: the name of its layer, and its points.
type DxfLine = (String, Vec<[f64; 2]>);

/// Draws the cube as DXF; its polylines, and the text of the file.
fn dxf_lines(folder: &Path, arguments: &[&str]) -> (Vec<DxfLine>, String) {
    let all = [&["draw", "cube.obj", "-o", "o.dxf"], arguments].concat();
    let run = hiddenline(folder, &all);
    assert!(run.status.success(), "{}", text(&run.stderr));
    let file = fs::read_to_string(folder.join("o.dxf")).unwrap().replace("\r\n", "\n");
    let tags: Vec<&str> = file.lines().collect();
    let mut lines: Vec<DxfLine> = Vec::new();
    let mut kind = "";
    for tag in tags.chunks(2) {
        match (tag[0].trim(), tag[1]) {
            ("0", name) => {
                kind = name;
                if kind == "POLYLINE" {
                    lines.push(Default::default());
                }
            }
            ("8", layer) if kind == "POLYLINE" => lines.last_mut().unwrap().0 = layer.to_owned(),
            ("10", x) if kind == "VERTEX" => {
                lines.last_mut().unwrap().1.push([x.parse().unwrap(), 0.0]);
            }
            ("20", y) if kind == "VERTEX" => {
                lines.last_mut().unwrap().1.last_mut().unwrap()[1] = y.parse().unwrap();
            }
            _ => {}
        }
    }
    (lines, file)
}

fn with_cube() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    folder
}

#[test]
fn dxf_has_whole_hidden_lines_with_a_linetype_on_request() {
    let folder = with_cube();
    let hidden = |arguments: &[&str]| {
        let (lines, file) = dxf_lines(folder.path(), arguments);
        let on = |line: &&DxfLine| line.0.contains("HIDDEN");
        (lines.iter().filter(on).cloned().collect::<Vec<_>>(), file)
    };
    let (solid, _) = hidden(&["--hidden", "solid"]);
    let (exploded, file) = hidden(&["--hidden", "dashed"]);
    assert!(exploded.len() > 5 * solid.len() && !file.contains("DASHED"));
    let native = &["--hidden", "dashed", "--dash", "4,1", "--dxf-dashes", "native"];
    let (whole, file) = hidden(native);
    assert_eq!(whole, solid);
    assert!(file.contains("\nDASHED\n") && file.contains("\n 49\n4\n 49\n-1\n"), "{file}");
    // A pen for both keeps them apart, since a layer has one linetype.
    let one_pen = ["--pen", "visible=1", "--pen", "hidden=1"];
    let (whole, _) = hidden(&[native, &one_pen[..]].concat());
    assert_eq!(whole.len(), solid.len());
    let run = hiddenline(folder.path(), &["draw", "cube.obj", "--dxf-dashes", "native"]);
    assert!(text(&run.stderr).contains("--dxf-dashes has no effect on svg"));
}

#[test]
fn dxf_has_a_layer_for_each_kind_of_line() {
    let folder = with_cube();
    let (lines, file) = dxf_lines(folder.path(), &[]);
    let mut names: Vec<&str> = lines.iter().map(|line| line.0.as_str()).collect();
    names.dedup();
    assert_eq!(names, ["1_SILHOUETTE", "2_CREASE"], "{file}");
    assert!(!file.contains("_MESH"), "no layer without lines");
}

#[test]
fn dxf_at_a_scale_has_the_model_s_own_lengths() {
    let folder = with_cube();
    for (scale, unit, number) in [("1:2", "cm", "5"), ("10:1", "mm", "4"), ("1:24", "in", "1")] {
        let view = ["--view", "top", "--drawing-scale", scale, "--unit", unit];
        let (lines, file) = dxf_lines(folder.path(), &view);
        assert!(file.contains(&format!("$INSUNITS\n 70\n{number}\n")), "{file:.200}");
        let points = lines.iter().flat_map(|line| &line.1);
        let (low, high) = points.fold((f64::MAX, f64::MIN), |m, p| (m.0.min(p[0]), m.1.max(p[0])));
        assert!((high - low - 2.0).abs() < 2e-4, "{scale} {unit}: {}", high - low);
    }
}

#[test]
fn plotters_keep_the_controls_of_labels_or_say_that_they_cannot() {
    let layer = |label: &str, y: u32| {
        format!(
            "<g inkscape:groupmode='layer' inkscape:label='{label}'><path d='M50 {y}h100'/></g>"
        )
    };
    let layers = [layer("1 +S50 first", 50), layer("!2 second", 60), layer("3 third", 70)].concat();
    let folder = folder_with("a.svg", A4, &layers);
    let (plt, said) = optimized(folder.path(), &["--machine", "hp7550"], "o.plt");
    assert!(!said.contains("warning"), "{said}");
    let layers: Vec<&str> = plt.split("SP").collect();
    assert!(layers[1].starts_with("1;VS40;") && layers[1].contains("NR;"), "{plt}");
    assert!(layers[2].starts_with("2;VS;\n") && !layers[2].contains("NR;"), "{plt}");
    let (plt, said) = optimized(folder.path(), &["--machine", "hp7475a"], "o.plt");
    assert!(said.contains("HP 7475A cannot pause before layer 2"), "{said}");
    assert!(plt.contains("SP1;VS19;") && !plt.contains("NR"), "{plt}");
    let (_, said) = optimized(folder.path(), &["--machine", "artisan"], "o.plt");
    assert!(said.contains("`+S` of layer 1 has no effect"), "{said}");
    let strict = ["optimize", "a.svg", "--strict", "--machine", "hp7475a", "-o", "n.plt"];
    assert_fails(&hiddenline(folder.path(), &strict), 1, "cannot pause");
    let config = "[machine.mine]\nlike = 'hp7550'\nspeed = 20\nforce = 3\n\
                  [machine.heavy]\nlike = 'hp7550'\nforce = 9\n";
    fs::write(folder.path().join("hiddenline.toml"), config).unwrap();
    let (plt, _) = optimized(folder.path(), &["--machine", "mine"], "o.plt");
    assert!(plt.contains("SP1;VS40;FS3;") && plt.contains("SP3;VS20;FS3;"), "{plt}");
    let heavy = ["optimize", "a.svg", "--machine", "heavy", "-o", "n.plt"];
    assert_fails(&hiddenline(folder.path(), &heavy), 1, "takes a pen force of 1 to 8, not 9");
}
