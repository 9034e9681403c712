//! What of an SVG is drawn: encodings, conditions, transforms, clip paths, dashes, covers, layers.

use std::io::Write;

use flate2::{Compression, write::GzEncoder};
use glam::{DVec2, dvec2};
use hiddenline::stages::read_svg::{LineSvg, SvgError, SvgOptions, read, read_bytes};

fn page(content: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' \
         xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' width='100mm' height='100mm' \
         viewBox='0 0 100 100' fill='none' stroke='black'>{content}</svg>"
    )
}

fn shown(content: &str) -> LineSvg {
    read(&page(content), &SvgOptions::default()).unwrap()
}

fn strokes(file: &LineSvg) -> Vec<Vec<DVec2>> {
    file.plot.layers.iter().flat_map(|l| l.lines.iter().map(<[DVec2]>::to_vec)).collect()
}

fn length(file: &LineSvg) -> f64 {
    file.plot.layers.iter().map(|layer| layer.lines.length_mm()).sum()
}

/// Asserts the length of all ink and the number of strokes.
#[track_caller]
fn assert_ink(content: &str, n: usize, mm: f64) {
    let file = shown(content);
    assert_eq!(strokes(&file).len(), n, "{content}: {:?}", strokes(&file));
    assert!((length(&file) - mm).abs() < 0.01, "{content}: {} mm", length(&file));
}

/// Asserts that one stroke is drawn, between two points.
#[track_caller]
fn assert_line(content: &str, from: (f64, f64), to: (f64, f64)) {
    let file = shown(content);
    let found = strokes(&file);
    assert_eq!(found.len(), 1, "{content}: {found:?}");
    let ends = [found[0][0], found[0][found[0].len() - 1]];
    for (end, wanted) in ends.iter().zip([from, to]) {
        assert!(end.distance(wanted.into()) < 1e-6, "{content}: {found:?}");
    }
}

fn zipped(text: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(text).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn files_are_read_in_any_encoding_they_declare() {
    let text = page("<title>Z\u{fc}rich</title><path d='M10 10h30'/>");
    let utf16 = |be: bool| -> Vec<u8> {
        let unit = |u: u16| if be { u.to_be_bytes() } else { u.to_le_bytes() };
        text.encode_utf16().flat_map(unit).collect()
    };
    let utf32 = |bytes: fn(u32) -> [u8; 4], before: &str| -> Vec<u8> {
        before.chars().chain(text.chars()).flat_map(|c| bytes(c.into())).collect()
    };
    let latin1: Vec<u8> = format!("<?xml version=\"1.0\" encoding='ISO-8859-1'?>{text}")
        .chars()
        .map(|c| c as u8)
        .collect();
    let with_bom = |bom: &[u8], rest: Vec<u8>| [bom, &rest].concat();
    let files = [
        text.clone().into_bytes(),
        with_bom(&[0xef, 0xbb, 0xbf], text.clone().into_bytes()),
        with_bom(&[0xff, 0xfe], utf16(false)),
        with_bom(&[0xfe, 0xff], utf16(true)),
        utf16(false),
        utf16(true),
        format!("<?xml version='1.0' encoding='UTF-16'?>{text}").into_bytes(),
        latin1.clone(),
        zipped(text.as_bytes()),
        zipped(&latin1),
        zipped(&zipped(text.as_bytes())),
        utf32(u32::to_le_bytes, ""),
        utf32(u32::to_be_bytes, ""),
        utf32(u32::to_le_bytes, "\u{feff}"),
        utf32(u32::to_be_bytes, "\u{feff}<?xml version='1.0' encoding='UTF-32'?>"),
        [zipped(&text.as_bytes()[..40]), zipped(&text.as_bytes()[40..])].concat(),
    ];
    for (i, bytes) in files.iter().enumerate() {
        let file = read_bytes(bytes, &SvgOptions::default()).unwrap();
        assert_eq!(file.plot.title, "Z\u{fc}rich", "file {i}");
        assert!((length(&file) - 30.0).abs() < 1e-9 && file.warnings.is_empty(), "file {i}");
    }
    let undeclared: Vec<u8> = text.chars().map(|c| c as u8).collect();
    let file = read_bytes(&undeclared, &SvgOptions::default()).unwrap();
    assert_eq!((file.plot.title.as_str(), file.warnings.len()), ("Z\u{fc}rich", 1));
}

#[test]
fn damaged_compression_and_unknown_encodings_are_refused() {
    let error = |bytes: &[u8]| read_bytes(bytes, &SvgOptions::default()).unwrap_err();
    let good = zipped(page("<path d='M10 10h30'/>").as_bytes());
    assert!(matches!(error(&good[..good.len() - 12]), SvgError::Gzip(_)));
    let odd = format!("<?xml version='1.0' encoding='klingon'?>{}", page(""));
    assert!(error(odd.as_bytes()).to_string().contains("klingon"));
}

#[test]
fn a_small_file_that_unpacks_to_gigabytes_is_refused() {
    let zeros = vec![b' '; 1 << 20];
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    for _ in 0..1025 {
        encoder.write_all(&zeros).unwrap();
    }
    let bomb = encoder.finish().unwrap();
    assert!(matches!(read_bytes(&bomb, &SvgOptions::default()), Err(SvgError::TooLarge)));
}

#[test]
fn switch_shows_the_first_child_whose_conditions_hold() {
    let foreign = "<foreignObject requiredExtensions='http://ns.adobe.com/x/'/>";
    assert_line(
        &format!("<switch>{foreign}<g><path d='M1 1h9'/></g></switch>"),
        (1.0, 1.0),
        (10.0, 1.0),
    );
    let tongues = "<path systemLanguage='de' d='M1 2h9'/><path systemLanguage='fr, en-US' d='M1 3h9'/>\
        <path d='M1 4h9'/>";
    assert_line(&format!("<switch>{tongues}</switch>"), (1.0, 3.0), (10.0, 3.0));
    let feature = "http://www.w3.org/TR/SVG11/feature#";
    let features = format!(
        "<switch><g requiredFeatures='{feature}Extensibility'><path d='M1 5h9'/></g>\
         <path requiredFeatures='{feature}Shape' d='M1 6h9'/><path d='M1 7h9'/></switch>"
    );
    assert_line(&features, (1.0, 6.0), (10.0, 6.0));
    let extension =
        "<switch><path requiredExtensions='http://x/' d='M1 8h9'/><path d='M1 9h9'/></switch>";
    assert_line(extension, (1.0, 9.0), (10.0, 9.0));
    let none = shown("<switch><path systemLanguage='de' d='M1 1h9'/></switch>");
    assert_eq!((strokes(&none).len(), none.warnings.len()), (0, 1));
}

#[test]
fn css_moves_shapes_like_attributes() {
    let path = |style: &str| format!("<path style='{style}' d='M10 10h10'/>");
    assert_line(&path("transform:translate(10px,20px)"), (20.0, 30.0), (30.0, 30.0));
    assert_line(&path("transform: translateY(1in) scale(2, 1)"), (20.0, 106.0), (40.0, 106.0));
    assert_line(&path("transform:rotate(0.25turn)"), (-10.0, 10.0), (-10.0, 20.0));
    assert_line(
        &path("transform:rotate(90deg);transform-origin:10px 10px"),
        (10.0, 10.0),
        (10.0, 20.0),
    );
    assert_line(&path("transform:translate(50%, 10%)"), (60.0, 20.0), (70.0, 20.0));
    // A rule of a style sheet goes before the attribute.
    let sheet = "<style>.m { transform: translate(5px) }</style>\
                 <path class='m' transform='scale(3)' d='M10 10h10'/>";
    assert_line(sheet, (15.0, 10.0), (25.0, 10.0));
    assert_line("<path style=\"d:path('M0 0h50')\"/>", (0.0, 0.0), (50.0, 0.0));
    let space = shown(&path("transform:rotateX(45deg)"));
    assert_eq!(space.warnings.len(), 1);
    let sum = shown("<rect style='width:calc(1px + 2px)' height='3'/>");
    assert!(sum.warnings.iter().any(|warning| warning.contains("`width: calc(1px + 2px)` is not")));
}

#[test]
fn transforms_may_be_about_an_elements_own_box() {
    let path =
        |style: &str| format!("<path style='transform-box:fill-box;{style}' d='M10 10h20'/>");
    let centered = "transform-origin:center;transform:rotate(180deg)";
    assert_line(&path(centered), (30.0, 10.0), (10.0, 10.0));
    assert_line(&path("transform:scale(2,1)"), (10.0, 10.0), (50.0, 10.0));
    assert_line(&path("transform:translate(50%)"), (20.0, 10.0), (40.0, 10.0));
    // A group's box is that of its contents, whose own transforms count.
    let group = format!("<g style='transform-box:fill-box;{centered}'>{}</g>", path(centered));
    assert_line(&group, (10.0, 10.0), (30.0, 10.0));
    // Many levels take no exponential time, or end at a limit.
    let deep = "<g style='transform-box:fill-box;transform:scale(1)'>".repeat(40);
    let deep = format!("{deep}<path d='M0 0h1'/>{}", "</g>".repeat(40));
    let options = SvgOptions { max_elements: 100_000, ..SvgOptions::default() };
    assert!(matches!(read(&page(&deep), &options), Err(SvgError::TooMany { .. })));
}

#[test]
fn css_variables_and_opacity_after_a_slash_are_understood() {
    let color = |content: &str| {
        let file = shown(content);
        file.plot.layers.first().map(|layer| layer.pen.color.clone())
    };
    let red = Some("#ff0000".to_owned());
    for content in [
        "<style>:root { --ink: red }</style><path stroke='var(--ink)' d='M0 0h1'/>",
        "<style>.a { --ink: red }</style><g class='a'><path style='stroke:var(--ink)' d='M0 0h1'/></g>",
        "<path style='stroke:var(--none, red)' d='M0 0h1'/>",
        "<path style='stroke:var(--none, var(--nor, red))' d='M0 0h1'/>",
        "<path style='--a: #f00; --b: var(--a); stroke:var(--b)' d='M0 0h1'/>",
        "<path style='stroke:rgb(255 0 0 / 50%)' d='M0 0h1'/>",
        "<path stroke='rgb(255 0 0 / 0.5)' d='M0 0h1'/>",
        "<g color='rgb(255 0 0/1)'><path stroke='currentColor' d='M0 0h1'/></g>",
    ] {
        assert_eq!(color(content), red, "{content}");
    }
    // Names of properties in any letter case, and rules for screens.
    let cases = [
        ("<style>path { STROKE: Red }</style>", red.clone()),
        ("<style>@media screen { path { stroke: red } }</style>", red.clone()),
        ("<style media='all'>path { stroke: red }</style>", red.clone()),
        ("<style media='print'>path { stroke: red }</style>", Some("#000000".into())),
    ];
    for (sheet, expected) in cases {
        assert_eq!(color(&format!("{sheet}<path d='M0 0h1'/>")), expected, "{sheet}");
    }
    // Rules for the root are not for what is in it.
    let inner = "<style>:root { stroke: red }</style><g stroke='blue'><path d='M0 0h1'/></g>";
    assert_eq!(color(inner), Some("#0000ff".into()));
    // An unknown variable leaves what is inherited, a transparent one is no ink.
    assert_eq!(color("<path style='stroke:var(--none)' d='M0 0h1'/>"), Some("#000000".into()));
    assert_eq!(color("<path style='stroke:rgb(255 0 0 / 0%)' d='M0 0h1'/>"), None);
    let width = shown("<path style='--w: 2; stroke-width:var(--w)' d='M0 0h1'/>");
    assert!((width.plot.layers[0].pen.width_mm - 2.0).abs() < 1e-9);
    // Rules and variables that would fill the memory.
    let rule = format!("<style>{}a {{ {} }}</style>", "a,".repeat(100_000), "b:c;".repeat(100_000));
    assert!(matches!(read(&page(&rule), &SvgOptions::default()), Err(SvgError::TooMany { .. })));
    let many: String = (0..20_000).map(|k| format!("--v{k}:var(--v);")).collect();
    assert_ink(&format!("<path style='--v:{};{many}' d='M0 0h1'/>", "1".repeat(9000)), 1, 1.0);
    // Variables that name themselves, and that grow without end, end all the same.
    let mut growing = "<path style='--v0: 1 1 1 1;".to_owned();
    for k in 1..30 {
        growing += &format!("--v{k}: var(--v{0}) var(--v{0}) var(--v{0});", k - 1);
    }
    growing += "--x: var(--x); stroke: var(--x); stroke-dasharray: var(--v29)' d='M0 0h1'/>";
    assert_ink(&growing, 1, 1.0);
}

#[test]
fn damaged_data_is_drawn_up_to_the_error_with_a_warning() {
    for (bad, mm) in [
        ("<path d='M10 10h30 foo L50 50'/>", 30.0),
        ("<path d='M0 0 L 3 4 L 1'/>", 5.0),
        ("<path d='M0 0h7zM 1 NaN'/>", 14.0),
        ("<path d='nonsense'/>", 0.0),
        ("<polyline points='0,0 3,4 5'/>", 5.0),
        ("<polyline points='0,0 3,4 x,1 9,9'/>", 5.0),
    ] {
        let file = shown(&format!("\n{bad}<path d='M10 20h30'/>"));
        assert!((length(&file) - 30.0 - mm).abs() < 1e-6, "{bad}: {}", length(&file));
        assert_eq!(file.warnings.len(), 1, "{bad}");
        assert!(file.warnings.first().unwrap().starts_with("line 2: "), "{:?}", file.warnings);
    }
}

#[test]
fn clip_paths_leave_what_is_inside() {
    let cross = "<path d='M0 50H100'/><path d='M50 0V100'/>";
    let clipped = |clip: &str| format!("<defs>{clip}</defs><g clip-path='url(#c)'>{cross}</g>");
    let circle = "<clipPath id='c'><circle cx='50' cy='50' r='20'/></clipPath>";
    let file = shown(&clipped(circle));
    // Chords of the circle leave its radius short by the tolerance at most.
    assert!((length(&file) - 80.0).abs() < 4.0 * 0.02 && file.warnings.is_empty());
    assert_ink(
        &clipped("<clipPath id='c'><rect x='40' y='0' width='5' height='100'/></clipPath>"),
        1,
        5.0,
    );
    // Two shapes are one area; a ring with a hole is two pieces of each line.
    let two =
        "<rect x='10' y='45' width='10' height='10'/><rect x='15' y='45' width='10' height='10'/>";
    assert_ink(&clipped(&format!("<clipPath id='c'>{two}</clipPath>")), 1, 15.0);
    let ring = "<path clip-rule='evenodd' d='M30 30h40v40h-40zM40 40h20v20h-20z'/>";
    assert_ink(&clipped(&format!("<clipPath id='c'>{ring}</clipPath>")), 4, 40.0);
    // Nested: the clip path is clipped, and so is the group around.
    let nested = "<clipPath id='d'><rect width='50' height='100'/></clipPath>\
                  <clipPath id='c' clip-path='url(#d)'><rect x='40' y='40' width='20' height='20'/></clipPath>";
    assert_ink(&clipped(nested), 2, 10.0 + 20.0);
    let around = format!(
        "<g clip-path='url(#e)'>{}</g><clipPath id='e'><rect y='50' width='99' height='9'/>\
        </clipPath>",
        clipped("<clipPath id='c'><rect x='40' y='40' width='20' height='20'/></clipPath>")
    );
    assert_ink(&around, 2, 20.0 + 9.0);
    // The units of the box of what is clipped, 100 wide and high.
    let box_units = "<clipPath id='c' clipPathUnits='objectBoundingBox'><rect width='.3' height='1'/></clipPath>";
    assert_ink(&clipped(box_units), 1, 30.0);
    let empty = "<clipPath id='c'/>";
    assert_ink(&clipped(empty), 0, 0.0);
    let moved = "<clipPath id='c'><rect width='10' height='100'/></clipPath>\
        <g transform='translate(20 0)' style='clip-path:url(#c)'><path d='M-20 5h100'/></g>";
    assert_line(moved, (20.0, 5.0), (30.0, 5.0));
}

#[test]
fn clip_paths_that_cannot_be_told_are_reported() {
    for bad in [
        "<path clip-path='url(#none)' d='M0 5h9'/>",
        "<path style='clip-path:circle(5px)' d='M0 5h9'/>",
        "<clipPath id='c' clip-path='url(#c)'><rect width='50' height='50'/></clipPath>\
         <path clip-path='url(#c)' d='M0 5h9'/>",
    ] {
        let file = shown(bad);
        assert!((length(&file) - 9.0).abs() < 1e-9 && file.warnings.len() == 1, "{bad}");
    }
}

#[test]
fn pictures_within_pictures_end_at_their_border() {
    assert_ink("<svg x='10' y='10' width='20' height='20'><path d='M-5 5h100'/></svg>", 1, 20.0);
    assert_ink("<svg width='20' height='20' overflow='visible'><path d='M0 5h70'/></svg>", 1, 70.0);
}

#[test]
fn dash_arrays_become_dashes() {
    assert_ink("<path stroke-dasharray='5 5' d='M10 10h100'/>", 10, 50.0);
    assert_ink("<path stroke-dasharray='10' d='M10 10h30'/>", 2, 20.0);
    // 7 of the first dash, gap 5, dash 2, gap 5, dash 10 …: 7 + 2 + 10 + 2 + 10 + 2 + 10 + 2 + 10 in 100 mm.
    assert_ink(
        "<path style='stroke-dasharray:10,5,2,5;stroke-dashoffset:3' d='M0 20h100'/>",
        9,
        55.0,
    );
    assert_ink("<g stroke-dasharray='1 1' transform='scale(2)'><path d='M0 1h10'/></g>", 5, 10.0);
    assert_ink("<path stroke-dasharray='none' d='M0 1h10'/>", 1, 10.0);
    assert_ink("<path stroke-dasharray='0 0' d='M0 1h10'/>", 1, 10.0);
    assert_ink("<path stroke-dasharray='-1 1' d='M0 1h10'/>", 1, 10.0);
    // Dots, as with round caps.
    assert_ink("<path stroke-dasharray='0 4' d='M0 1h10'/>", 3, 0.0);
    // Ten dashes on whatever length is there.
    assert_ink("<path pathLength='20' stroke-dasharray='1 1' d='M0 1h70'/>", 10, 35.0);
    // Around a corner of a closed line, the last dash goes on into the first.
    let file =
        shown("<rect stroke-dasharray='10 10' stroke-dashoffset='5' width='20' height='20'/>");
    let found = strokes(&file);
    assert_eq!(found.len(), 4);
    let joined = found.iter().find(|dash| dash.contains(&dvec2(0.0, 0.0))).unwrap();
    assert_eq!(joined.len(), 3, "{found:?}");
    let tiny = page("<path stroke-dasharray='1e-30 1e-30' d='M0 1h10'/>");
    assert!(matches!(read(&tiny, &SvgOptions::default()), Err(SvgError::TooMany { .. })));
}

#[test]
fn ink_that_svg_does_not_show_is_left_out() {
    for hidden in [
        "stroke='transparent'",
        "stroke='rgba(0,0,0,0)'",
        "stroke-opacity='0'",
        "opacity='0'",
        "style='opacity:0%'",
        "visibility='hidden'",
        "display='none'",
        "stroke='none'",
        "stroke-width='0'",
    ] {
        assert_ink(&format!("<path {hidden} d='M0 1h10'/>"), 0, 0.0);
        assert_ink(&format!("<g {hidden}><path d='M0 1h10'/></g>"), 0, 0.0);
    }
    assert_ink("<g opacity='0'><path opacity='1' d='M0 1h10'/></g>", 0, 0.0);
    assert_ink("<g visibility='hidden'><path visibility='visible' d='M0 1h10'/></g>", 1, 10.0);
    assert_ink("<path stroke='none' fill='red' fill-opacity='0' d='M0 1h10'/>", 0, 0.0);
    assert_ink("<path opacity='.5' d='M0 1h10'/>", 1, 10.0);
    let red = shown("<g color='red'><path stroke='currentColor' d='M0 1h10'/></g>");
    assert_eq!(red.plot.layers[0].pen.color, "#ff0000");
    assert_ink(
        "<style>path { stroke: none !important }</style><path style='stroke:red' d='M0 1h9'/>",
        0,
        0.0,
    );
}

#[test]
fn fills_hide_the_ink_below_when_asked() {
    let options = SvgOptions { occlude: true, ..SvgOptions::default() };
    let occluded = |content: &str| read(&page(content), &options).unwrap();
    // What machines do not draw hides nothing.
    let layer = |label: &str, content: &str| {
        format!("<g inkscape:groupmode='layer' inkscape:label='{label}'>{content}</g>")
    };
    let sheet = "<rect x='20' y='20' width='10' height='10' fill='white'/>";
    let ink = layer("ink", "<path d='M0 25h50'/>");
    let length_on = |label: &str| {
        let file = occluded(&(ink.clone() + &layer(label, sheet)));
        let ink = file.plot.layers.iter().find(|layer| layer.name == "ink").unwrap();
        ink.lines.length_mm()
    };
    assert!((length_on("%guide") - 50.0).abs() < 1e-6);
    assert!((length_on("guide") - 40.0).abs() < 1e-6);
    let line = "<path d='M0 50h100'/>";
    let check = |content: String, n: usize, mm: f64| {
        let file = occluded(&content);
        assert!((length(&file) - mm).abs() < 0.1, "{content}: {}", length(&file));
        assert_eq!(strokes(&file).len(), n, "{content}");
    };
    let square = |paint: &str| format!("<rect x='40' y='40' width='20' height='20' {paint}/>");
    check(format!("{line}{}", square("fill='white'")), 3, 80.0 + 80.0);
    check(format!("{}{line}", square("fill='white'")), 2, 100.0 + 80.0);
    // A mask hides and is not drawn itself.
    check(format!("{line}{}", square("fill='white' stroke='none'")), 2, 80.0);
    check(format!("{line}{}", square("fill='none'")), 2, 180.0);
    check(format!("{line}{}", square("fill='white' fill-opacity='.5'")), 2, 180.0);
    // A mask that is itself clipped hides within the clip only.
    let clip = "<clipPath id='c'><rect width='50' height='100'/></clipPath>";
    check(
        format!("{clip}{line}{}", square("fill='red' stroke='none' clip-path='url(#c)'")),
        2,
        90.0,
    );
    let ring = "<path fill='red' stroke='none' fill-rule='evenodd' d='M30 30h40v40h-40zM40 40h20v20h-20z'/>";
    check(format!("{line}{ring}"), 3, 80.0);
    // Without being asked, nothing is hidden.
    assert_ink(&format!("{line}{}", square("fill='white'")), 2, 180.0);
}

fn labels(file: &LineSvg) -> Vec<(u32, String)> {
    file.plot.layers.iter().map(|layer| (layer.number, layer.label().into_owned())).collect()
}

#[test]
fn plain_groups_are_layers_where_no_others_are() {
    let file =
        shown("<g id='Layer_1'><path d='M1 1h9'/></g><g id='Ebene_x20_2'><path d='M1 2h9'/></g>");
    assert_eq!(labels(&file), [(1, "Layer_1".into()), (2, "Ebene 2".into())]);
    let named = shown(
        "<g id='a' data-name='3 red pen'><path d='M1 1h9'/></g><g id='b'><path d='M1 2h9'/></g>",
    );
    assert_eq!(labels(&named), [(3, "3 red pen".into()), (1, "b".into())]);
    let marked = shown(
        "<g inkscape:groupmode='layer' inkscape:label='one'><path d='M1 1h9'/></g>\
         <g id='two'><path d='M1 2h9'/></g>",
    );
    assert_eq!(labels(&marked), [(1, "one".into()), (2, "2 000000".into())]);
}

#[test]
fn colors_are_pens_and_only_labels_have_numbers() {
    let file = shown(
        "<path stroke='#808080' d='M0 1h9'/><path d='M0 2h9'/><path stroke='#1abc9c' d='M0 3h9'/>",
    );
    let numbers: Vec<u32> = file.plot.layers.iter().map(|layer| layer.number).collect();
    assert_eq!(numbers, [1, 2, 3]);
}

#[test]
fn control_characters_of_labels_are_kept_and_heeded() {
    let layer = |label: &str, y: u32| {
        format!("<g inkscape:groupmode='layer' inkscape:label='{label}'><path d='M1 {y}h9'/></g>")
    };
    // Layers within layers belong to these, but for those that machines do not draw.
    let inner = |label: &str| {
        format!("<g inkscape:groupmode='layer' inkscape:label='{label}'><path d='M0 9h9'/></g>")
    };
    let nested = |label: &str| {
        let outer = "<g inkscape:groupmode='layer' inkscape:label='1 ink'><path d='M0 0h9'/>";
        let file = shown(&format!("{outer}{}</g>", inner(label)));
        file.plot.plotted_layers().map(|layer| layer.lines.length_mm()).sum::<f64>()
    };
    assert_eq!([nested("part").round(), nested("%part").round()], [18.0, 9.0]);
    let all = [("10 blue", 1), ("2 red", 2), ("%guide", 3), ("!3 pause", 4), ("+S30 slow", 5)];
    let file = shown(&all.map(|(label, y)| layer(label, y)).concat());
    let found: Vec<(u32, String, String)> = file
        .plot
        .layers
        .iter()
        .map(|layer| (layer.number, layer.label().into_owned(), layer.name.clone()))
        .collect();
    let wanted = [
        (2, "2 red", "red"),
        (3, "!3 pause", "pause"),
        (10, "10 blue", "blue"),
        (1, "%guide", "guide"),
        (4, "+S30 slow", "slow"),
    ];
    let wanted = wanted.map(|(n, label, name)| (n, label.to_owned(), name.to_owned()));
    assert_eq!(found, wanted);
    let plotted: Vec<bool> = file.plot.layers.iter().map(|layer| layer.is_plotted()).collect();
    assert_eq!(plotted, [true, true, true, false, true]);
    assert!(file.plot.layers[1].pauses() && !file.plot.layers[0].pauses());
}

#[test]
fn what_groups_say_of_display_and_opacity_holds_whatever_their_parts_say() {
    assert_ink("<g display='none'><path display='inline' d='M0 10h30'/></g>", 0, 0.0);
    let options = SvgOptions { occlude: true, ..SvgOptions::default() };
    let ink = |opacity: f64| {
        let text = format!(
            "<path d='M0 50h100'/><g opacity='{opacity}'>\
             <rect x='40' y='40' width='20' height='20' fill='white' opacity='1'/></g>"
        );
        length(&read(&page(&text), &options).unwrap())
    };
    assert!((ink(1.0) - 160.0).abs() < 0.1 && (ink(0.5) - 180.0).abs() < 0.1);
}

#[test]
fn ink_on_the_border_of_a_fill_is_not_hidden() {
    let options = SvgOptions { occlude: true, ..SvgOptions::default() };
    let square = "<rect x='40' y='40' width='20' height='20' fill='white' stroke='none'/>";
    let ink = |y: f64| {
        let text = format!("<path d='M40 {y}h20'/>{square}");
        length(&read(&page(&text), &options).unwrap())
    };
    assert!((ink(40.0) - ink(41.0) - 20.0).abs() < 0.1, "{} and {}", ink(40.0), ink(41.0));
}

#[test]
fn skewing_by_css_turns_the_axis_that_it_names() {
    assert_line(
        "<path style='transform: skew(45deg, 0deg)' d='M0 10h10'/>",
        (10.0, 10.0),
        (20.0, 10.0),
    );
    assert_line(
        "<path style='transform: skew(0deg, 45deg)' d='M0 10h10'/>",
        (0.0, 10.0),
        (10.0, 20.0),
    );
}

#[test]
fn a_stated_length_of_a_path_stretches_dashes_and_their_offset() {
    // Twenty pixels stand for a hundred.
    let file = shown(
        "<path pathLength='100' stroke-dasharray='20 30' stroke-dashoffset='-10' d='M0 5h20'/>",
    );
    let found: Vec<[f64; 2]> =
        strokes(&file).iter().map(|dash| [dash[0].x, dash[dash.len() - 1].x]).collect();
    let expected = [[2.0, 6.0], [12.0, 16.0]];
    assert_eq!(found.len(), 2, "{found:?}");
    for (dash, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
        assert!((dash - expected).abs() < 1e-9, "{found:?}");
    }
}

#[test]
fn dashes_that_keep_their_size_keep_their_offset() {
    let file = shown(
        "<g transform='scale(2)'><path vector-effect='non-scaling-stroke' stroke-dasharray='10 10' \
         stroke-dashoffset='10' d='M0 5h20'/></g>",
    );
    let found: Vec<[f64; 2]> =
        strokes(&file).iter().map(|dash| [dash[0].x, dash[dash.len() - 1].x]).collect();
    // A pixel is 25.4 mm / 96.
    for (dash, expected) in found[0].iter().zip([10.0, 20.0]) {
        assert!((dash - expected * 25.4 / 96.0).abs() < 1e-9, "{found:?}");
    }
}

#[test]
fn values_that_cannot_be_read_are_left_out_with_a_word() {
    let svg = |body: &str| {
        format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' height='100mm' \
             viewBox='0 0 100 100' stroke='black'>\n{body}\n<path d='M5 5h10'/></svg>"
        )
    };
    for (body, n_lines, value) in [
        ("<line x1='foo' y1='1' x2='9' y2='1'/>", 2, "x1=\"foo\""),
        ("<g transform='rotate(1,2'><path d='M5 8h10'/></g>", 2, "transform="),
        ("<circle cx='calc(5px + 1px)' cy='50' r='3'/>", 2, "cx="),
        ("<rect x='1' y='1' width='x' height='5'/>", 1, "width=\"x\""),
        ("<svg viewBox='a b c d'><path d='M5 8h10'/></svg>", 2, "viewBox="),
    ] {
        let file = read_bytes(svg(body).as_bytes(), &SvgOptions::default()).unwrap();
        let n: usize = file.plot.layers.iter().map(|layer| layer.lines.len()).sum();
        assert_eq!(n, n_lines, "{body}");
        let warning = file.warnings.iter().find(|warning| warning.contains(value));
        assert!(warning.is_some_and(|text| text.starts_with("line 2: ")), "{:?}", file.warnings);
    }
    let page =
        "<svg xmlns='http://www.w3.org/2000/svg' width='x' height='100' viewBox='0 0 50 50'/>";
    let file = read_bytes(page.as_bytes(), &SvgOptions::default()).unwrap();
    assert!((file.plot.width_mm - 50.0 * 25.4 / 96.0).abs() < 1e-9, "{}", file.plot.width_mm);
}

#[test]
fn a_radius_that_is_missing_or_auto_is_the_other_one() {
    for radii in ["rx='7'", "ry='7'", "rx='7' ry='auto'", "ry='7' rx='auto'"] {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='96' height='96' stroke='black'>\
             <ellipse cx='50' cy='50' {radii}/></svg>"
        );
        let file = read_bytes(svg.as_bytes(), &SvgOptions::default()).unwrap();
        let length: f64 = file.plot.layers.iter().map(|layer| layer.lines.length_mm()).sum();
        let expected = std::f64::consts::TAU * 7.0 * 25.4 / 96.0;
        assert!((length - expected).abs() < 0.05 && file.warnings.is_empty(), "{radii}: {length}");
    }
}

#[test]
fn the_current_color_is_that_of_the_element_itself() {
    for style in [
        "style='color:red' stroke='currentColor'",
        "stroke='currentColor' color='red'",
        "style='stroke:currentColor;color:red'",
    ] {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='96' height='96' color='blue'>\
             <path d='M5 5h10' {style}/></svg>"
        );
        let file = read_bytes(svg.as_bytes(), &SvgOptions::default()).unwrap();
        assert_eq!(file.plot.layers[0].pen.color, "#ff0000", "{style}");
    }
}
