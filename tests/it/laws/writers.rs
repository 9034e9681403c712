//! Page and writers: what is on paper, where, and in which form.

use glam::{DVec2, DVec3, dvec2};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::page::{
    Orientation, Page, PageError, PageOptions, Paper, PlacedPlot, Placement, PlotOptions,
};
use hiddenline::stages::plot::{Layer, Pen, Plot, Polylines};
use hiddenline::stages::strokes::HiddenLines;
use hiddenline::stages::strokes::{StrokeKind, Strokes};
use hiddenline::stages::write::png::{PngError, Resolution};
use hiddenline::stages::write::svg::StrokeElement;
use hiddenline::stages::write::{json, png, svg};

fn orthographic() -> Camera {
    Camera::new(DVec3::NEG_Y, DVec3::ZERO, DVec3::Z, Projection::Orthographic).expect("good")
}

fn perspective() -> Camera {
    let projection = Projection::Perspective { fov_deg: 40.0, near: 1e-6 };
    Camera::new(dvec3_y(-2.0), DVec3::ZERO, DVec3::Z, projection).expect("good")
}

fn dvec3_y(y: f64) -> DVec3 {
    DVec3::new(0.0, y, 0.0)
}

fn drawing(strokes: &[&[DVec2]]) -> Strokes {
    let mut drawing = Strokes::default();
    for points in strokes {
        drawing.push(StrokeKind::Crease, 0, points.iter().copied());
    }
    drawing
}

fn options(hidden: HiddenLines) -> PlotOptions {
    PlotOptions {
        pen_width_mm: 0.3,
        pens: Vec::new(),
        hidden,
        dash: None,
        keep_dashes_whole: false,
        title: "a <title> & more".into(),
        source: "hiddenline draw 'a<b'".into(),
    }
}

fn placed(drawing: &Strokes, camera: &Camera, page: &PageOptions) -> PlacedPlot {
    Page::place(&drawing.extent(camera), camera, page)
        .expect("fits")
        .plot(drawing, options(HiddenLines::None))
}

fn first_line(placed: &PlacedPlot) -> Vec<DVec2> {
    placed.plot.layers[0].lines.iter().next().expect("a line").to_vec()
}

fn svg_of(lines: &[&[DVec2]], element: StrokeElement) -> String {
    let mut polylines = Polylines::default();
    for line in lines {
        polylines.push(line.iter().copied());
    }
    let pen = Pen { width_mm: 0.3, color: "#000000".into() };
    let layer =
        Layer { number: 1, name: "visible".into(), pen, lines: polylines, ..Default::default() };
    let plot = Plot {
        width_mm: 297.0,
        height_mm: 210.0,
        title: "a <title> & more".into(),
        source: "hiddenline draw 'a<b'".into(),
        layers: vec![layer],
    };
    let mut bytes = Vec::new();
    svg::write(&plot, element, &mut bytes).expect("memory");
    String::from_utf8(bytes).expect("text")
}

#[test]
fn a_wide_drawing_turns_the_page_and_fills_it_between_the_margins() {
    let line = [dvec2(0.0, 0.0), dvec2(4.0, 1.0)];
    let placed = placed(&drawing(&[&line]), &orthographic(), &PageOptions::default());
    assert_eq!((placed.plot.width_mm, placed.plot.height_mm), (297.0, 210.0));
    // 277 mm for 4 units, centered; y points down.
    let half_height = 277.0 / 4.0 / 2.0;
    let expected = [dvec2(10.0, 105.0 + half_height), dvec2(287.0, 105.0 - half_height)];
    for (got, expected) in first_line(&placed).iter().zip(expected) {
        assert!(got.distance(expected) < 1e-9, "{got} is not {expected}");
    }
    assert!(!placed.cropped);
}

#[test]
fn a_high_drawing_keeps_the_page_upright_unless_asked() {
    let drawing = drawing(&[&[dvec2(0.0, 0.0), dvec2(1.0, 4.0)]]);
    let size = |orientation| {
        let options = PageOptions { orientation, ..PageOptions::default() };
        let plot = placed(&drawing, &orthographic(), &options).plot;
        (plot.width_mm, plot.height_mm)
    };
    assert_eq!(size(None), (210.0, 297.0));
    assert_eq!(size(Some(Orientation::Landscape)), (297.0, 210.0));
}

#[test]
fn a_scale_is_true_in_millimetres() {
    let drawing = drawing(&[&[dvec2(0.0, 0.0), dvec2(50.0, 0.0)]]);
    let placement = Placement::Scale { mm_per_unit: 0.5 };
    let options = PageOptions { placement, ..PageOptions::default() };
    let line = first_line(&placed(&drawing, &orthographic(), &options));
    assert!((line[0].distance(line[1]) - 25.0).abs() < 1e-9);
}

#[test]
fn a_scale_in_perspective_is_true_at_the_target() {
    // At the target, 2 units away, this image is of 1 unit.
    let drawing = drawing(&[&[dvec2(-0.25, 0.0), dvec2(0.25, 0.0)]]);
    let placement = Placement::Scale { mm_per_unit: 10.0 };
    let options = PageOptions { placement, ..PageOptions::default() };
    let line = first_line(&placed(&drawing, &perspective(), &options));
    assert!((line[0].distance(line[1]) - 10.0).abs() < 1e-9);
}

#[test]
fn the_field_of_view_fills_the_height_and_the_rest_is_cropped() {
    let edge = 20_f64.to_radians().tan();
    let drawing =
        drawing(&[&[dvec2(0.0, -edge), dvec2(0.0, edge)], &[dvec2(0.0, 0.0), dvec2(9.0, 9.0)]]);
    let options = PageOptions { placement: Placement::FieldOfView, ..PageOptions::default() };
    let placed = placed(&drawing, &perspective(), &options);
    let line = first_line(&placed);
    assert!(line[0].distance(dvec2(148.5, 200.0)) < 1e-9, "{}", line[0]);
    assert!(line[1].distance(dvec2(148.5, 10.0)) < 1e-9, "{}", line[1]);
    assert!(placed.cropped);
    let within = |p: &DVec2| (10.0..=287.0).contains(&p.x) && (10.0..=200.0).contains(&p.y);
    assert!(placed.plot.layers[0].lines.iter().flatten().all(within));
}

#[test]
fn points_far_out_do_not_shrink_a_perspective_drawing() {
    let far_out =
        drawing(&[&[dvec2(-0.2, 0.0), dvec2(0.2, 0.0)], &[dvec2(0.0, 0.0), dvec2(0.0, 1e6)]]);
    let page =
        Page::place(&far_out.extent(&perspective()), &perspective(), &PageOptions::default())
            .expect("fits");
    // The line is cropped at 60°, so the box is √3 high, on 277 mm.
    assert!((page.mm_per_image_unit() - 277.0 / 3_f64.sqrt()).abs() < 1e-6);
}

#[test]
fn margins_wider_than_the_page_are_an_error() {
    let options = PageOptions { margin_mm: 105.0, ..PageOptions::default() };
    let page = Page::place(&Strokes::default().extent(&orthographic()), &orthographic(), &options);
    assert!(matches!(page, Err(PageError::Margins { .. })), "{page:?}");
}

#[test]
fn dashes_are_real_segments_on_the_hidden_layer() {
    let mut drawing = Strokes::default();
    drawing.push(StrokeKind::Crease, 0, [dvec2(0.0, 0.0), dvec2(4.0, 0.0)]);
    drawing.push(StrokeKind::Crease, 2, [dvec2(0.0, 1.0), dvec2(4.0, 1.0)]);
    let page =
        Page::place(&drawing.extent(&orthographic()), &orthographic(), &PageOptions::default())
            .expect("fits");
    let plot = page.plot(&drawing, options(HiddenLines::Dashed)).plot;
    let names: Vec<_> = plot.layers.iter().map(|layer| (layer.number, &*layer.name)).collect();
    assert_eq!(names, [(1, "visible"), (2, "hidden")]);
    assert_eq!(plot.layers[0].lines.len(), 1);
    // 277 mm in periods of about 4.5 mm.
    assert_eq!(plot.layers[1].lines.len(), 62);
    let solid = page.plot(&drawing, options(HiddenLines::Solid)).plot;
    assert_eq!(solid.layers[1].lines.len(), 1);
    assert_eq!(page.plot(&drawing, options(HiddenLines::None)).plot.layers.len(), 1);
}

#[test]
fn svg_is_in_millimetres_and_has_a_layer_for_each_pen() {
    let text = svg_of(&[&[dvec2(20.0, 20.0), dvec2(277.0, 20.0)]], StrokeElement::Path);
    let document = roxmltree::Document::parse(&text).expect("valid XML");
    let root = document.root_element();
    assert_eq!(root.attribute("width"), Some("297mm"));
    assert_eq!(root.attribute("height"), Some("210mm"));
    assert_eq!(root.attribute("viewBox"), Some("0 0 297 210"));
    let inkscape = "http://www.inkscape.org/namespaces/inkscape";
    let layer = root.children().find(|node| node.tag_name().name() == "g").expect("a layer");
    assert_eq!(layer.attribute("id"), Some("pen1-visible"));
    assert_eq!(layer.attribute((inkscape, "label")), Some("1 visible"));
    assert_eq!(layer.attribute((inkscape, "groupmode")), Some("layer"));
    assert_eq!(layer.attribute("fill"), Some("none"));
    assert_eq!(layer.attribute("stroke-width"), Some("0.3"));
}

#[test]
fn svg_escapes_title_and_source() {
    let text = svg_of(&[], StrokeElement::Path);
    let document = roxmltree::Document::parse(&text).expect("valid XML");
    let text_of = |tag: &str| {
        document.descendants().find(|node| node.tag_name().name() == tag).and_then(|n| n.text())
    };
    assert_eq!(text_of("title"), Some("a <title> & more"));
    assert_eq!(text_of("source"), Some("hiddenline draw 'a<b'"));
}

#[test]
fn svg_paths_have_three_decimals_and_close_with_z() {
    let line = [dvec2(1.000_4, 2.5), dvec2(3.123_456, 4.0)];
    let (a, b, c) = (dvec2(0.0, 0.0), dvec2(1.0, 0.0), dvec2(0.0, 1.0));
    let text = svg_of(&[&line, &[a, b, c, a], &[a, b, a]], StrokeElement::Path);
    let expected = ["M1 2.5L3.123 4", "M0 0L1 0L0 1Z", "M0 0L1 0L0 0"];
    let svg = "http://www.w3.org/2000/svg";
    let document = roxmltree::Document::parse(&text).expect("valid XML");
    let paths: Vec<_> = document
        .descendants()
        .filter(|node| node.has_tag_name((svg, "path")))
        .filter_map(|node| node.attribute("d"))
        .collect();
    assert_eq!(paths, expected);
}

#[test]
fn svg_leaves_out_points_that_round_to_one() {
    let line = [dvec2(1.0, 1.0), dvec2(1.000_2, 1.0), dvec2(2.0, 1.0)];
    let dot = [dvec2(5.0, 5.0), dvec2(5.000_1, 5.0)];
    let text = svg_of(&[&line, &dot], StrokeElement::Path);
    assert!(text.contains("\"M1 1L2 1\""), "{text}");
    assert_eq!(text.matches("<path").count(), 1);
}

#[test]
fn svg_can_be_polylines() {
    let text = svg_of(&[&[dvec2(1.0, 2.0), dvec2(3.0, 4.5)]], StrokeElement::Polyline);
    assert!(text.contains("<polyline points=\"1,2 3,4.5\"/>"), "{text}");
    assert!(!text.contains("<path"));
}

#[test]
fn json_numbers_read_back_as_they_were() {
    let camera = perspective();
    let points = [dvec2(0.1 + 0.2, 1.0 / 3.0), dvec2(-1e-300, f64::MAX)];
    let mut drawing = Strokes::default();
    drawing.push(StrokeKind::Silhouette, 0, points);
    drawing.push(StrokeKind::Mesh, 3, points);
    let page = Page::place(&self::drawing(&[]).extent(&camera), &camera, &PageOptions::default())
        .expect("fits");
    let mut bytes = Vec::new();
    json::write(&drawing, &camera, page.page_from_image, &mut bytes).expect("memory");
    let text = String::from_utf8(bytes).expect("text");
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(value["format"], "hiddenline-strokes");
    assert_eq!(value["version"], 1);
    assert_eq!(value["camera"]["projection"], "perspective");
    assert_eq!(value["camera"]["fov"], 40.0);
    assert_eq!(value["camera"]["near"], 1e-6);
    assert_eq!(value["page_from_image"].as_array().map(Vec::len), Some(6));
    let [first, second] = [&value["strokes"][0], &value["strokes"][1]];
    assert_eq!((&first["kind"], &first["visible"]), (&"silhouette".into(), &true.into()));
    assert_eq!(first.get("qi"), None);
    assert_eq!((&second["visible"], &second["qi"]), (&false.into(), &3.into()));
    for (i, p) in points.iter().enumerate() {
        assert_eq!(first["points"][i][0].as_f64().map(f64::to_bits), Some(p.x.to_bits()));
        assert_eq!(first["points"][i][1].as_f64().map(f64::to_bits), Some(p.y.to_bits()));
    }
    assert_eq!(json::read_camera(&text).ok(), Some(camera));
}

#[test]
fn png_is_true_to_scale_on_white() {
    let mut lines = Polylines::default();
    lines.push([dvec2(0.0, 5.0), dvec2(20.0, 5.0)]);
    let pen = Pen { width_mm: 1.0, color: "#000000".into() };
    let layer = Layer { number: 1, name: "visible".into(), pen, lines, ..Layer::default() };
    let plot = Plot { width_mm: 20.0, height_mm: 10.0, layers: vec![layer], ..Plot::default() };
    let mut bytes = Vec::new();
    png::write(&plot, Resolution::WidthPx(200), &mut bytes).expect("memory");
    let mut reader = ::png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
    let info = reader.next_frame(&mut pixels).expect("PNG");
    assert_eq!((info.width, info.height), (200, 100));
    // One millimetre is ten pixels: rows 45 to 54 are black in the middle of the picture.
    let column: Vec<u8> = (0..100).map(|row| pixels[row * 200 + 100]).collect();
    let expected: Vec<u8> = (0..100).map(|y| if (45..55).contains(&y) { 0 } else { 255 }).collect();
    assert_eq!(column, expected);
    let huge = png::write(&plot, Resolution::Dpi(1e9), &mut Vec::new());
    assert!(matches!(huge, Err(PngError::Size { .. })), "{huge:?}");
}

#[test]
fn png_shows_travel_from_the_end_of_a_stroke_to_the_beginning_of_the_next() {
    let mut lines = Polylines::default();
    lines.push([dvec2(2.0, 2.0), dvec2(18.0, 2.0)]);
    lines.push([dvec2(2.0, 8.0), dvec2(18.0, 8.0)]);
    let pen = Pen { width_mm: 0.5, color: "#000000".into() };
    let layer = Layer { number: 1, name: "visible".into(), pen, lines, ..Layer::default() };
    let plot = Plot { width_mm: 20.0, height_mm: 10.0, layers: vec![layer], ..Plot::default() };
    let mut bytes = Vec::new();
    let marks = png::Marks { travel: true, order: false };
    png::write_marked(&plot, Resolution::WidthPx(400), marks, &mut bytes).expect("memory");
    let mut reader = ::png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
    let info = reader.next_frame(&mut pixels).expect("PNG");
    assert_eq!((info.width, info.color_type), (400, ::png::ColorType::Rgb));
    let is_red = |x: f64, y: f64| {
        let at = 3 * (400 * (20.0 * y) as usize + (20.0 * x) as usize);
        pixels[at] > 180 && pixels[at + 1] < 150
    };
    for k in 1..8 {
        let part = f64::from(k) / 8.0;
        assert!(is_red(18.0 - 16.0 * part, 2.5 + 5.0 * part + (part - 0.5)), "{part}");
    }
    assert!(!is_red(2.0, 5.0) && !is_red(18.0, 5.0));
}

#[test]
fn a_page_given_in_numbers_is_not_turned() {
    let drawing = drawing(&[&[dvec2(0.0, 0.0), dvec2(4.0, 1.0)]]);
    let paper: Paper = "100x200".parse().expect("a size");
    let plot =
        placed(&drawing, &orthographic(), &PageOptions { paper, ..PageOptions::default() }).plot;
    assert_eq!((plot.width_mm, plot.height_mm), (100.0, 200.0));
}
