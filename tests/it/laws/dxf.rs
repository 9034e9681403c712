//! DXF read back by a reader of tags that knows nothing of the writer: units, layers, linetypes.

use glam::{DVec2, dvec2};
use hiddenline::stages::plot::{Layer, Plot, Polylines};
use hiddenline::stages::write::dxf::{self, DxfScale, DxfUnit};

type Tag = (i32, String);

fn tags(plot: &Plot, scale: DxfScale) -> Vec<Tag> {
    let mut bytes = Vec::new();
    dxf::write(plot, scale, &mut bytes).unwrap();
    let text = String::from_utf8(bytes).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len() % 2, 0);
    lines.chunks(2).map(|pair| (pair[0].trim().parse().unwrap(), pair[1].to_owned())).collect()
}

/// The value after a variable of the header.
fn variable<'a>(tags: &'a [Tag], name: &str) -> &'a str {
    let at = tags.iter().position(|tag| *tag == (9, name.to_owned())).unwrap();
    &tags[at + 1].1
}

/// The records of a kind, each from its own tag to the next `0`.
fn records<'a>(tags: &'a [Tag], kind: &str) -> Vec<&'a [Tag]> {
    let starts = (0..tags.len()).filter(|&i| tags[i] == (0, kind.to_owned()));
    let end = |start: usize| (start + 1..tags.len()).find(|&i| tags[i].0 == 0).unwrap();
    starts.map(|start| &tags[start..end(start)]).collect()
}

/// Values of a code in a record.
fn values(record: &[Tag], code: i32) -> Vec<&str> {
    record.iter().filter(|tag| tag.0 == code).map(|tag| tag.1.as_str()).collect()
}

fn layer(number: u32, dash_mm: Option<[f64; 2]>, lines: &[&[(f64, f64)]]) -> Layer {
    let mut polylines = Polylines::default();
    lines.iter().for_each(|line| polylines.push(line.iter().map(|&(x, y)| dvec2(x, y))));
    let name = if dash_mm.is_some() { "hidden" } else { "visible" };
    Layer { number, name: name.into(), dash_mm, lines: polylines, ..Layer::default() }
}

fn plot() -> Plot {
    let corner: &[(f64, f64)] = &[(10.0, 10.0), (40.0, 10.0), (40.0, 50.0)];
    let triangle: &[(f64, f64)] = &[(60.1237, 20.0), (90.0, 20.0), (90.0, 60.0), (60.1237, 20.0)];
    let layers = vec![
        layer(1, None, &[corner]),
        layer(2, Some([2.5, 1.25]), &[corner, triangle]),
        layer(3, Some([5.0, 1.0]), &[corner]),
        layer(4, Some([2.5, 1.25]), &[triangle]),
    ];
    Plot { width_mm: 200.0, height_mm: 100.0, layers, ..Plot::default() }
}

#[test]
fn each_dash_pattern_is_a_linetype_that_its_layers_name() {
    let tags = tags(&plot(), DxfScale::default());
    let linetypes = records(&tags, "LTYPE");
    let names: Vec<&str> = linetypes.iter().flat_map(|record| values(record, 2)).collect();
    assert_eq!(names, ["CONTINUOUS", "DASHED", "DASHED_2"]);
    let pattern = |i: usize| {
        let record: &[Tag] = linetypes[i];
        (values(record, 73)[0], values(record, 40)[0], values(record, 49))
    };
    assert_eq!(pattern(0), ("0", "0", vec![]));
    assert_eq!(pattern(1), ("2", "3.75", vec!["2.5", "-1.25"]));
    assert_eq!(pattern(2), ("2", "6", vec!["5", "-1"]));
    let layers = records(&tags, "LAYER");
    let used: Vec<&str> = layers.iter().flat_map(|record| values(record, 6)).collect();
    assert_eq!(used, ["CONTINUOUS", "DASHED", "DASHED_2", "DASHED"]);
    // A table says how many entries follow; linetypes come before the layers that name them.
    let counts: Vec<&str> = records(&tags, "TABLE").iter().map(|t| values(t, 70)[0]).collect();
    assert_eq!(counts, ["3", "4"]);
    let first = |kind: &str| tags.iter().position(|tag| *tag == (0, kind.to_owned()));
    assert!(first("LTYPE") < first("LAYER"));
}

#[test]
fn dashes_run_on_around_the_corners_of_polylines() {
    let tags = tags(&plot(), DxfScale::default());
    let flags: Vec<u32> = records(&tags, "POLYLINE")
        .iter()
        .map(|record| values(record, 70)[0].parse().unwrap())
        .collect();
    // 1 is closed, 128 a linetype that runs on.
    assert_eq!(flags, [0, 128, 129, 128, 129]);
}

/// All points of vertices.
fn points(tags: &[Tag]) -> Vec<DVec2> {
    let number = |record: &[Tag], code| values(record, code)[0].parse::<f64>().unwrap();
    records(tags, "VERTEX").iter().map(|v| dvec2(number(v, 10), number(v, 20))).collect()
}

#[test]
fn coordinates_at_a_scale_are_model_units() {
    let on_paper = points(&tags(&plot(), DxfScale::default()));
    assert_eq!(on_paper[0], dvec2(10.0, 90.0));
    for (unit, number, measurement, mm_per_unit) in [
        (DxfUnit::Millimeter, "4", "1", 0.5),
        (DxfUnit::Centimeter, "5", "1", 10.0 / 3.0),
        (DxfUnit::Meter, "6", "1", 1000.0),
        (DxfUnit::Inch, "1", "0", 25.4 / 48.0),
    ] {
        let tags = tags(&plot(), DxfScale { mm_per_unit, unit });
        assert_eq!(variable(&tags, "$INSUNITS"), number);
        assert_eq!(variable(&tags, "$MEASUREMENT"), measurement);
        let corner: f64 = variable(&tags, "$EXTMAX").parse().unwrap();
        assert!((corner * mm_per_unit - 200.0).abs() <= 1e-4);
        // As fine on paper as without a scale.
        for (p, mm) in points(&tags).iter().zip(&on_paper) {
            assert!((*p * mm_per_unit).distance(*mm) <= 1e-4, "{unit:?}: {p} {mm}");
        }
        let dashes = records(&tags, "LTYPE")[1];
        let dash: f64 = values(dashes, 49)[0].parse().unwrap();
        assert!((dash * mm_per_unit - 2.5).abs() <= 1e-4);
    }
}
