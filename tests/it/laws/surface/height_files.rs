//! Height files of all kinds: the numbers that are read are those that were written.

use hiddenline::stages::surface::{Grid, HeightNote, HeightOptions, read_heights};

const PLAIN: HeightOptions = HeightOptions { x: None, y: None, flip_y: false, nodata: None };

/// A hole.
const N: f64 = f64::NAN;

fn grid(bytes: impl AsRef<[u8]>, options: HeightOptions) -> Grid {
    read_heights(bytes.as_ref(), &options).expect("a grid").grid
}

fn notes(bytes: impl AsRef<[u8]>) -> Vec<HeightNote> {
    read_heights(bytes.as_ref(), &PLAIN).expect("a grid").notes
}

fn error(bytes: impl AsRef<[u8]>) -> String {
    read_heights(bytes.as_ref(), &PLAIN).expect_err("an error").to_string()
}

#[track_caller]
fn assert_heights(grid: &Grid, expected: &[f64]) {
    let equal = |(a, b): (&f64, &f64)| a == b || a.is_nan() && b.is_nan();
    let found = grid.zs();
    assert!(
        found.len() == expected.len() && found.iter().zip(expected).all(equal),
        "{found:?}, not {expected:?}"
    );
}

const ROWS: [f64; 6] = [1.5, 2.0, -3.0, 4.0, 5.0, 0.25];

#[test]
fn rows_of_numbers_are_read_in_every_spelling() {
    for text in [
        "1.5 2 -3\n4 5 0.25\n",
        "  1.5\t\t2  -3 \r\n4 5 2.5e-1",
        "1.5,2,-3\n4,5,.25\n",
        "1.5, 2, -3,\n4, 5, 0.25,\n",
        "1,5;2;-3\n4;5;0,25\n",
        "1,5\t2\t-3\n4\t+5\t0,25\n",
        "1,5 2,0 -3,0\n4,0 5,0 0,25\n",
        "\"1,5\",\"2\",\"-3\"\n\"4\",\"5\",\"0,25\"\n",
        "# made by hand\n1.5 2 -3 # first\n\n% and\n4 5 0.25\n#end",
        "a;b;c\n1,5;2;-3\n4;5;0,25\n",
        "Heights in m, by hand\nwest middle east\n1.5 2 -3\n4 5 0.25\n",
        "\u{feff}1.5 2 -3\n4 5 0.25\n",
    ] {
        assert_heights(&grid(text, PLAIN), &ROWS);
    }
    let utf16: Vec<u8> =
        "\u{feff}1,5;2;-3\r\n4;5;0,25\r\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_heights(&grid(&utf16, PLAIN), &ROWS);
    let latin1 = b"# H\xf6hen\n1.5 2 -3\n4 5 0.25\n";
    assert_heights(&grid(latin1, PLAIN), &ROWS);
}

#[test]
fn words_for_no_value_are_holes() {
    for text in [
        "1,nan,3\n,5,6\n",
        "1,NA,3\nN/A,5,6\n",
        "1,null,3\n-,5,6\n",
        "1 -- 3\nNone 5 6\n",
        "1\t#N/A\t3\n#N/A\t5\t6\n",
        "1;;3\n?;5;6\n",
        "1 -nan 3\ninf 5 6\n",
        "1 NODATA 3\nnil 5 6\n",
        "ncols 3\nnrows 2\ncellsize 1\nnull 5 6\n1 - 3\n",
    ] {
        let found = grid(text, PLAIN);
        assert_heights(&found, &[1.0, N, 3.0, N, 5.0, 6.0]);
    }
    // The first cell of all may be one, too.
    assert_heights(&grid("nan 2\n3 4\n", PLAIN), &[N, 2.0, 3.0, 4.0]);
    assert_heights(&grid("null,2\n3,4\n", PLAIN), &[N, 2.0, 3.0, 4.0]);
    let options = HeightOptions { nodata: Some(-1.5), ..PLAIN };
    assert_heights(&grid("-1,5;2\n3;-1,50\n", options), &[N, 2.0, 3.0, N]);
}

#[test]
fn the_first_row_and_column_may_be_coordinates() {
    let expected = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    for text in [
        ";0,5;1;4\n7;1;2;3\n8;4;5;6\n",
        "y/x,0.5,1,4\n7,1,2,3\n8,4,5,6\n",
        "some title\ny\\x 0.5 1 4\n7 1 2 3\n8 4 5 6\n",
        // Falling coordinates are put in order, with their heights.
        ",4,1,0.5\n8,6,5,4\n7,3,2,1\n",
    ] {
        let found = grid(text, PLAIN);
        assert_eq!((found.xs(), found.ys()), (&[0.5, 1.0, 4.0][..], &[7.0, 8.0][..]), "{text}");
        assert_heights(&found, &expected);
        let flipped = grid(text, HeightOptions { flip_y: true, ..PLAIN });
        assert_eq!(flipped, found, "{text}");
        let placed = grid(text, HeightOptions { x: Some((0.0, 1.0)), ..PLAIN });
        assert_eq!((placed.xs(), placed.ys()), (&[0.0, 0.5, 1.0][..], &[7.0, 8.0][..]));
        assert_heights(&placed, &expected);
    }
    assert!(error(",1,1\n0,1,2\n1,3,4\n").contains("the x values must increase"));
    assert!(error(",1,\n0,1,2\n1,3,4\n").contains("the x values must increase"));
}

#[test]
fn titles_and_lists_of_points_are_noticed() {
    let list = |points: &[[f64; 3]]| -> String {
        points.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect()
    };
    let lattice: Vec<[f64; 3]> =
        (0..6).map(|k| [f64::from(k % 3), f64::from(k / 3), f64::from(k * k)]).collect();
    let scattered: Vec<[f64; 3]> =
        (0..20).map(|k| [f64::from(k * 7 % 20), f64::from(k * 3 % 11), f64::from(k)]).collect();
    let looks = |rows| HeightNote::LooksLikePoints { rows };
    assert_eq!(notes(list(&lattice)), [looks(6)]);
    assert_eq!(notes(list(&scattered)), [looks(20)]);
    assert_eq!(
        notes(format!("x,y,z\n{}", list(&lattice[..3]).replace(' ', ","))),
        [HeightNote::TitlesSkipped(1), looks(3)]
    );
    assert_eq!(notes("1 2 3\n4 5 6\n7 8 9\n"), []);
    assert_eq!(notes("a b\nc d\n1 2\n3 4\n"), [HeightNote::TitlesSkipped(2)]);
    assert_eq!(notes("# a b\n1 2\n3 4\n"), []);
}

#[test]
fn wrong_rows_are_named_by_line_and_cell() {
    for (text, message) in [
        ("1 2\n3 x\n", "line 2, cell 2: `x` is not a number"),
        ("# a\n1,2\n\n3,4,5\n", "line 4: 3 cells, but the first row has 2"),
        ("1;2,5\n3.5;4\n", "line 2, cell 1: `3.5` mixes decimal points and decimal commas"),
        ("1.5;2\n3,5;4\n", "line 2, cell 1: `3,5` mixes decimal points and decimal commas"),
        ("1;1.234,5\n2;3\n", "line 1, cell 2: `1.234,5` is not a number"),
        ("1;1,234,5\n2;3\n", "line 1, cell 2: `1,234,5` is not a number"),
        ("1 2 three\n", "line 1, cell 3: `three` is not a number"),
        ("<html>\n<body>\n", "line 1, cell 1: `<html>` is not a number"),
        ("# only\n", "no heights in the file"),
    ] {
        let found = error(text);
        assert!(found.starts_with(message), "{text:?}: {found}");
    }
    assert!(error(b"1 2\0").starts_with("not rows of numbers"));
    assert!(error(b"\xff\xfe1\x002\x00\x00").starts_with("not rows of numbers"));
}

#[test]
fn an_esri_grid_is_read_whatever_the_order_of_its_keys() {
    let body = "4 5 6\n1 -9999 3\n";
    for header in [
        "ncols 3\nnrows 2\nxllcorner 9\nyllcorner 19\ncellsize 2\nNODATA_value -9999\n",
        "NROWS 2\nNCOLS 3\nXLLCENTER 10\nYLLCENTER 20\nCELLSIZE 2\n",
        "# by hand\n\nnrows 2\nncols 3\nyllcorner 19 xllcorner 9 dx 2 dy 2\n",
        "ncols 3\r\nnrows 2\r\nxllcorner 9,0\r\nyllcorner 19,0\r\ncellsize 2,0\r\n",
    ] {
        let found = grid(format!("{header}{body}"), PLAIN);
        assert_eq!((found.xs(), found.ys()), (&[10.0, 12.0, 14.0][..], &[20.0, 22.0][..]));
        assert_heights(&found, &[1.0, N, 3.0, 4.0, 5.0, 6.0]);
    }
    let header = "ncols 2\nnrows 2\ncellsize 1\ndy 3\n";
    let found = grid(format!("{header}NODATA_value nan\nnan 1 -9999\n2\n"), PLAIN);
    assert_eq!((found.xs(), found.ys()), (&[0.0, 1.0][..], &[0.0, 3.0][..]));
    // A NODATA value in the header replaces the usual one; one asked for comes on top.
    assert_heights(&found, &[-9999.0, 2.0, N, 1.0]);
    let options = HeightOptions { nodata: Some(2.0), ..PLAIN };
    let found = grid(format!("{header}NODATA_value 1\n0 1 2 3\n"), options);
    assert_heights(&found, &[N, 3.0, 0.0, N]);
    for (text, message) in [
        ("ncols 2\nnrows 1\ncellsize 1\ncolour 3\n1 2\n", "line 4: `colour` is neither a number"),
        ("ncols 2\nncols 2\n", "line 2: `ncols` is given twice"),
        ("ncols 2\nnrows x\n", "line 2: `x` is not a number"),
        ("ncols 2\nnrows\n", "line 2: `nrows` has no value"),
        ("ncols 2\nnrows 1.5\ncellsize 1\n", "`nrows` is 1.5"),
        ("ncols 2\nnrows 1\n1 2\n", "`cellsize` is missing or not above 0"),
        ("ncols 2\nnrows 2\ncellsize 1\n1 2\n3 x\n", "line 5: `x` is not a number"),
        ("ncols 2\nnrows 2\ncellsize 1\n1 2\n3\n", "3 heights for 2 × 2 cells"),
        ("ncols 1e9\nnrows 1e9\ncellsize 1\n", "`ncols` is 1000000000"),
    ] {
        let found = error(text);
        assert!(found.starts_with(&format!("ESRI ASCII grid: {message}")), "{text:?}: {found}");
    }
}

/// An NPY file with this header and these bytes.
fn npy(kind: &str, fortran: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '{kind}', 'fortran_order': {fortran}, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(data);
    bytes
}

/// The bytes of numbers, those of each number in either order.
fn bytes_of<const SIZE: usize>(numbers: &[[u8; SIZE]], big_endian: bool) -> Vec<u8> {
    let ordered = |mut number: [u8; SIZE]| {
        if big_endian {
            number.reverse();
        }
        number
    };
    numbers.iter().flat_map(|number| ordered(*number)).collect()
}

#[test]
fn npy_arrays_are_read_in_both_byte_orders_and_both_orders_of_axes() {
    let by_rows = [1, 2, 3, 4, 5, 6_i8];
    let by_columns = [1, 4, 2, 5, 3, 6_i8];
    let expected = by_rows.map(f64::from);
    for (fortran, order) in [("False", by_rows), ("True", by_columns)] {
        for (sign, big) in [("<", false), (">", true)] {
            let check = |kind: &str, data: Vec<u8>| {
                let file = npy(&format!("{sign}{kind}"), fortran, "(2, 3)", &data);
                let found = grid(&file, PLAIN);
                assert_eq!((found.xs(), found.ys()), (&[0.0, 1.0, 2.0][..], &[0.0, 1.0][..]));
                assert_heights(&found, &expected);
                let flipped = grid(&file, HeightOptions { flip_y: true, ..PLAIN });
                assert_heights(&flipped, &[4.0, 5.0, 6.0, 1.0, 2.0, 3.0]);
                assert_eq!(error(&file[..file.len() - 1]), "NPY: the file ends early");
            };
            check("f8", bytes_of(&order.map(|n| f64::from(n).to_le_bytes()), big));
            check("f4", bytes_of(&order.map(|n| f32::from(n).to_le_bytes()), big));
            check("i1", bytes_of(&order.map(|n| n.to_le_bytes()), big));
            check("u1", bytes_of(&order.map(|n| (n as u8).to_le_bytes()), big));
            check("i2", bytes_of(&order.map(|n| i16::from(n).to_le_bytes()), big));
            check("u2", bytes_of(&order.map(|n| (n as u16).to_le_bytes()), big));
            check("i4", bytes_of(&order.map(|n| i32::from(n).to_le_bytes()), big));
            check("u4", bytes_of(&order.map(|n| (n as u32).to_le_bytes()), big));
            check("i8", bytes_of(&order.map(|n| i64::from(n).to_le_bytes()), big));
            check("u8", bytes_of(&order.map(|n| (n as u64).to_le_bytes()), big));
        }
    }
    let negative = bytes_of(&[-1, -2, -3, i16::MIN].map(i16::to_le_bytes), false);
    let found = grid(npy("<i2", "False", "(2, 2)", &negative), PLAIN);
    assert_heights(&found, &[-1.0, -2.0, -3.0, -32768.0]);
}

#[test]
fn files_of_numpy_itself_are_read() {
    let fortran = include_bytes!("numpy/fortran-big-endian.npy");
    assert_heights(&grid(fortran, PLAIN), &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    let int16 = include_bytes!("numpy/three-axes-int16.npy");
    let options = HeightOptions { nodata: Some(-9999.0), ..PLAIN };
    assert_heights(&grid(int16, options), &[1.0, 2.0, 3.0, 4.0, 5.0, N]);
    let lists = include_bytes!("numpy/xyz.npz");
    let found = read_heights(lists, &PLAIN).expect("a grid");
    let axes = (found.grid.xs(), found.grid.ys());
    // The rows are written from the largest y down.
    assert_eq!(axes, (&[10.0, 12.0, 16.0][..], &[3.0, 5.0][..]));
    assert_heights(&found.grid, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    let skipped = |used: &str, other: &str| HeightNote::ArraysSkipped {
        used: used.into(),
        others: vec![other.into()],
    };
    assert_eq!(found.notes, [skipped("z", "note")]);
    let mesh = include_bytes!("numpy/meshgrid.npz");
    let found = read_heights(mesh, &PLAIN).expect("a grid");
    assert_eq!((found.grid.xs(), found.grid.ys()), (&[0.0, 1.0, 4.0][..], &[2.0, 3.0][..]));
    assert_heights(&found.grid, &[1.0, N, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(found.notes, [skipped("elevation", "slope")]);
}

/// An NPZ file with these arrays.
pub(super) fn npz(arrays: &[(&str, &str, &[f64])]) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, shape, numbers) in arrays {
        let options = zip::write::SimpleFileOptions::default();
        archive.start_file(format!("{name}.npy"), options).expect("a file");
        let data: Vec<u8> = numbers.iter().flat_map(|z| z.to_le_bytes()).collect();
        let array = npy("<f8", "False", shape, &data);
        std::io::Write::write_all(&mut archive, &array).expect("written");
    }
    archive.finish().expect("an archive").into_inner()
}

#[test]
fn npz_archives_tell_heights_from_coordinates_or_say_why_not() {
    let four = &[1.0, 2.0, 3.0, 4.0][..];
    let square = ("arr_0", "(2, 2)", four);
    assert_heights(&grid(npz(&[square]), PLAIN), four);
    assert_heights(&grid(npz(&[("any", "(2, 2)", four), ("t", "(4,)", four)]), PLAIN), four);
    for (arrays, message) in [
        (&[("t", "(4,)", four)][..], "NPZ: no array of numbers has two axes"),
        (
            &[("a", "(2, 2)", four), ("b", "(2, 2)", four)],
            "NPZ: `a`, `b` have two axes; name the one with the heights `z`",
        ),
        (&[square, ("x", "(4,)", four)], "NPZ: array `x`: 4 numbers for 2 samples along x"),
        (
            &[square, ("y", "(2, 2)", four)],
            "NPZ: array `y`: the samples do not form a rectangular grid",
        ),
        (
            &[square, ("x", "(2, 1)", &four[..2])],
            "NPZ: array `x`: it must be as large as the array of heights",
        ),
        (&[("z", "(2, x)", four)], "NPZ: array `z`: NPY: the shape cannot be read"),
    ] {
        assert_eq!(error(npz(arrays)), message);
    }
    let whole = npz(&[square]);
    assert!(error(&whole[..whole.len() / 2]).starts_with("NPZ: "));
}

#[test]
fn npz_archives_of_many_small_files_cannot_fill_the_memory() {
    let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    archive.start_file("0.npy", zip::write::SimpleFileOptions::default()).expect("a file");
    std::io::Write::write_all(&mut archive, &vec![0; 30 << 20]).expect("written");
    // None of them is an array, which alone is no reason to stop.
    for k in 1..40 {
        archive.deep_copy_file("0.npy", &format!("{k}.npy")).expect("a copy");
    }
    let bytes = archive.finish().expect("an archive").into_inner();
    assert!(bytes.len() < 4 << 20, "{}", bytes.len());
    assert!(error(bytes).ends_with("bytes when unpacked"));
}

/// An uncompressed gray TIFF in little-endian order: bits and sample format (1 unsigned, 2 signed,
/// 3 float) of its numbers, and the text of GDAL's tag.
pub(super) fn tiff(
    size: [u32; 2],
    bits: u32,
    format: u32,
    data: &[u8],
    nodata: Option<&str>,
) -> Vec<u8> {
    let nodata = nodata.map(|text| format!("{text}\0"));
    let n_tags = 9 + u32::from(nodata.is_some());
    let after = 8 + 2 + 12 * n_tags + 4;
    let text = nodata.clone().unwrap_or_default();
    let mut file = b"II*\0\x08\0\0\0".to_vec();
    file.extend((n_tags as u16).to_le_bytes());
    let mut tag = |number: u16, kind: u16, count: u32, value: u32| {
        file.extend(number.to_le_bytes());
        file.extend(kind.to_le_bytes());
        file.extend(count.to_le_bytes());
        file.extend(value.to_le_bytes());
    };
    let first = after + text.len() as u32;
    for (number, value) in [(256, size[0]), (257, size[1]), (258, bits), (259, 1), (262, 1)] {
        tag(number, 4, 1, value);
    }
    tag(273, 4, 1, first);
    tag(278, 4, 1, size[1]);
    tag(279, 4, 1, data.len() as u32);
    tag(339, 3, 1, format);
    if nodata.is_some() {
        assert!(text.len() > 4, "shorter texts stand in the tag itself");
        tag(42113, 2, text.len() as u32, after);
    }
    file.extend([0; 4]);
    file.extend(text.as_bytes());
    file.extend(data);
    file
}

#[test]
fn the_nodata_tag_of_a_geotiff_makes_holes() {
    let floats = |numbers: [f32; 6]| bytes_of(&numbers.map(f32::to_le_bytes), false);
    // The first row of a picture is the topmost.
    let expected = [4.0, 5.0, 6.0, 1.0, N, 3.0];
    let data = floats([1.0, -9999.0, 3.0, 4.0, 5.0, 6.0]);
    assert_heights(&grid(tiff([3, 2], 32, 3, &data, Some("-9999")), PLAIN), &expected);
    assert_heights(&grid(tiff([3, 2], 32, 3, &data, Some(" -9999 ")), PLAIN), &expected);
    let asked = HeightOptions { nodata: Some(-9999.0), ..PLAIN };
    assert_heights(&grid(tiff([3, 2], 32, 3, &data, None), asked), &expected);
    let deep = [4.0, 5.0, 6.0, 1.0, -9999.0, 3.0];
    assert_heights(&grid(tiff([3, 2], 32, 3, &data, None), PLAIN), &deep);
    // Neither is a number of single precision.
    for text in ["-99999.9", "-3.4028234663852886e+38", "-3.40282346638529e+38"] {
        let number: f32 = text.parse().expect("a number");
        let data = floats([1.0, number, 3.0, 4.0, 5.0, 6.0]);
        assert_heights(&grid(tiff([3, 2], 32, 3, &data, Some(text)), PLAIN), &expected);
    }
    let data = floats([1.0, f32::NAN, 3.0, 4.0, 5.0, 6.0]);
    assert_heights(&grid(tiff([3, 2], 32, 3, &data, Some("nan\0")), PLAIN), &expected);
    let shorts = bytes_of(&[1, -32768, 3, 4, 5, 6_i16].map(i16::to_le_bytes), false);
    assert_heights(&grid(tiff([3, 2], 16, 2, &shorts, Some("-32768")), PLAIN), &expected);
    // Unsigned numbers are shades; the value is that in the file.
    let shades = bytes_of(&[0, 65535, 65535, 0, 0, 65535_u16].map(u16::to_le_bytes), false);
    let asked = HeightOptions { nodata: Some(65535.0), ..PLAIN };
    assert_heights(&grid(tiff([3, 2], 16, 1, &shades, None), asked), &[0.0, 0.0, N, 0.0, N, N]);
    let flipped = HeightOptions { flip_y: true, ..PLAIN };
    assert_heights(
        &grid(tiff([3, 2], 16, 1, &shades, None), flipped),
        &[0.0, 1.0, 1.0, 0.0, 0.0, 1.0],
    );
}

#[test]
fn a_nodata_shade_of_a_png_makes_holes() {
    let picture = |depth, data: &[u8]| {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 2, 2);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(depth);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(data).expect("pixels");
        writer.finish().expect("an end");
        bytes
    };
    let asked = HeightOptions { nodata: Some(255.0), ..PLAIN };
    let bytes = picture(png::BitDepth::Eight, &[0, 255, 51, 0]);
    assert_heights(&grid(&bytes, asked), &[0.2, 0.0, 0.0, N]);
    assert_heights(&grid(&bytes, PLAIN), &[0.2, 0.0, 0.0, 1.0]);
    assert_heights(&grid(&bytes, HeightOptions { flip_y: true, ..PLAIN }), &[0.0, 1.0, 0.2, 0.0]);
    let wide = picture(png::BitDepth::Sixteen, &[0, 255, 0, 0, 255, 255, 0, 0]);
    assert_heights(&grid(&wide, asked), &[1.0, 0.0, N, 0.0]);
}

#[test]
fn the_rows_of_every_text_format_can_be_flipped() {
    let flipped = HeightOptions { flip_y: true, ..PLAIN };
    assert_heights(&grid("1 2\n3 4\n", flipped), &[3.0, 4.0, 1.0, 2.0]);
    assert_heights(&grid("1 2\n3 4\n", PLAIN), &[1.0, 2.0, 3.0, 4.0]);
    // The header of an ESRI grid says where its rows are: there is nothing to flip.
    let esri = "ncols 2\nnrows 2\ncellsize 1\n1 2\n3 4\n";
    assert_heights(&grid(esri, PLAIN), &[3.0, 4.0, 1.0, 2.0]);
}
