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
    assert_fails(&run, 1, "needs 7 pens and HP 7475A holds 6; give --pen visible=1");
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
        assert!(!succeeded && said.contains("give"), "{said}");
    }
}
