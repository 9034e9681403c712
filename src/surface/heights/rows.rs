//! Rows of heights as text: comma, semicolon, tab or blanks between the cells.

use super::raster::{NoData, Raster};
use super::{HeightError, HeightNote};
use crate::surface::cells::{Cell, Numbers, Separator, has_thousands, lines};

/// Three columns with at least this many rows are more likely a list of points than a narrow grid.
const ROWS_OF_A_LIST: usize = 16;

/// Reads rows of heights, that of the smallest y first.
///
/// Lines of words before the first row of numbers are titles. When the first cell of the first row
/// is empty or a word and the others are numbers, the first row and the first column are the
/// coordinates. O(bytes).
pub(super) fn read(
    text: &str,
    nodata: Option<f64>,
    notes: &mut Vec<HeightNote>,
) -> Result<Raster, HeightError> {
    let rows: Vec<(usize, &str)> = lines(text).collect();
    let n_titles = rows.iter().zip(1..).take_while(|(row, next)| is_title(row.1, rows.get(*next)));
    let n_titles = n_titles.count();
    if n_titles > 0 && n_titles < rows.len() {
        notes.push(HeightNote::TitlesSkipped(n_titles));
    }
    let (titles, rows) = match rows.split_at_checked(n_titles) {
        Some((titles, rows)) if !rows.is_empty() => (titles, rows),
        // Nothing but words: the first of them is the error.
        _ => (&[][..], &rows[..]),
    };
    let Some((_, first)) = rows.first() else { return Err(HeightError::Empty) };
    let separator = Separator::of(first);
    let has_coordinates = has_coordinates(first, rows.get(1));
    // Some programs also write a separator after the last cell of every row.
    let first_width = separator.cells(first).count();
    let ends_with_separator = |row: &str| match separator {
        Separator::Blanks => false,
        Separator::Char(separator) => row.trim_end_matches([' ', '\r']).ends_with(separator),
    };
    let has_trailing = first_width > 1 && rows.iter().all(|(_, row)| ends_with_separator(row));
    let width = first_width - usize::from(has_trailing);

    let nodata = NoData::new(nodata, None);
    let mut numbers = Numbers::default();
    let (mut xs, mut ys, mut heights) = (Vec::new(), Vec::new(), Vec::new());
    for (k, &(line, row)) in rows.iter().enumerate() {
        let mut found = 0;
        for (at, text) in separator.cells(row).enumerate() {
            found += 1;
            let place = || (line, at + 1, text.chars().take(40).collect::<String>());
            let cell = numbers.read(text).map_err(|_| {
                let (line, cell, text) = place();
                HeightError::MixedDecimals { line, cell, text }
            })?;
            if has_coordinates && k == 0 && at == 0 {
                continue;
            }
            let number = match cell {
                Cell::Number(number) => number,
                Cell::Missing => f64::NAN,
                Cell::Word => {
                    let (line, cell, text) = place();
                    return Err(HeightError::NotANumber { line, cell, text });
                }
            };
            if at >= width {
                continue;
            }
            match (has_coordinates, k, at) {
                (true, 0, _) => xs.push(number),
                (true, _, 0) => ys.push(number),
                _ => heights.push(nodata.height(number)),
            }
        }
        let found = found - usize::from(has_trailing && found > 0);
        if found != width {
            return Err(HeightError::RowLength { line, found, expected: width });
        }
    }
    let coordinates = usize::from(has_coordinates);
    let (columns, rows) = (width - coordinates, rows.len() - coordinates);
    let has_points_titles =
        titles.iter().any(|(_, title)| Separator::of(title).cells(title).count() == 3);
    if columns == 3
        && !has_coordinates
        && (has_points_titles || rows >= ROWS_OF_A_LIST || is_lattice(&heights))
    {
        notes.push(HeightNote::LooksLikePoints { rows });
    }
    let mut raster = Raster::new(columns, rows, heights);
    if has_coordinates {
        (raster.xs, raster.ys) = (Some(xs), Some(ys));
    }
    Ok(raster)
}

/// Whether a line before any row of numbers holds words: it begins with one and is not the row of
/// the x coordinates.
fn is_title(row: &str, next: Option<&(usize, &str)>) -> bool {
    let mut kinds = kinds(row);
    let begins_with_number = matches!(kinds.next(), Some(Cell::Number(_)));
    !begins_with_number
        && kinds_have_word(row)
        && !has_coordinates(row, next)
        && !Separator::of(row).cells(row).all(is_number_of_sorts)
}

/// A number, or what is meant as one.
fn is_number_of_sorts(cell: &str) -> bool {
    let kind = Numbers::default().read(cell);
    has_thousands(cell) || matches!(kind, Ok(Cell::Number(_)))
}

fn kinds_have_word(row: &str) -> bool {
    kinds(row).any(|cell| cell == Cell::Word)
}

/// Whether a row holds the x coordinates: something other than a number first, then only numbers, as many
/// as in the next row.
fn has_coordinates(row: &str, next: Option<&(usize, &str)>) -> bool {
    let separator = Separator::of(row);
    let mut kinds = kinds(row);
    let first = kinds.next();
    let is_first_free = match (separator, separator.cells(row).next()) {
        (Separator::Char(_), Some("")) => true,
        (_, Some(cell)) if has_thousands(cell) => false,
        _ => first == Some(Cell::Word),
    };
    let mut n_numbers = 0;
    let all_numbers = kinds.all(|cell| {
        n_numbers += 1;
        matches!(cell, Cell::Number(x) if x.is_finite()) || cell == Cell::Missing
    });
    let has_number = self::kinds(row).skip(1).any(|cell| matches!(cell, Cell::Number(_)));
    let fits = next.is_none_or(|(_, next)| separator.cells(next).count() == n_numbers + 1);
    is_first_free && all_numbers && has_number && (fits || first != Some(Cell::Word))
}

/// The kinds of the cells of one row, whatever the decimal signs elsewhere.
fn kinds(row: &str) -> impl Iterator<Item = Cell> {
    let read = |cell| Numbers::default().read(cell).unwrap_or(Cell::Word);
    Separator::of(row).cells(row).map(read)
}

/// Whether the first two of each three numbers are the points of a lattice, each of them once.
fn is_lattice(numbers: &[f64]) -> bool {
    let column = |k: usize| {
        let mut values: Vec<f64> = numbers.iter().skip(k).step_by(3).copied().collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values.len()
    };
    let mut pairs: Vec<[u64; 2]> =
        numbers.chunks_exact(3).map(|row| [row[0].to_bits(), row[1].to_bits()]).collect();
    pairs.sort_unstable();
    pairs.dedup();
    let (n_x, n_y) = (column(0), column(1));
    n_x > 1 && n_y > 1 && pairs.len() == numbers.len() / 3 && n_x * n_y == pairs.len()
}
