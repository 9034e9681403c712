//! What machines and other programs find in our files: each format is read back by a reader that
//! knows nothing of its writer, and compared with the plot in ink, page, color and width.

use glam::{DVec2, dvec2};
use hiddenline::stages::optimize::estimate::{Motion, estimate_lines};
use hiddenline::stages::optimize::{
    Effort, Graph, Joints, OptimizeOptions, optimize_lines, split_by_distance,
};
use hiddenline::stages::plot::{Layer, Pen, Plot, Polylines};
use hiddenline::stages::write::{dxf, gcode, hpgl, pdf};

fn polylines(strokes: &[&[(f64, f64)]]) -> Polylines {
    let mut lines = Polylines::default();
    for stroke in strokes {
        lines.push(stroke.iter().map(|&(x, y)| dvec2(x, y)));
    }
    lines
}

/// A page without any symmetry: two pens, a closed line, an open one, a dot.
fn plot() -> Plot {
    let layer = |number, color: &str, width_mm, strokes: &[&[(f64, f64)]]| Layer {
        number,
        name: format!("pen{number}"),
        pen: Pen { width_mm, color: color.to_owned() },
        lines: polylines(strokes),
        ..Layer::default()
    };
    let closed: &[(f64, f64)] = &[(30.0, 40.0), (90.0, 41.0), (91.0, 70.0), (30.0, 40.0)];
    let open: &[(f64, f64)] = &[(120.0, 150.0), (200.0, 160.5), (230.25, 90.0)];
    Plot {
        width_mm: 297.0,
        height_mm: 210.0,
        layers: vec![
            layer(1, "#ff2000", 0.35, &[closed, &[(50.0, 60.0), (50.0, 60.0)]]),
            layer(2, "#0000ff", 0.7, &[open]),
        ],
        ..Plot::default()
    }
}

fn strokes_of(layer: &Layer) -> Vec<Vec<DVec2>> {
    layer.lines.iter().map(<[DVec2]>::to_vec).collect()
}

#[track_caller]
fn assert_near(found: &[Vec<DVec2>], wanted: &[Vec<DVec2>], within: f64) {
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for (a, b) in found.iter().zip(wanted) {
        assert_eq!(a.len(), b.len(), "{a:?} instead of {b:?}");
        let off = a.iter().zip(b).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
        assert!(off <= within, "{a:?} instead of {b:?}");
    }
}

fn written(write: impl FnOnce(&mut dyn std::io::Write) -> std::io::Result<()>) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(&mut bytes).unwrap();
    bytes
}

/// Strokes of a PDF page in millimeters from its top left, with color and width of each.
struct PdfPage {
    size: [f64; 2],
    strokes: Vec<(Vec<DVec2>, [f64; 3], f64)>,
}

fn read_pdf(bytes: &[u8]) -> PdfPage {
    const MM: f64 = 25.4 / 72.0;
    let document = lopdf::Document::load_mem(bytes).unwrap();
    let page = *document.get_pages().values().next().unwrap();
    let numbers = |objects: &[lopdf::Object]| -> Vec<f64> {
        objects.iter().map(|o| f64::from(o.as_float().unwrap())).collect()
    };
    let dictionary = document.get_dictionary(page).unwrap();
    let media = numbers(dictionary.get(b"MediaBox").unwrap().as_array().unwrap());
    let height = media[3];
    let content = lopdf::content::Content::decode(&document.get_page_content(page)).unwrap();
    let mut matrix = glam::DAffine2::IDENTITY;
    let (mut color, mut width) = ([0.0; 3], 1.0);
    let (mut path, mut strokes): (Vec<DVec2>, Vec<_>) = (Vec::new(), Vec::new());
    for operation in content.operations {
        let n = numbers(&operation.operands[..]);
        let at = |matrix: glam::DAffine2| {
            let p = matrix.transform_point2(dvec2(n[0], n[1]));
            dvec2(p.x, height - p.y) * MM
        };
        match operation.operator.as_str() {
            "cm" => {
                matrix *= glam::DAffine2::from_cols_array(&[n[0], n[1], n[2], n[3], n[4], n[5]]);
            }
            "RG" => color = [n[0], n[1], n[2]],
            "w" => width = n[0] * matrix.matrix2.determinant().abs().sqrt() * MM,
            "m" => path = vec![at(matrix)],
            "l" => path.push(at(matrix)),
            "S" => strokes.push((std::mem::take(&mut path), color, width)),
            "s" => {
                path.push(path[0]);
                strokes.push((std::mem::take(&mut path), color, width));
            }
            "J" | "j" => assert_eq!(n, [1.0], "caps and joins are round"),
            other => panic!("unknown operator {other}"),
        }
    }
    PdfPage { size: [media[2] * MM, media[3] * MM], strokes }
}

#[test]
fn a_pdf_library_finds_page_ink_colors_and_widths() {
    let plot = plot();
    let page = read_pdf(&written(|out| pdf::write(&plot, out)));
    assert!((page.size[0] - 297.0).abs() < 1e-3 && (page.size[1] - 210.0).abs() < 1e-3);
    let found: Vec<Vec<DVec2>> = page.strokes.iter().map(|(line, ..)| line.clone()).collect();
    let wanted: Vec<Vec<DVec2>> = plot.layers.iter().flat_map(strokes_of).collect();
    assert_near(&found, &wanted, 1e-3);
    for (i, (_, color, width)) in page.strokes.iter().enumerate() {
        let (wanted, pen) =
            if i < 2 { ([1.0, 32.0 / 255.0, 0.0], 0.35) } else { ([0.0, 0.0, 1.0], 0.7) };
        assert!(color.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-3), "{color:?}");
        assert!((width - pen).abs() < 1e-4, "{width} mm instead of {pen} mm");
    }
}

/// Entities of a DXF as groups of code and value.
fn read_dxf(text: &str) -> Vec<Vec<(i32, String)>> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let mut records: Vec<Vec<(i32, String)>> = Vec::new();
    for pair in lines.chunks_exact(2) {
        let code: i32 = pair[0].parse().unwrap();
        if code == 0 || code == 9 {
            records.push(Vec::new());
        }
        records.last_mut().unwrap().push((code, pair[1].to_owned()));
    }
    records
}

fn group(record: &[(i32, String)], code: i32) -> &str {
    record.iter().find(|(c, _)| *c == code).map_or("", |(_, value)| value)
}

#[test]
fn a_tag_reader_finds_layers_colors_and_ink_in_dxf() {
    let plot = plot();
    let text =
        String::from_utf8(written(|out| dxf::write(&plot, dxf::DxfScale::default(), out))).unwrap();
    let records = read_dxf(&text);
    let named = |name: &str| records.iter().find(|r| r[0].1 == name).unwrap();
    assert_eq!(group(named("$INSUNITS"), 70), "4", "millimeters");
    assert_eq!((group(named("$EXTMAX"), 10), group(named("$EXTMAX"), 20)), ("297", "210"));
    let layers: Vec<(&str, &str)> = records
        .iter()
        .filter(|r| r[0] == (0, "LAYER".to_owned()))
        .map(|r| (group(r, 2), group(r, 62)))
        .collect();
    assert_eq!(layers, [("1_PEN1", "1"), ("2_PEN2", "5")], "red and blue");
    let point = |r: &[(i32, String)]| {
        dvec2(group(r, 10).parse().unwrap(), 210.0 - group(r, 20).parse::<f64>().unwrap())
    };
    let mut found: Vec<(String, Vec<DVec2>)> = Vec::new();
    let mut closed = Vec::new();
    for record in &records {
        match record[0].1.as_str() {
            "POINT" => found.push((group(record, 8).to_owned(), vec![point(record); 2])),
            "POLYLINE" => {
                found.push((group(record, 8).to_owned(), Vec::new()));
                closed.push(group(record, 70) == "1");
            }
            "VERTEX" => found.last_mut().unwrap().1.push(point(record)),
            "SEQEND" if closed.last() == Some(&true) => {
                let line = &mut found.last_mut().unwrap().1;
                line.push(line[0]);
            }
            _ => {}
        }
    }
    assert_eq!(closed, [true, false]);
    let on: Vec<&str> = found.iter().map(|(layer, _)| layer.as_str()).collect();
    assert_eq!(on, ["1_PEN1", "1_PEN1", "2_PEN2"]);
    let found: Vec<Vec<DVec2>> = found.into_iter().map(|(_, line)| line).collect();
    let wanted: Vec<Vec<DVec2>> = plot.layers.iter().flat_map(strokes_of).collect();
    assert_near(&found, &wanted, 1e-4);
}

#[test]
fn gcode_follows_each_template_in_its_place() {
    let profile = |flip_y: bool| {
        let text = format!(
            "decimals = 3\nfeed = 60\nflip_y = {flip_y}\nstart = 'B;'\npen_up = 'U;'\npen_down = 'D;'\n\
             move = 'G0 {{x}} {{y}};'\nline = 'G1 {{x}} {{y}};'\nlayer_start = 'S{{layer}};'\n\
             layer_end = 'E{{layer}};'\npen_change = 'C{{layer}};'\nend = 'Z;'\n"
        );
        gcode::GcodeProfile::from_toml(&text).unwrap()
    };
    let mut plot = plot();
    plot.layers[0].lines = polylines(&[&[(1.0, 2.0), (3.0, 4.0)]]);
    plot.layers[1].lines = polylines(&[&[(5.0, 6.0), (7.0, 8.0)]]);
    let text = |plot: &Plot, flip: bool| {
        String::from_utf8(written(|out| gcode::write(plot, &profile(flip), out))).unwrap()
    };
    assert_eq!(text(&plot, false), "B;S1;G0 1 2;D;G1 3 4;U;E1;C2;S2;G0 5 6;D;G1 7 8;U;E2;Z;");
    assert_eq!(
        text(&plot, true),
        "B;S1;G0 1 208;D;G1 3 206;U;E1;C2;S2;G0 5 204;D;G1 7 202;U;E2;Z;"
    );
    // A pause before the first layer is a pause, too; a layer that is not plotted is not there.
    plot.layers[0].label = Some("!1 first".to_owned());
    plot.layers[1].label = Some("%2 guide".to_owned());
    assert_eq!(text(&plot, false), "B;C1;S1;G0 1 2;D;G1 3 4;U;E1;Z;");
}

#[test]
fn gcode_in_inches_has_all_lengths_in_inches() {
    let text = "decimals = 4\nunit = 'in'\nfeed = 60\nstart = '{width} {height};'\nmove = '{x} {y};'\n\
                line = '{x} {y};'\nlayer_start = '{pen_width};'\npen_down = ''\npen_up = ''\n\
                layer_end = ''\npen_change = ''\nend = ''\n";
    let profile = gcode::GcodeProfile::from_toml(text).unwrap();
    let mut plot = plot();
    plot.layers.truncate(1);
    (plot.width_mm, plot.height_mm, plot.layers[0].pen.width_mm) = (254.0, 127.0, 0.508);
    plot.layers[0].lines = polylines(&[&[(25.4, 0.0), (0.0, 12.7)]]);
    let text = String::from_utf8(written(|out| gcode::write(&plot, &profile, out))).unwrap();
    let numbers: Vec<f64> = text
        .split([' ', ';', '\n'])
        .filter(|word| !word.is_empty())
        .map(|word| word.parse().unwrap())
        .collect();
    let flipped = if profile.flip_y { [5.0, 4.5] } else { [0.0, 0.5] };
    assert_eq!(numbers, [10.0, 5.0, 0.02, 1.0, flipped[0], 0.0, flipped[1]]);
}

#[test]
fn holes_of_areas_are_left_open_in_pdf_whichever_way_they_run() {
    let square = |low: f64, high: f64| {
        [(low, low), (high, low), (high, high), (low, high)].map(|(x, y)| dvec2(x, y))
    };
    for seam_mm in [0.0, 0.1] {
        let mut plot = plot();
        plot.layers.truncate(1);
        plot.layers[0].lines = polylines(&[]);
        plot.layers[0].fills.seam_mm = seam_mm;
        plot.layers[0].fills.push([9, 9, 9], [square(10.0, 90.0), square(40.0, 60.0)]);
        let bytes = written(|out| pdf::write(&plot, out));
        let document = lopdf::Document::load_mem(&bytes).unwrap();
        let page = *document.get_pages().values().next().unwrap();
        let content = lopdf::content::Content::decode(&document.get_page_content(page)).unwrap();
        let paints: Vec<&str> = content
            .operations
            .iter()
            .map(|operation| operation.operator.as_str())
            .filter(|operator| ["f", "F", "f*", "B", "B*", "b", "b*"].contains(operator))
            .collect();
        // The star stands for the even-odd rule.
        assert_eq!(paints, [if seam_mm > 0.0 { "B*" } else { "f*" }]);
    }
}

#[test]
fn hpgl_parks_the_pen_where_the_machine_says_and_cuts_what_is_out_of_reach() {
    for machine in hpgl::machines().unwrap() {
        for paper in machine.paper.clone() {
            let [w, h] = paper.size;
            let mut plot = Plot { width_mm: w, height_mm: h, ..plot() };
            plot.layers.truncate(1);
            // In reach, far out, and in reach again: two strokes.
            let (x, y) = (w / 2.0, h / 2.0);
            let there_and_back =
                [(x, y), (x + 9.0, y), (x + 2.0 * w, y - 9.0), (x + 9.0, y - 20.0), (x, y - 20.0)];
            plot.layers[0].lines = polylines(&[&there_and_back]);
            let profile =
                hpgl::LoadedPlotter::on(&plot, machine.clone(), Some(&paper.names[0])).unwrap();
            let text = String::from_utf8(written(|out| hpgl::write(&plot, &profile, out))).unwrap();
            let (starts, instructions) = read_hpgl(&text);
            assert_eq!(starts.len(), 2, "{}: {text}", machine.name);
            let [px, py] = paper.park;
            let last: Vec<&str> = instructions.iter().rev().take(4).map(String::as_str).collect();
            assert_eq!(last, ["IN", "SP0", &format!("PU{px},{py}"), "PA"], "{}", machine.name);
            // No stroke leaves the reach.
            for piece in text.split("PA;PU").skip(1).filter(|piece| piece.contains("PR;")) {
                let numbers: Vec<i32> = piece
                    .split(|c: char| !(c.is_ascii_digit() || c == '-'))
                    .filter_map(|word| word.parse().ok())
                    .collect();
                let mut at = [0, 0];
                for (k, pair) in numbers.chunks_exact(2).enumerate() {
                    at = if k == 0 {
                        [pair[0], pair[1]]
                    } else {
                        [at[0] + pair[0], at[1] + pair[1]]
                    };
                    let is_in = |at: i32, [low, high]: [i32; 2]| low <= at && at <= high;
                    assert!(is_in(at[0], paper.x) && is_in(at[1], paper.y), "{}", machine.name);
                }
            }
        }
    }
}

/// Where the pen goes down, in plotter units, and all instructions.
fn read_hpgl(text: &str) -> (Vec<[i32; 2]>, Vec<String>) {
    let instructions: Vec<String> =
        text.split(';').map(|i| i.trim().to_owned()).filter(|i| !i.is_empty()).collect();
    let starts = instructions.windows(2).filter(|pair| pair[1].starts_with("PR"));
    let start = |pair: &[String]| {
        let mut numbers = pair[0].strip_prefix("PU").unwrap().split(',');
        [(); 2].map(|()| numbers.next().unwrap().parse().unwrap())
    };
    (starts.map(start).collect(), instructions)
}

#[test]
fn hpgl_puts_the_page_where_the_plotter_has_its_origin() {
    // Worked out by hand from the manuals' drawings: page (100, 50) on A4 landscape.
    let wanted = [
        // (100 − 10) / 0.02488 and (206 − 50) / 0.02488.
        ("hp7475a", [3617, 6270]),
        // Drawn upside down: (297 − 100 − 15) / 0.025 and (196 − 210 + 50) / 0.025.
        ("designmate", [7280, 1440]),
        // (100 − 15) / 0.025 and (200 − 50) / 0.025.
        ("hp7440a", [3400, 6000]),
        // (100 − 12) / 0.025 and (206 − 50) / 0.025.
        ("hp7550", [3520, 6240]),
        ("dxy", [4000, 6400]),
    ];
    for (name, start) in wanted {
        let mut plot = plot();
        plot.layers.truncate(1);
        plot.layers[0].lines = polylines(&[&[(100.0, 50.0), (150.0, 60.0)]]);
        let profile = hpgl::LoadedPlotter::new(&plot, name, None).unwrap();
        let text = String::from_utf8(written(|out| hpgl::write(&plot, &profile, out))).unwrap();
        assert_eq!(read_hpgl(&text).0, [start], "{name}");
    }
}

#[test]
fn hpgl_sets_speed_and_force_for_each_pen_and_puts_the_last_one_away() {
    let plot = plot();
    let mut machine = hpgl::machines().unwrap().swap_remove(0);
    (machine.speed, machine.force) = (Some(20), Some(3));
    let profile = hpgl::LoadedPlotter::on(&plot, machine, None).unwrap();
    let text = String::from_utf8(written(|out| hpgl::write(&plot, &profile, out))).unwrap();
    let (_, instructions) = read_hpgl(&text);
    let set: Vec<&str> = instructions
        .iter()
        .map(String::as_str)
        .filter(|i| ["SP", "VS", "FS"].iter().any(|name| i.starts_with(name)))
        .collect();
    assert_eq!(set, ["SP1", "VS20", "FS3", "SP2", "VS20", "FS3", "SP0"]);
    // Without a speed of its own, a pen is not slowed by the layer before it.
    let mut plot = plot;
    plot.layers[0].label = Some("1 +S50".into());
    let profile = hpgl::LoadedPlotter::new(&plot, "hp7475a", None).unwrap();
    let text = String::from_utf8(written(|out| hpgl::write(&plot, &profile, out))).unwrap();
    let (_, instructions) = read_hpgl(&text);
    let set: Vec<&String> =
        instructions.iter().filter(|i| i.starts_with("SP") || i.starts_with("VS")).collect();
    assert_eq!(set, ["SP1", "VS19", "SP2", "VS", "SP0"]);
}

#[test]
fn a_hundred_millimeters_are_a_hundred_on_every_plotter() {
    for machine in hpgl::machines().unwrap() {
        for paper in machine.paper.iter() {
            let [w, h] = paper.size;
            let mut plot = Plot { width_mm: w, height_mm: h, ..plot() };
            plot.layers.truncate(1);
            let (x, y) = (w / 2.0 - 50.0, h / 2.0);
            plot.layers[0].lines = polylines(&[&[(x, y), (x + 100.0, y)]]);
            let profile =
                hpgl::LoadedPlotter::on(&plot, machine.clone(), Some(&paper.names[0])).unwrap();
            let text = String::from_utf8(written(|out| hpgl::write(&plot, &profile, out))).unwrap();
            let drawn = text.split("PD").nth(1).unwrap().split([',', ';']).next().unwrap();
            let length = drawn.parse::<f64>().unwrap().abs() * machine.unit;
            assert!((length - 100.0).abs() < machine.unit, "{}: {length}", machine.name);
            // The reach is in page millimeters, on the sheet, and around its middle.
            let [low, high] = profile.reach(&plot);
            assert!(low.cmpge(DVec2::ZERO).all() && high.x <= w && high.y <= h);
            assert!(low.cmplt(dvec2(x, y)).all() && high.cmpgt(dvec2(x + 100.0, y)).all());
        }
    }
}

#[test]
fn what_lies_in_reach_is_not_cut_and_what_does_not_is() {
    for machine in hpgl::machines().unwrap() {
        for paper in &machine.paper {
            for upright in [false, true] {
                let [w, h] = paper.size;
                let (w, h) = if upright { (h, w) } else { (w, h) };
                let mut plot = Plot { width_mm: w, height_mm: h, ..plot() };
                plot.layers.truncate(1);
                let named = Some(paper.names[0].as_str());
                let profile = hpgl::LoadedPlotter::on(&plot, machine.clone(), named).unwrap();
                let [low, high] = profile.reach(&plot);
                let middle = low.midpoint(high);
                let ends = |by: f64| {
                    let (a, b) = (low - by, high + by);
                    // Along the border of the reach, lines at one coordinate are all or nothing.
                    let at = if by == 0.0 { low } else { middle };
                    let far = if by == 0.0 { high } else { middle };
                    [
                        [dvec2(a.x, at.y), dvec2(b.x, at.y)],
                        [dvec2(at.x, a.y), dvec2(at.x, b.y)],
                        [dvec2(a.x, far.y), dvec2(b.x, far.y)],
                        [dvec2(far.x, a.y), dvec2(far.x, b.y)],
                    ]
                };
                for (by, cut) in [(-0.1, false), (0.0, false), (0.5, true)] {
                    plot.layers[0].lines = Polylines::default();
                    ends(by).iter().for_each(|line| plot.layers[0].lines.push(*line));
                    let bytes = written(|out| hpgl::write(&plot, &profile, out));
                    let text = String::from_utf8(bytes).unwrap();
                    let steps = text.split("PD").skip(1).map(|rest| {
                        let mut numbers = rest.split([',', ';']).map(|n| n.parse().unwrap());
                        f64::hypot(numbers.next().unwrap(), numbers.next().unwrap())
                    });
                    let drawn = steps.sum::<f64>() * machine.unit;
                    let whole = plot.layers[0].lines.length_mm();
                    // Where the sheet itself ends first, its edge is the border.
                    let at_edge = low == DVec2::ZERO && high == dvec2(w, h);
                    if !cut || !at_edge {
                        let is_cut = drawn < whole - 0.2;
                        assert_eq!(is_cut, cut, "{} {named:?}: {drawn} of {whole}", machine.name);
                    }
                }
            }
        }
    }
}

#[test]
fn joints_survive_simplifying() {
    // A stroke ends on a slight bend of another one, which would otherwise be straightened.
    let lines = polylines(&[
        &[(0.0, 0.0), (10.0, 0.05), (20.0, 0.0)],
        &[(10.0, 0.05), (10.0, 30.0), (40.0, 30.0)],
        &[(40.0, 30.0), (40.0, 0.0)],
        &[(0.0, 0.0), (0.0, 50.0), (-10.0, 60.0)],
        &[(0.0, 0.0), (-30.0, 0.0)],
    ]);
    let options =
        OptimizeOptions { simplify_mm: 0.2, effort: Effort::None, ..OptimizeOptions::default() };
    let found = optimize_lines(&lines, None, &options).lines;
    let through = found.iter().filter(|line| line.contains(&dvec2(10.0, 0.05))).count();
    assert!(through >= 1, "{found:?}");
    let bar = found.iter().find(|line| line.contains(&dvec2(20.0, 0.0))).unwrap();
    assert!(bar.contains(&dvec2(10.0, 0.05)), "{bar:?}");
}

#[test]
fn ink_there_and_back_survives_simplifying() {
    for stroke in [
        &[(0.0, 0.0), (10.0, 0.0), (4.0, 0.0)][..],
        &[(0.0, 0.0), (10.0, 5.0), (2.0, 1.0), (8.0, 4.0)],
    ] {
        let options = OptimizeOptions {
            join_tolerance_mm: None,
            effort: Effort::None,
            ..OptimizeOptions::default()
        };
        let found = optimize_lines(&polylines(&[stroke]), None, &options).lines;
        assert_eq!(found.iter().next().unwrap().len(), stroke.len(), "{found:?}");
        assert!((found.length_mm() - polylines(&[stroke]).length_mm()).abs() < 1e-9);
    }
}

#[test]
fn parts_of_a_split_layer_all_have_ink() {
    let mut plot = plot();
    plot.layers[0].lines = polylines(&[
        &[(0.0, 0.0), (100.0, 0.0)],
        &[(0.0, 1.0), (3.0, 1.0)],
        &[(0.0, 2.0), (3.0, 2.0)],
        &[(0.0, 3.0), (6.0, 3.0)],
    ]);
    let parts = split_by_distance(&plot, 10.0, None);
    let lengths: Vec<f64> = parts.layers.iter().map(|layer| layer.lines.length_mm()).collect();
    assert_eq!(lengths[..3], [100.0, 6.0, 6.0]);
    assert!(parts.layers.iter().all(|layer| !layer.lines.is_empty()));
    let numbers: Vec<u32> = parts.layers.iter().map(|layer| layer.number).collect();
    assert_eq!(numbers, [1, 2, 3, 4]);
}

#[test]
fn cutting_a_straight_line_into_pieces_takes_no_time() {
    // From rest to rest: up to the limit, on, and down; v / a + length / v seconds.
    for (length, n) in [(100.0, 1000), (40.0, 7), (3.0, 64)] {
        let motion = Motion::SAXI;
        let (v, a) = (motion.down_speed, motion.down_acceleration);
        let lifts = motion.raise + motion.lower;
        let seconds =
            if length * a > v * v { v / a + length / v } else { 2.0 * (length / a).sqrt() };
        let mut lines = Polylines::default();
        lines.push((0..=n).map(|i| dvec2(length * f64::from(i) / f64::from(n), 5.0)));
        let found = estimate_lines(&lines, &motion).seconds - lifts;
        assert!((found - seconds).abs() < 1e-6, "{found} s instead of {seconds} s in {n} pieces");
    }
}

#[test]
fn no_joint_moves_ink_farther_than_half_of_the_tolerance() {
    let tolerance = 0.02;
    // Chains of points, each near the next: the whole of a chain is not one joint.
    let mut drawings: Vec<Vec<DVec2>> = Vec::new();
    for step in [0.3, 0.6, 0.9, 1.0] {
        for slant in [0.0, 0.5, 1.0] {
            let along = dvec2(1.0, slant).normalize() * (step * tolerance);
            drawings.push((0..40).map(|i| along * f64::from(i)).collect());
        }
    }
    // Two points near a third, on either side of it.
    drawings.push(vec![dvec2(0.0, 0.0), dvec2(0.002, 0.018), dvec2(0.002, -0.018)]);
    for points in drawings {
        let mut lines = Polylines::default();
        for (i, &p) in points.iter().enumerate() {
            lines.push([p, p + dvec2(0.0, 5.0 + (i % 7) as f64)]);
        }
        let graph = Graph::new(&lines, Joints::Near(tolerance));
        for &p in lines.iter().flatten() {
            let nearest = graph.positions.iter().map(|q| q.distance(p));
            let off = nearest.fold(f64::INFINITY, f64::min);
            assert!(off <= tolerance / 2.0 + 1e-12, "{p} moved by {off}");
        }
    }
}

#[test]
fn strokes_cut_by_distance_overlap_as_stated() {
    let mut plot = plot();
    plot.layers.truncate(1);
    plot.layers[0].lines =
        polylines(&[&[(0.0, 0.0), (12.0, 0.0), (25.0, 0.0)], &[(0.0, 9.0), (3.0, 9.0)]]);
    let spans = |overlap: f64| -> Vec<Vec<(f64, f64)>> {
        let parts = split_by_distance(&plot, 10.0, Some(overlap));
        let rounded = |x: f64| (x * 1e6).round() / 1e6;
        let ends = |line: &[DVec2]| (rounded(line[0].x), rounded(line[line.len() - 1].x));
        parts.layers.iter().map(|layer| layer.lines.iter().map(ends).collect()).collect()
    };
    assert_eq!(spans(0.0), [vec![(0.0, 10.0)], vec![(10.0, 20.0)], vec![(20.0, 25.0), (0.0, 3.0)]]);
    assert_eq!(spans(1.0), [vec![(0.0, 10.0)], vec![(9.0, 19.0)], vec![(18.0, 25.0), (0.0, 3.0)]],);
    let parts = split_by_distance(&plot, 10.0, Some(1.0));
    assert!(parts.layers.iter().all(|layer| layer.lines.length_mm() <= 10.0 + 1e-9));
}

#[test]
fn slanted_ink_that_nearly_overlaps_is_found_with_what_it_costs() {
    use hiddenline::stages::optimize::near_overlap;
    let mut plot = plot();
    plot.layers.truncate(1);
    // Twenty pairs that share 20 mm, with two decimals as files have them.
    let mut lines = Polylines::default();
    let rounded = |p: DVec2| (p * 100.0).round() / 100.0;
    for i in 0..20 {
        let (sin, cos) = (0.1 + 0.11 * f64::from(i)).sin_cos();
        let at = |r: f64| rounded(dvec2(140.0, 100.0) + dvec2(cos, sin) * r);
        lines.push([at(20.0), at(60.0)]);
        lines.push([at(40.0), at(80.0)]);
    }
    plot.layers[0].lines = lines;
    let found = near_overlap(&plot).unwrap();
    assert!((found.saved_mm - 400.0).abs() < 45.0, "{found:?}");
    assert!(found.tolerance_mm >= 0.005 && found.tolerance_mm <= 0.02, "{found:?}");
    assert_eq!(near_overlap(&self::plot()), None);
}

/// Two marks that a drawing has 100 mm apart are that far apart in every machine's units.
#[test]
fn machines_have_the_units_of_their_manuals() {
    for machine in hpgl::machines().unwrap() {
        // HP's 7475A is the one plotter with 40.2 steps per millimeter; all others have 40.
        let per_mm = if machine.name == "hp7475a" { 40.193 } else { 40.0 };
        for paper in &machine.paper {
            let [w, h] = paper.size;
            let mut plot = Plot { width_mm: w, height_mm: h, ..plot() };
            plot.layers.truncate(1);
            let marks = [w / 2.0 - 50.0, w / 2.0 + 50.0];
            let mark = |x: f64| [(x, h / 2.0), (x, h / 2.0 + 5.0)];
            plot.layers[0].lines = polylines(&[&mark(marks[0]), &mark(marks[1])]);
            let name = Some(paper.names[0].as_str());
            let plotter = hpgl::LoadedPlotter::on(&plot, machine.clone(), name).unwrap();
            let text = String::from_utf8(written(|out| hpgl::write(&plot, &plotter, out))).unwrap();
            let starts = read_hpgl(&text).0;
            let apart = f64::from((starts[1][0] - starts[0][0]).abs());
            assert!((apart - 100.0 * per_mm).abs() <= 1.0, "{}: {apart}", machine.name);
            // What is reached lies on the sheet.
            let corner = |x: i32, y: i32| {
                let [left, top] = paper.origin;
                (left + f64::from(x) * machine.unit, top - f64::from(y) * machine.unit)
            };
            let ((x0, y0), (x1, y1)) =
                (corner(paper.x[0], paper.y[0]), corner(paper.x[1], paper.y[1]));
            assert!(x0 >= -1e-9 && x1 <= w + 1e-9, "{} {name:?}: {x0} {x1}", machine.name);
            assert!(y1 >= -1e-9 && y0 <= h + 1e-9, "{} {name:?}: {y1} {y0}", machine.name);
        }
    }
}

#[test]
fn layers_of_one_number_are_drawn_by_one_pen() {
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='297mm' height='210mm' \
               viewBox='0 0 297 210' fill='none' stroke='black' \
               xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape'>"
        .to_owned();
    let layers = [
        ("2 a", 50),
        ("2 b", 60),
        ("3 c", 70),
        ("!3+S30 d", 80),
        ("2 a", 90),
        ("9 e", 99),
    ]
    .map(|(label, y)| {
        format!("<g inkscape:groupmode='layer' inkscape:label='{label}'><path d='M50 {y}h50'/></g>")
    });
    let svg = svg + &layers.concat() + "<path d='M50 40h50'/></svg>";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("pens.svg"), svg).unwrap();
    let written = |name: &str, more: &[&str]| {
        let arguments = [&["optimize", "pens.svg", "-o", name], more].concat();
        let output = crate::program::hiddenline(folder.path(), &arguments);
        assert!(output.status.success(), "{}", crate::program::text(&output.stderr));
        std::fs::read_to_string(folder.path().join(name)).unwrap()
    };
    // 9 is no pen of the machine: it takes the first that no label asks for, after what has no label.
    let hpgl = written("pens.plt", &["--machine", "hp7475a"]);
    let pens: Vec<&str> = hpgl.lines().filter(|line| line.starts_with("SP")).collect();
    let pens: Vec<&str> = pens.iter().map(|line| &line[..3]).collect();
    assert_eq!(pens, ["SP2", "SP2", "SP2", "SP3", "SP3", "SP4", "SP1"]);
    let gcode = written("pens.gcode", &[]);
    // To pen 3, the pause that its second label asks for, to pen 9, to pen 1.
    assert_eq!(gcode.matches("put in pen").count(), 4, "{gcode}");
    assert!(gcode.contains("put in pen 9"), "{gcode}");
    // In SVG layers have names of their own.
    let again = written("again.svg", &[]);
    let document = roxmltree::Document::parse(&again).unwrap();
    let ids: Vec<&str> = document
        .descendants()
        .filter_map(|n| n.attribute("id"))
        .filter(|id| id.starts_with("pen"))
        .collect();
    assert_eq!(ids, ["pen2-a", "pen2-b", "pen2-a-2", "pen3-c", "pen3-d", "pen9-e", "pen1-000000"]);
}

#[test]
fn lines_that_only_touch_the_limits_leave_no_dots() {
    let mut plot = Plot { width_mm: 297.0, height_mm: 210.0, ..plot() };
    plot.layers.truncate(1);
    let profile = hpgl::LoadedPlotter::new(&plot, "hp7475a", Some("a4")).unwrap();
    let [low, high] = profile.reach(&plot);
    let dots = |lines: &[[DVec2; 2]]| {
        let mut plot = plot.clone();
        plot.layers[0].lines = Polylines::default();
        lines.iter().for_each(|line| plot.layers[0].lines.push(*line));
        let text = String::from_utf8(written(|out| hpgl::write(&plot, &profile, out))).unwrap();
        text.matches("PD;").count()
    };
    let out = DVec2::new(5.0, -5.0);
    let corner = dvec2(low.x, low.y);
    for by in [0.0, 0.003, 0.006, 0.01] {
        assert_eq!(dots(&[[corner + by - out, corner + by + out]]), 0, "{by}");
        assert_eq!(dots(&[[dvec2(low.x - by, high.y), dvec2(low.x - 9.0, high.y)]]), 0, "{by}");
    }
    // What was a dot is one, and so is a stroke shorter than a unit.
    let middle = low.midpoint(high);
    assert_eq!(dots(&[[middle, middle], [middle + 1.0, middle + dvec2(1.001, 1.0)]]), 2);
}
