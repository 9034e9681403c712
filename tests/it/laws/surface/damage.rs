//! Sound height files, points and formulas with random damage: they may be refused, but nothing
//! panics, hangs or hands over what is not a surface.
//!
//! Each run starts from the same seed. `FUZZ_SECONDS=180` goes on for so many seconds of each of the
//! three; `FUZZ_SEED` changes the seed.

use std::collections::HashSet;
use std::time::{Duration, Instant};

use hiddenline::stages::surface::formula::{Formula, Variables};
use hiddenline::stages::surface::{
    Duplicates, HeightOptions, MAX_SAMPLES, ScatteredPoints, delaunay, read_heights,
};

use super::height_files::{npz, tiff};
use super::max_min::Dice;

/// Runs of each kind without `FUZZ_SECONDS`.
const RUNS: u64 = 3000;

/// Inputs grow no longer than this.
const LONGEST: usize = 1 << 13;

/// Pieces that files and formulas are made of, put in at random places.
const PIECES: [&str; 48] = [
    "nan",
    "-1",
    "0",
    "1e999",
    "1e-400",
    "-",
    "null",
    "#N/A",
    "#",
    "%",
    "\"",
    ";",
    ",",
    "\t",
    " ",
    "\n",
    "\r\n",
    "1,5",
    "1.5",
    ",,,,",
    "x,y,z\n",
    "ncols 3\n",
    "nrows 99999999999\n",
    "cellsize 0\n",
    "NODATA_value 1\n",
    "xllcorner 1e308\n",
    "'shape': (1, 99999999999999999999)",
    "(2, 3, 1)",
    "True",
    ">f8",
    "<u8",
    "|b1",
    "99999999",
    "sin(",
    ")",
    "(((((((((",
    "--------",
    "^",
    "**",
    "?",
    ":",
    "if(",
    "atan2(",
    "x²",
    "<=",
    "and not ",
    "π",
    "e",
];

fn damage(bytes: &mut Vec<u8>, other: &[u8], dice: &mut Dice) {
    let mut below = |n: usize| dice.roll(n.max(1) as u64) as usize;
    let at = below(bytes.len() + 1);
    let length = below(32).min(bytes.len() - at);
    match below(9) {
        0 if at < bytes.len() => bytes[at] = below(256) as u8,
        1 if at < bytes.len() => bytes[at] ^= 1 << below(8),
        2 => bytes.insert(at, below(256) as u8),
        3 => drop(bytes.drain(at..at + length)),
        4 => bytes.extend_from_within(at..at + length),
        5 => bytes.truncate(at),
        6 => drop(bytes.splice(at..at, PIECES[below(PIECES.len())].bytes())),
        7 => {
            let piece = PIECES[below(PIECES.len())];
            let end = (at + piece.len()).min(bytes.len());
            bytes.splice(at..end, piece.bytes());
        }
        _ => {
            let from = below(other.len());
            let length = below(64).min(other.len() - from);
            bytes.splice(at..at, other[from..from + length].iter().copied());
        }
    }
    bytes.truncate(LONGEST);
}

/// Tries damaged inputs. What `run` answers is the kind of its outcome; inputs with a kind that was
/// not seen before are damaged further.
fn fuzz(mut corpus: Vec<Vec<u8>>, run: impl Fn(&[u8]) -> String) {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let mut dice = Dice(number("FUZZ_SEED").unwrap_or(1));
    let seconds = number("FUZZ_SECONDS").map(Duration::from_secs);
    let start = Instant::now();
    let mut seen: HashSet<String> = corpus.iter().map(|bytes| run(bytes)).collect();
    let mut n_runs = 0;
    while seconds.map_or(n_runs < RUNS, |seconds| start.elapsed() < seconds) {
        let mut bytes = corpus[dice.roll(corpus.len() as u64) as usize].clone();
        let other = corpus[dice.roll(corpus.len() as u64) as usize].clone();
        for _ in 0..=dice.roll(6) {
            damage(&mut bytes, &other, &mut dice);
        }
        let started = Instant::now();
        let outcome = run(&bytes);
        assert!(started.elapsed() < Duration::from_secs(20), "slow: {bytes:?}");
        if corpus.len() < 20_000 && seen.insert(outcome) {
            corpus.push(bytes);
        }
        n_runs += 1;
    }
    if seconds.is_some() {
        println!("{n_runs} runs, {} inputs kept, {} outcomes", corpus.len(), seen.len());
    }
}

/// A message without its numbers and quotations, in one line.
fn kind(message: &str) -> String {
    assert!(!message.contains('\n'), "{message}");
    let outside = message.split('`').step_by(2);
    outside.map(|part| part.replace(|c: char| c.is_ascii_digit(), "")).collect()
}

#[test]
fn damaged_height_files_never_panic() {
    let four = &[1.0, 2.0, 3.0, 4.0][..];
    let floats: Vec<u8> = [1.0, 2.0, 3.0, 4.0_f32].iter().flat_map(|z| z.to_le_bytes()).collect();
    let mut picture = Vec::new();
    let mut encoder = png::Encoder::new(&mut picture, 2, 2);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&[1, 2, 3, 4]).expect("pixels");
    writer.finish().expect("an end");
    let corpus: Vec<Vec<u8>> = vec![
        b"# a\n1 2 3\n4 nan 6\n7 8 9\n".to_vec(),
        b"a;b\n1,5;2,5\n-;4\n".to_vec(),
        b",1,2\n5,3,4\n3,5,6\n".to_vec(),
        b"ncols 2\nnrows 2\nxllcorner 1\nyllcenter 2\ncellsize 3\nNODATA_value -9\n1 -9\n3 4\n"
            .to_vec(),
        include_bytes!("numpy/fortran-big-endian.npy").to_vec(),
        include_bytes!("numpy/xyz.npz").to_vec(),
        include_bytes!("numpy/meshgrid.npz").to_vec(),
        npz(&[("arr_0", "(2, 2)", four), ("x", "(2,)", &four[..2])]),
        tiff([2, 2], 32, 3, &floats, Some("-9999")),
        picture,
        "\u{feff}1 2\n3 4\n".encode_utf16().flat_map(u16::to_le_bytes).collect(),
    ];
    fuzz(corpus, |bytes| {
        // One of the bytes decides about the options.
        let odd = bytes.len() % 2 == 1;
        let options = HeightOptions {
            x: odd.then_some((-1.0, 1.0)),
            flip_y: odd,
            nodata: odd.then_some(2.0),
            ..HeightOptions::default()
        };
        match read_heights(bytes, &options) {
            Ok(field) => {
                let (xs, ys, zs) = (field.grid.xs(), field.grid.ys(), field.grid.zs());
                assert!(zs.len() == xs.len() * ys.len() && zs.len() <= MAX_SAMPLES);
                for axis in [xs, ys] {
                    assert!(axis.len() >= 2 && axis.windows(2).all(|pair| pair[0] < pair[1]));
                }
                assert!(zs.iter().all(|z| z.is_nan() || z.is_finite()));
                let notes: String =
                    field.notes.iter().map(|note| kind(&note.to_string())).collect();
                format!("{} {} {notes}", xs.len().min(5), ys.len().min(5))
            }
            Err(error) => kind(&error.to_string()),
        }
    });
}

#[test]
fn damaged_points_never_panic() {
    let corpus: Vec<Vec<u8>> = vec![
        b"x y z\n0 0 1\n2 0 1\n2 2 0\n0 2 1\n1 1 3\n".to_vec(),
        b"0,5;0;1\n2;0;1,5\n2;2;0\n0;2;-\n".to_vec(),
        b"0,0,1,9\n0,0,2,9\n5,0,1\n0,5,1\n-0,0,1\n".to_vec(),
        b"1e-40 0 0\n1e55 0 1\n0 1e55 1\n1 1 1\n".to_vec(),
    ];
    fuzz(corpus, |bytes| {
        let text = String::from_utf8_lossy(bytes);
        let duplicates = [Duplicates::Error, Duplicates::First, Duplicates::Mean, Duplicates::Max];
        let duplicates = duplicates[bytes.len() % 4];
        let read = ScatteredPoints::read(&text, None).and_then(|mut read| {
            let n_merged = read.merge(duplicates)?;
            Ok((read, n_merged))
        });
        let (read, n_merged) = match read {
            Ok(read) => read,
            Err(error) => return kind(&error.to_string()),
        };
        assert_eq!(read.points.len(), read.lines.len());
        assert!(read.points.iter().all(|p| p.is_finite()));
        assert!(read.lines.windows(2).all(|pair| pair[0] < pair[1]));
        match delaunay(&read.points) {
            Ok(triangles) => {
                let n = read.points.len();
                assert!(triangles.iter().flatten().all(|&k| (k as usize) < n));
                format!("{} {} {}", n.min(9), n_merged.min(3), read.n_without_height.min(3))
            }
            Err(error) => kind(&error.to_string()),
        }
    });
}

#[test]
fn damaged_formulas_never_panic() {
    let corpus = [
        "sin(x)*exp(-y^2/2) + 3.5e-2",
        "x < y && !(y >= 2) ? atan2(y, x) : -x² % 3",
        "if(r <= 2 or theta != 1, max(x, min(y, 3)), hypot(x,y)**-1)",
        "((((((((1+2))))))))",
    ];
    let corpus = corpus.iter().map(|text| text.as_bytes().to_vec()).collect();
    fuzz(corpus, |bytes| {
        let text = String::from_utf8_lossy(bytes);
        match Formula::parse(&text, Variables::Plane) {
            Ok(formula) => {
                let values: Vec<f64> =
                    [(0.0, 0.0), (-1.5, 2.0)].map(|(x, y)| formula.value(x, y)).to_vec();
                // The same bits one at a time and many at once.
                let mut many = [0.0; 2];
                formula.values(&[0.0, -1.5], &[0.0, 2.0], &mut many);
                let bits = |values: &[f64]| values.iter().map(|z| z.to_bits()).collect::<Vec<_>>();
                assert_eq!(bits(&values), bits(&many), "{text}");
                format!("{} {:?}", text.len() / 8, many.map(f64::is_finite))
            }
            Err(error) => {
                let n_columns = text.chars().count() + 1;
                assert!((1..=n_columns).contains(&error.column), "{text}: {error}");
                kind(&error.to_string())
            }
        }
    });
}
