//! HPGL, G-code, DXF and PDF, read back by small parsers that know nothing of the writers.

use glam::{DVec2, dvec2};
use hiddenline::stages::plot::{Layer, Pen, Plot, Polylines};
use hiddenline::stages::write::{dxf, gcode, hpgl, pdf};

fn plot(width_mm: f64, height_mm: f64, layers: &[&[&[(f64, f64)]]]) -> Plot {
    let layers = layers.iter().zip(1..).map(|(strokes, number)| {
        let mut lines = Polylines::default();
        for stroke in *strokes {
            lines.push(stroke.iter().map(|&(x, y)| dvec2(x, y)));
        }
        let pen = Pen { width_mm: 0.3, color: "#ff0000".to_owned() };
        Layer { number, name: "visible; (M5)\n".to_owned(), pen, lines, ..Layer::default() }
    });
    Plot {
        width_mm,
        height_mm,
        title: "A plot".to_owned(),
        layers: layers.collect(),
        ..Plot::default()
    }
}

/// A page of many short curves, so that rounding errors would add up.
fn waves(width_mm: f64, height_mm: f64) -> Plot {
    let mut plot = plot(width_mm, height_mm, &[&[], &[]]);
    for (k, layer) in plot.layers.iter_mut().enumerate() {
        for j in 0..12 {
            let row = 40.0 + 10.0 * f64::from(j) + 4.0 * k as f64;
            layer.lines.push((0..400).map(|i| {
                let x = 30.0 + 0.3331 * f64::from(i);
                dvec2(x, row + 3.0 * (x / 7.0).sin())
            }));
        }
    }
    plot
}

fn length(strokes: &[Vec<DVec2>]) -> f64 {
    strokes.iter().flat_map(|s| s.windows(2)).map(|p| p[0].distance(p[1])).sum()
}

fn strokes_of(plot: &Plot) -> Vec<Vec<DVec2>> {
    plot.layers.iter().flat_map(|l| l.lines.iter().map(<[DVec2]>::to_vec)).collect()
}

fn written(write: impl FnOnce(&mut dyn std::io::Write) -> std::io::Result<()>) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(&mut bytes).unwrap();
    bytes
}

/// Strokes in plotter units, and the pens selected.
fn read_hpgl(text: &str) -> (Vec<Vec<DVec2>>, Vec<u32>) {
    let (mut strokes, mut pens) = (Vec::new(), Vec::new());
    let (mut here, mut down, mut relative) = (dvec2(0.0, 0.0), false, false);
    for instruction in text.split(';').map(str::trim).filter(|i| !i.is_empty()) {
        let (name, rest) = instruction.split_at(2);
        let numbers: Vec<f64> = rest
            .split(',')
            .filter(|n| !n.is_empty())
            .map(|n| f64::from(n.parse::<i32>().expect("whole numbers")))
            .collect();
        match name {
            "IN" | "DF" => (down, relative) = (false, false),
            "PS" | "VS" => {}
            "SP" => {
                assert!(!down, "pens are changed in the air");
                pens.push(numbers[0] as u32);
            }
            "PA" => relative = false,
            "PR" => relative = true,
            "PU" => down = false,
            "PD" if !down => {
                down = true;
                strokes.push(vec![here]);
            }
            "PD" => {}
            _ => panic!("unknown instruction {instruction}"),
        }
        if matches!(name, "PA" | "PR" | "PU" | "PD") {
            assert!(numbers.len().is_multiple_of(2) && instruction.len() < 250);
            for xy in numbers.chunks(2) {
                let p = dvec2(xy[0], xy[1]);
                here = if relative { here + p } else { p };
                if down {
                    strokes.last_mut().unwrap().push(here);
                }
            }
        }
    }
    (strokes, pens)
}

#[test]
fn hpgl_draws_what_the_page_shows() {
    let plot = waves(297.0, 210.0);
    let profile = hpgl::LoadedPlotter::new(&plot, "hp7475a", None).unwrap();
    let text = String::from_utf8(written(|out| hpgl::write(&plot, &profile, out))).unwrap();
    assert!(text.starts_with("IN;DF;PS4;"));
    let (strokes, pens) = read_hpgl(&text);
    assert_eq!(pens, [1, 2, 0]);
    let wanted = strokes_of(&plot);
    assert_eq!(strokes.len(), wanted.len());
    for (stroke, line) in strokes.iter().zip(&wanted) {
        // The sheet's (10, 206) is the plotter's origin; half a unit of rounding each way.
        let ends = [(stroke[0], line[0]), (stroke[stroke.len() - 1], line[line.len() - 1])];
        for (unit, mm) in ends {
            let there = dvec2(10.0 + unit.x * 0.02488, 206.0 - unit.y * 0.02488);
            assert!(there.distance(mm) <= 0.02488 * 0.5f64.sqrt() + 1e-9, "{there} {mm}");
        }
    }
    let ratio = length(&strokes) * 0.02488 / length(&wanted);
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
}

#[test]
fn hpgl_never_leaves_the_hard_clip_limits() {
    for machine in hpgl::machines().unwrap() {
        for paper in &machine.paper {
            let [w, h] = paper.size;
            let star: Vec<(f64, f64)> = (0..200)
                .map(|i| f64::from(i) * 2.4)
                .map(|a| (w / 2.0 + w * a.cos(), h / 2.0 + h * a.sin()))
                .collect();
            let plot = plot(w, h, &[&[&star, &[(-50.0, -50.0), (w + 50.0, h + 50.0)]]]);
            let profile =
                hpgl::LoadedPlotter::on(&plot, machine.clone(), Some(&paper.names[0])).unwrap();
            let bytes = written(|out| hpgl::write(&plot, &profile, out));
            let (strokes, _) = read_hpgl(&String::from_utf8(bytes).unwrap());
            assert!(strokes.len() > 20);
            for p in strokes.iter().flatten() {
                assert!(p.x >= f64::from(paper.x[0]) && p.x <= f64::from(paper.x[1]));
                assert!(p.y >= f64::from(paper.y[0]) && p.y <= f64::from(paper.y[1]));
            }
        }
    }
}

#[test]
fn hpgl_turns_upright_pages_to_the_left() {
    // The bottom of the page comes to lie on the right.
    let plot = plot(210.0, 297.0, &[&[&[(100.0, 250.0), (110.0, 250.0)]]]);
    let profile = hpgl::LoadedPlotter::new(&plot, "hp7475a", None).unwrap();
    let bytes = written(|out| hpgl::write(&plot, &profile, out));
    let (strokes, _) = read_hpgl(&String::from_utf8(bytes).unwrap());
    let mm: Vec<DVec2> = strokes[0]
        .iter()
        .map(|unit| dvec2(10.0 + unit.x * 0.02488, 206.0 - unit.y * 0.02488).round())
        .collect();
    assert_eq!(mm, [dvec2(250.0, 110.0), dvec2(250.0, 100.0)]);
}

#[test]
fn hpgl_names_what_a_plotter_cannot_do() {
    let a4 = plot(297.0, 210.0, &[&[]]);
    let error =
        |result: Result<hpgl::LoadedPlotter, hpgl::PlotterError>| result.unwrap_err().to_string();
    assert!(error(hpgl::LoadedPlotter::new(&a4, "hp1", None)).contains("hp7475a"));
    assert!(error(hpgl::LoadedPlotter::new(&a4, "hp7475a", Some("a0"))).contains("a4, a3"));
    let odd = plot(100.0, 100.0, &[&[]]);
    assert!(error(hpgl::LoadedPlotter::new(&odd, "hp7475a", None)).contains("100 × 100 mm"));
    let many = plot(297.0, 210.0, &[&[] as &[&[_]]; 7]);
    assert!(error(hpgl::LoadedPlotter::new(&many, "hp7475a", None)).contains("it holds 6"));
    for (number, is_there) in [(0, false), (1, true), (6, true), (7, false)] {
        let mut one = a4.clone();
        one.layers[0].number = number;
        assert_eq!(hpgl::LoadedPlotter::new(&one, "hp7475a", None).is_ok(), is_there, "{number}");
    }
}

/// What a machine would draw: strokes with the pen down, and the feeds seen.
fn read_gcode(text: &str, is_down: impl Fn(&str) -> Option<bool>) -> (Vec<Vec<DVec2>>, usize) {
    let (mut strokes, mut lifts) = (Vec::new(), 0);
    let (mut here, mut down) = (dvec2(0.0, 0.0), false);
    for line in text.lines().map(|l| l.split(';').next().unwrap().trim()).filter(|l| !l.is_empty())
    {
        match is_down(line) {
            Some(true) => {
                assert!(!down);
                down = true;
                strokes.push(vec![here]);
            }
            Some(false) => {
                lifts += usize::from(down);
                down = false;
            }
            None => {}
        }
        let word = |letter: char| {
            line.split(' ').find_map(|w| w.strip_prefix(letter)).map(|v| v.parse::<f64>().unwrap())
        };
        if let (Some(x), Some(y)) = (word('X'), word('Y')) {
            here = dvec2(x, y);
            assert_eq!(line.starts_with("G1"), down, "{line}");
            if down {
                assert!(word('F').unwrap() > 0.0);
                strokes.last_mut().unwrap().push(here);
            }
        }
    }
    assert!(!down, "the pen is left in the air");
    (strokes, lifts)
}

#[test]
fn every_gcode_profile_lifts_the_pen_and_keeps_the_lengths() {
    let plot = waves(297.0, 210.0);
    let wanted = strokes_of(&plot);
    for name in ["grbl-servo", "grbl-z", "grbl-laser", "marlin"] {
        let profile = gcode::GcodeProfile::named(name).unwrap();
        let bytes = written(|out| gcode::write(&plot, &profile, out));
        let text = String::from_utf8(bytes).unwrap();
        let (strokes, lifts) = read_gcode(&text, |line| match name {
            "grbl-servo" | "grbl-laser" if line.starts_with("M3") || line.starts_with("M4") => {
                Some(true)
            }
            "grbl-servo" | "grbl-laser" if line.starts_with("M5") => Some(false),
            _ if line.contains("Z0") => Some(true),
            _ if line.contains("Z5") => Some(false),
            _ => None,
        });
        assert!(text.contains("G21") && text.contains("G90"), "{name}");
        assert_eq!((strokes.len(), lifts), (wanted.len(), wanted.len()), "{name}");
        for (stroke, line) in strokes.iter().zip(&wanted) {
            assert_eq!(stroke.len(), line.len());
            for (p, q) in stroke.iter().zip(line) {
                assert!(dvec2(p.x, 210.0 - p.y).distance(*q) <= 0.0005 * 2.0f64.sqrt() + 1e-9);
            }
        }
    }
}

#[test]
fn names_cannot_break_out_of_gcode_comments() {
    let plot = plot(100.0, 100.0, &[&[&[(1.0, 1.0), (2.0, 2.0)]]]);
    let profile = gcode::GcodeProfile::named("grbl-servo").unwrap();
    let text = String::from_utf8(written(|out| gcode::write(&plot, &profile, out))).unwrap();
    assert!(text.contains("; pen 1: visible_ _M5__\n"), "{text}");
}

#[test]
fn own_gcode_profiles_are_checked() {
    let good =
        "decimals = 2\nfeed = 60\nunit = 'in'\nstart = 'G20\n'\npen_up = 'U\n'\npen_down = 'D\n'\n\
        move = 'G0 X{x} Y{y}\n'\nline = 'G1 X{x} Y{y} F{feed}\n'\nend = ''\n"
            .replace("'G20\n'", "\"G20\\n\"")
            .replace("'U\n'", "\"U\\n\"")
            .replace("'D\n'", "\"D\\n\"")
            .replace("Y{y}\n'", "Y{y}\\n\"")
            .replace("F{feed}\n'", "F{feed}\\n\"")
            .replace("'G0", "\"G0")
            .replace("'G1", "\"G1");
    let profile = gcode::GcodeProfile::from_toml(&good).unwrap();
    let plot = plot(254.0, 254.0, &[&[&[(25.4, 228.6), (50.8, 254.0)]]]);
    let text = String::from_utf8(written(|out| gcode::write(&plot, &profile, out))).unwrap();
    assert_eq!(text, "G20\nG0 X1 Y1\nD\nG1 X2 Y0 F60\nU\n");
    let error = |text: &str| gcode::GcodeProfile::from_toml(text).unwrap_err().to_string();
    assert!(error(&good.replace("{feed}", "{speed}")).contains("{speed}"));
    assert!(error(&good.replace("feed = 60", "feed = -1")).contains("feed"));
    assert!(error(&good.replace("decimals = 2", "")).contains("decimals"));
    assert!(gcode::GcodeProfile::named("mill").unwrap_err().to_string().contains("marlin"));
}

#[test]
fn dxf_holds_the_same_polylines() {
    let plot = plot(
        297.0,
        210.0,
        &[
            &[&[(10.0, 20.0), (30.0, 20.0), (30.0, 50.0), (10.0, 20.0)], &[(1.0, 1.0), (2.5, 2.0)]],
            &[&[(5.0, 5.0), (5.0, 5.0)]],
        ],
    );
    let text =
        String::from_utf8(written(|out| dxf::write(&plot, dxf::DxfScale::default(), out))).unwrap();
    let lines: Vec<&str> = text.split("\r\n").collect();
    let pairs: Vec<(i32, &str)> =
        lines.chunks_exact(2).map(|pair| (pair[0].trim().parse().unwrap(), pair[1])).collect();
    let count = |what: &str| pairs.iter().filter(|&&(code, v)| code == 0 && v == what).count();
    assert_eq!([count("POLYLINE"), count("VERTEX"), count("SEQEND"), count("POINT")], [2, 5, 2, 1]);
    assert_eq!(count("SECTION"), count("ENDSEC"));
    assert_eq!(pairs.last(), Some(&(0, "EOF")));
    let first = pairs.iter().position(|&(_, v)| v == "VERTEX").unwrap();
    assert_eq!(pairs[first + 2..first + 4], [(10, "10"), (20, "190")]);
    assert!(pairs.iter().filter(|&&(code, _)| code == 8).all(|(_, v)| v.len() <= 31));
}

#[test]
fn pdf_has_the_page_and_every_stroke() {
    let plot = waves(297.0, 210.0);
    let bytes = written(|out| pdf::write(&plot, out));
    let text = String::from_utf8_lossy(&bytes);
    assert!(text.starts_with("%PDF-") && text.trim_end().ends_with("%%EOF"));
    assert!(text.contains("/MediaBox [0 0 841.88"), "297 mm are 841.89 points");
    let operators = |name: &str| text.lines().filter(|line| line.ends_with(name)).count();
    assert_eq!(operators(" m"), 24);
    assert_eq!(operators(" l"), 24 * 399);
    assert_eq!(text.lines().filter(|&line| line == "S").count(), 24);
}
