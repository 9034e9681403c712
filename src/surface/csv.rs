//! Grids of heights as text: comma, semicolon, tab or blanks between the cells.

use thiserror::Error;

use super::grid::{Grid, GridError, evenly};

/// Why a text is no grid. Lines count from 1.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CsvError {
    /// No line with numbers.
    #[error("no heights in the file")]
    Empty,
    /// A row that is longer or shorter than the first.
    #[error("line {line}: {found} cells, but the first row has {expected}")]
    Ragged {
        /// In the file.
        line: usize,
        /// Cells on this line.
        found: usize,
        /// Cells on the first.
        expected: usize,
    },
    /// A cell that is no number.
    #[error("line {line}, cell {cell}: `{text}` is not a number")]
    NotANumber {
        /// In the file.
        line: usize,
        /// In the row, counted from 1.
        cell: usize,
        /// As written, shortened.
        text: String,
    },
    /// Numbers that make no grid.
    #[error(transparent)]
    Grid(#[from] GridError),
}

/// Where the samples of a grid file stand.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Placement {
    /// From the first column to the last; 0 to n − 1 when absent.
    pub x: Option<(f64, f64)>,
    /// From the first row to the last, after any flip; 0 to n − 1 when absent.
    pub y: Option<(f64, f64)>,
    /// Whether the first row of the file is the one with the largest y.
    pub flip_y: bool,
}

/// Reads rows of heights. Blank cells and `nan` are holes; lines that begin with `#` are passed
/// over. When the top left cell is empty (or `x`, `y` …), the first row and column are the
/// coordinates. O(bytes).
///
/// # Errors
/// The first line that does not fit, or numbers that make no grid.
pub fn read_csv(text: &str, placement: Placement) -> Result<Grid, CsvError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let lines = || {
        let numbered = text.lines().enumerate().map(|(k, line)| (k + 1, line));
        numbered.filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'))
    };
    let Some((_, first)) = lines().next() else {
        return Err(CsvError::Empty);
    };
    let separator = [';', '\t', ','].into_iter().find(|&c| first.contains(c));
    let has_coordinates =
        separator.is_some_and(|c| first.split(c).next().is_some_and(|cell| cell.trim().is_empty()));
    // One separator at the end of every row is a habit of some writers, not a hole.
    let first_width = cells(first, separator).count();
    let trailing = separator
        .is_some_and(|c| lines().all(|(_, line)| line.trim_end_matches([' ', '\r']).ends_with(c)))
        && first_width > 1;
    let width = first_width - usize::from(trailing);

    let mut values = Vec::new();
    for (line, row) in lines() {
        let before = values.len();
        for (cell, text) in cells(row, separator).enumerate() {
            values.push(number(text).ok_or_else(|| CsvError::NotANumber {
                line,
                cell: cell + 1,
                text: text.chars().take(40).collect(),
            })?);
        }
        if trailing {
            values.pop();
        }
        let found = values.len() - before;
        if found != width {
            return Err(CsvError::Ragged { line, found, expected: width });
        }
    }
    let height = values.len() / width.max(1);
    let (mut xs, mut ys) = (None, None);
    if has_coordinates {
        xs = Some(values[1..width].to_vec());
        ys = Some(values.chunks(width).skip(1).map(|row| row[0]).collect::<Vec<f64>>());
        let heights = values.chunks(width).skip(1).flat_map(|row| &row[1..]).copied();
        values = heights.collect();
    }
    let (nx, ny) = if has_coordinates { (width - 1, height - 1) } else { (width, height) };
    if placement.flip_y && nx > 0 {
        let rows: Vec<&[f64]> = values.chunks(nx).rev().collect();
        values = rows.concat();
        ys = ys.map(|ys| ys.into_iter().rev().collect());
    }
    let place =
        |axis: char, range: Option<(f64, f64)>, given: Option<Vec<f64>>, n: usize| match range {
            Some((from, to)) if from.partial_cmp(&to) != Some(std::cmp::Ordering::Less) => {
                Err(GridError::Range { axis, from, to })
            }
            Some((from, to)) => Ok(evenly(from, to, n)),
            None => Ok(given.unwrap_or_else(|| evenly(0.0, n.saturating_sub(1) as f64, n))),
        };
    Ok(Grid::new(place('x', placement.x, xs, nx)?, place('y', placement.y, ys, ny)?, values)?)
}

fn cells(line: &str, separator: Option<char>) -> impl Iterator<Item = &str> {
    let by_blanks = separator.is_none().then(|| line.split_whitespace());
    let by_separator = separator.map(|c| line.split(c).map(str::trim));
    by_blanks.into_iter().flatten().chain(by_separator.into_iter().flatten())
}

fn number(cell: &str) -> Option<f64> {
    if cell.is_empty() || cell.eq_ignore_ascii_case("na") {
        return Some(f64::NAN);
    }
    let cell = cell.trim_matches('"').trim();
    let cell = cell.strip_prefix('+').unwrap_or(cell);
    fast_float2::parse(cell).ok()
}
