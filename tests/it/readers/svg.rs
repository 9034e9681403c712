//! Reading foreign SVGs: sizes, shapes, layers, and files made to do harm.

use glam::{DVec2, dvec2};
use hiddenline::stages::read_svg::{LineSvg, SvgError, SvgOptions, read};

fn svg(attributes: &str, content: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' \
         xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' {attributes}>{content}</svg>"
    )
}

fn on_page(content: &str) -> LineSvg {
    read(&svg("width='100mm' height='50mm' viewBox='0 0 100 50'", content), &SvgOptions::default())
        .unwrap()
}

fn strokes(file: &LineSvg) -> Vec<Vec<DVec2>> {
    file.plot.layers.iter().flat_map(|l| l.lines.iter().map(<[DVec2]>::to_vec)).collect()
}

fn near(found: &[DVec2], wanted: &[(f64, f64)]) {
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for (p, &(x, y)) in found.iter().zip(wanted) {
        assert!(p.distance(dvec2(x, y)) < 1e-9, "{found:?} instead of {wanted:?}");
    }
}

#[test]
fn pages_have_their_true_size() {
    let size = |attributes: &str| {
        let plot = read(&svg(attributes, ""), &SvgOptions::default()).unwrap().plot;
        ((plot.width_mm * 1e6).round() / 1e6, (plot.height_mm * 1e6).round() / 1e6)
    };
    assert_eq!(size("width='297mm' height='210mm' viewBox='0 0 297 210'"), (297.0, 210.0));
    assert_eq!(size("width='8.5in' height='11in'"), (215.9, 279.4));
    assert_eq!(size("width='29.7cm' height='96'"), (297.0, 25.4));
    assert_eq!(size("viewBox='0 0 96 192'"), (25.4, 50.8));
}

#[test]
fn straight_shapes_lie_where_svg_puts_them() {
    let file = on_page(
        "<g transform='translate(10 5) scale(2)'><line x1='1' y1='2' x2='3' y2='4'/></g>\
         <polyline points='1,1 2,1 2,2'/><polygon points='1,1 2,1 2,2'/>\
         <rect x='10%' y='10%' width='5' height='2'/>\
         <path d='m 1 1 h 2 v 3 z l 5 5 M 7 7 L 8 8'/>",
    );
    let found = strokes(&file);
    near(&found[0], &[(12.0, 9.0), (16.0, 13.0)]);
    near(&found[1], &[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0)]);
    near(&found[2], &[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 1.0)]);
    near(&found[3], &[(10.0, 5.0), (15.0, 5.0), (15.0, 7.0), (10.0, 7.0), (10.0, 5.0)]);
    near(&found[4], &[(1.0, 1.0), (3.0, 1.0), (3.0, 4.0), (1.0, 1.0)]);
    near(&found[5], &[(1.0, 1.0), (6.0, 6.0)]);
    near(&found[6], &[(7.0, 7.0), (8.0, 8.0)]);
    assert_eq!(found.len(), 7);
}

#[test]
fn curves_keep_within_the_tolerance() {
    for tolerance_mm in [0.5, 0.02, 0.001] {
        let options = SvgOptions { tolerance_mm, ..SvgOptions::default() };
        let content = "<g transform='scale(0.5)'><circle cx='40' cy='40' r='30'/>\
            <path d='M 70 40 A 30 30 0 1 1 10 40 A 30 30 0 0 1 70 40'/>\
            <rect x='10' y='10' width='60' height='60' rx='30'/></g>";
        let page = svg("width='100mm' height='50mm' viewBox='0 0 100 50'", content);
        let found = strokes(&read(&page, &options).unwrap());
        assert_eq!(found.len(), 3);
        for line in found {
            assert_eq!(line.first(), line.last());
            for pair in line.windows(2) {
                for p in [pair[0], pair[0].lerp(pair[1], 0.5)] {
                    let off = (p.distance(dvec2(20.0, 20.0)) - 15.0).abs();
                    assert!(off <= 1.2 * tolerance_mm, "{off} at {tolerance_mm}");
                }
            }
        }
    }
    // B(½) of the cubic is (0 + 3·0 + 3·8 + 8)/8, 6; smooth and quadratic ones go on from there.
    let file = on_page("<path d='M0 0 C 0 8 8 8 8 0 S 16 -8 16 0 Q 20 8 24 0 T 32 0'/>");
    let line = strokes(&file).remove(0);
    for p in [(4.0, 6.0), (12.0, -6.0), (20.0, 4.0), (28.0, -4.0)] {
        let nearest = line.windows(2).map(|s| {
            let along = s[1] - s[0];
            let t = ((dvec2(p.0, p.1) - s[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            (s[0] + along * t).distance(dvec2(p.0, p.1))
        });
        assert!(nearest.fold(f64::INFINITY, f64::min) <= 0.02);
    }
}

#[test]
fn used_and_nested_elements_are_drawn_in_their_place() {
    let file = on_page(
        "<defs><line id='l' x1='0' y1='0' x2='1' y2='0'/><symbol id='s' viewBox='0 0 10 10'>\
         <line x1='0' y1='0' x2='10' y2='10'/></symbol></defs>\
         <use href='#l' x='5' y='6'/><use xlink:href='#s' x='20' y='20' width='5' height='5'/>\
         <svg x='50' y='10' width='20' height='10' viewBox='0 0 10 10'>\
         <line x1='0' y1='0' x2='10' y2='0'/></svg><use href='#none'/>",
    );
    let found = strokes(&file);
    near(&found[0], &[(5.0, 6.0), (6.0, 6.0)]);
    near(&found[1], &[(20.0, 20.0), (25.0, 25.0)]);
    near(&found[2], &[(55.0, 10.0), (65.0, 10.0)]);
    assert_eq!((found.len(), file.warnings.len()), (3, 1));
}

#[test]
fn layers_and_colors_become_pens() {
    let file = on_page(
        "<style>.thin { stroke: blue; stroke-width: 0.2 }</style>\
         <g inkscape:groupmode='layer' inkscape:label='3 hidden' stroke='red' stroke-width='0.5'>\
         <path d='M0 0L1 1'/><path d='M0 0L1 2' class='thin'/></g>\
         <g inkscape:groupmode='layer' inkscape:label='notes'><path style='stroke:#0f0' d='M0 0L1 3'/></g>\
         <g display='none'><path d='M0 0L1 4'/></g><path fill='none' d='M0 0L1 5'/>\
         <path visibility='hidden' d='M0 0L1 6'/><text>x</text>",
    );
    let layers: Vec<(u32, &str, &str, usize)> = file
        .plot
        .layers
        .iter()
        .map(|l| (l.number, l.name.as_str(), l.pen.color.as_str(), l.lines.len()))
        .collect();
    assert_eq!(
        layers,
        [(3, "hidden", "#ff0000", 1), (1, "hidden", "#0000ff", 1), (2, "notes", "#00ff00", 1)],
        "a number in a label comes before those that are free"
    );
    assert!((file.plot.layers[0].pen.width_mm - 0.5).abs() < 1e-12);
    assert!((file.plot.layers[1].pen.width_mm - 0.2).abs() < 1e-12);
    assert_eq!(file.warnings.len(), 1);
}

#[test]
fn harmful_files_are_refused_in_words() {
    let error = |text: &str| read(text, &SvgOptions::default()).unwrap_err();
    let page = |content: &str| svg("width='100mm' height='50mm'", content);
    assert!(matches!(error("<svg"), SvgError::Xml(_)));
    assert!(matches!(error("<html/>"), SvgError::NotSvg(_)));
    assert!(matches!(error(&svg("width='0' height='1'", "")), SvgError::PageSize));
    assert!(matches!(error(&svg("width='1e300mm' height='1'", "")), SvgError::PageSize));
    for bad in [
        "<line x1='nan' x2='1'/>",
        "<path d='M 0 0 Q 1 1 1e300 5'/>",
        "<path d='M 0 0 A 1e300 1 0 0 0 1e300 5'/>",
        "<line x2='1e200' transform='scale(1e200)'/>",
        "<g transform='rotate('><line x2='1'/></g>",
        "<rect width='5' height='1e999'/>",
    ] {
        // Left out with a word, or out of reach.
        match read(&page(bad), &SvgOptions::default()) {
            Ok(file) => assert!(!file.warnings.is_empty(), "{bad}"),
            Err(fault) => assert!(matches!(fault, SvgError::Coordinate { .. }), "{bad}: {fault}"),
        }
    }
    let itself = "<g id='a'><use href='#a'/></g>";
    assert!(matches!(error(&page(itself)), SvgError::TooDeep { line: 1 }));
    let deep = format!("{}{}", "<g>".repeat(5000), "</g>".repeat(5000));
    assert!(matches!(error(&page(&deep)), SvgError::TooDeep { .. } | SvgError::Xml(_)));
}

#[test]
fn errors_stay_on_one_line() {
    for text in ["<svg/\n\n", "<svg>&\u{1b}[31m;</svg>", "<svg a=\n/>"] {
        let error = read(text, &SvgOptions::default()).unwrap_err().to_string();
        assert!(!error.chars().any(char::is_control), "{error:?}");
    }
}

#[test]
fn files_that_multiply_themselves_are_refused() {
    let entity =
        |name: char, of: char| format!("<!ENTITY {name} '{}'>", format!("&{of};").repeat(10));
    let laughs: String = ('b'..='k').zip('a'..='j').map(|(name, of)| entity(name, of)).collect();
    let text = format!("<!DOCTYPE svg [<!ENTITY a 'ha'>{laughs}]>{}", svg("", "<desc>&k;</desc>"));
    assert!(matches!(
        read(&text, &SvgOptions::default()),
        Err(SvgError::Xml(_) | SvgError::Entities)
    ));
    let long = "x".repeat(100_000);
    let many = "&a;".repeat(100_000);
    let text = format!(
        "<!DOCTYPE svg [<!ENTITY a '{long}'>]>{}",
        svg("", &format!("<desc>{many}</desc>"))
    );
    assert!(matches!(read(&text, &SvgOptions::default()), Err(SvgError::Entities)));
    let kind =
        format!("<!DOCTYPE svg [<!ENTITY w '10mm'>]>{}", svg("width='&w;' height='&w;'", ""));
    assert_eq!(read(&kind, &SvgOptions::default()).unwrap().plot.width_mm.round(), 10.0);
    // Each group shows the one before ten times.
    let mut uses = "<g id='u0'><line x2='1'/></g>".to_owned();
    for i in 1..12 {
        uses += &format!("<g id='u{i}'>{}</g>", format!("<use href='#u{}'/>", i - 1).repeat(10));
    }
    let options = SvgOptions { max_elements: 100_000, ..SvgOptions::default() };
    let page = svg("width='100mm' height='50mm'", &uses);
    assert!(matches!(read(&page, &options), Err(SvgError::TooMany { .. })));
    let options = SvgOptions { max_segments: 1000, ..SvgOptions::default() };
    let long = format!("<path d='M0 0{}'/>", "L1 1L0 0".repeat(1000));
    let page = svg("width='100mm' height='50mm'", &long);
    assert!(matches!(read(&page, &options), Err(SvgError::TooMany { .. })));
    let page = svg("width='100mm' height='50mm'", &"<circle r='5000'/>".repeat(50));
    assert!(matches!(read(&page, &options), Err(SvgError::TooMany { .. })));
}
