//! Lines, cells and numbers of text files: what grids and scattered points have in common.

/// What separates the cells of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Separator {
    /// Any run of spaces and tabs.
    Blanks,
    /// This character, with or without blanks beside it.
    Char(char),
}

/// A cell: its number, or that it has none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Cell {
    /// May be infinite or not a number, if that is what the file says.
    Number(f64),
    /// Empty, or a word for "no value".
    Missing,
    /// Any other word.
    Word,
}

/// Words that mean "no value", in lower case.
const MISSING: [&str; 13] =
    ["", "-", "--", "?", "*", "na", "n/a", "#n/a", "null", "none", "nil", "nodata", "1.#qnan"];

/// The longest number that is read, in bytes.
const LONGEST_NUMBER: usize = 400;

/// The lines that have content, each with its number counted from 1. Comments are cut off: whole
/// lines that begin with `#` or `%`, and what follows a `#` after a blank.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> + Clone {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    // Ends of lines as in Unix, Windows and the old Mac OS.
    let lines =
        text.split('\n').flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'));
    lines
        .enumerate()
        .map(|(k, line)| (k + 1, without_comment(line)))
        .filter(|(_, line)| !line.trim().is_empty())
}

fn without_comment(line: &str) -> &str {
    if line.trim_start().starts_with(['#', '%']) && !starts_with_missing(line.trim_start()) {
        return "";
    }
    let comment = line
        .match_indices('#')
        .find(|(at, _)| line[..*at].ends_with([' ', '\t']) && !starts_with_missing(&line[*at..]));
    comment.map_or(line, |(at, _)| &line[..at])
}

/// `#N/A`, which spreadsheets write, begins no comment.
fn starts_with_missing(text: &str) -> bool {
    text.get(..4).is_some_and(|word| word.eq_ignore_ascii_case("#n/a"))
}

impl Separator {
    /// The separator of a line, by the first of `;`, tab and comma that stands outside of quotes.
    /// Where blanks separate numbers, too, tabs are blanks, and the commas in `1,5 2,5` are decimal.
    pub(super) fn of(line: &str) -> Self {
        let bare = |c: char| line.split('"').step_by(2).any(|part| part.contains(c));
        let has_blank = |cell: &str| cell.trim().contains(char::is_whitespace);
        if bare(';') {
            return Self::Char(';');
        } else if bare('\t') {
            let by_tabs = line.contains('"') || !line.split('\t').any(has_blank);
            return if by_tabs { Self::Char('\t') } else { Self::Blanks };
        }
        let has_decimal_comma = |word: &str| {
            let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
            word.split_once(',').is_none_or(|(whole, fraction)| {
                digit(whole.chars().last()) && digit(fraction.chars().next())
            })
        };
        let words = || line.split_whitespace();
        if !bare(',') || words().nth(1).is_some() && words().all(has_decimal_comma) {
            Self::Blanks
        } else {
            Self::Char(',')
        }
    }

    /// The cells of a line, without blanks and quotes around them.
    pub(super) fn cells(self, line: &str) -> impl Iterator<Item = &str> {
        let mut rest = match self {
            Self::Blanks => Some(line.trim()).filter(|line| !line.is_empty()),
            Self::Char(_) => Some(line),
        };
        std::iter::from_fn(move || {
            let line = rest?;
            let is_separator = |c: char| match self {
                Self::Blanks => c.is_whitespace(),
                Self::Char(separator) => c == separator,
            };
            let mut is_quoted = false;
            let end = line.find(|c: char| {
                is_quoted ^= c == '"';
                !is_quoted && is_separator(c)
            });
            let (cell, after) = match end {
                Some(end) => {
                    let width = line[end..].chars().next().map_or(1, char::len_utf8);
                    (&line[..end], Some(&line[end + width..]))
                }
                None => (line, None),
            };
            rest = match self {
                Self::Blanks => after.map(str::trim_start),
                Self::Char(_) => after,
            };
            Some(cell.trim().trim_matches('"').trim())
        })
    }
}

/// Whether a cell that is not a number looks like one with separators between thousands, as `1,234,567.5`
/// and `1 234.5` do.
pub(super) fn has_thousands(cell: &str) -> bool {
    let digits = cell.trim_start_matches(['+', '-', '\u{2212}']);
    let is_separator = |c: char| ",.'’_ \u{a0}\u{202f}".contains(c);
    let groups: Vec<&str> = digits.split(is_separator).collect();
    let [first, middle @ .., last] = &groups[..] else { return false };
    let is_number = |group: &str| !group.is_empty() && group.bytes().all(|c| c.is_ascii_digit());
    // Dates have other groups.
    is_number(first)
        && first.len() <= 3
        && middle.iter().all(|group| is_number(group) && group.len() == 3)
        && is_number(last)
}

/// Reads cells of one file, which has decimal points or decimal commas but not both.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Numbers {
    /// Which of the two was found so far.
    decimal: Option<u8>,
}

/// A number with the other decimal sign than those before it.
pub(super) struct MixedDecimals;

impl Numbers {
    /// Reads one cell.
    pub(super) fn read(&mut self, cell: &str) -> Result<Cell, MixedDecimals> {
        if let Some(rest) =
            cell.strip_prefix('\u{2212}').filter(|rest| !rest.starts_with(['+', '-']))
        {
            return self.read(&format!("-{rest}"));
        }
        // Most cells are plain numbers.
        let unsigned = cell.strip_prefix('+').filter(|rest| !rest.starts_with(['+', '-']));
        let cell = unsigned.unwrap_or(cell);
        if let Ok(number) = fast_float2::parse(cell) {
            return match self.decimal {
                Some(b',') if cell.contains('.') => Err(MixedDecimals),
                None if cell.contains('.') => {
                    self.decimal = Some(b'.');
                    Ok(Cell::Number(number))
                }
                _ => Ok(Cell::Number(number)),
            };
        }
        if MISSING.iter().any(|word| word.eq_ignore_ascii_case(cell)) {
            return Ok(Cell::Missing);
        }
        let bytes = cell.as_bytes();
        if bytes.len() > LONGEST_NUMBER || !bytes.contains(&b',') || bytes.contains(&b'.') {
            return Ok(Cell::Word);
        }
        let mut copy = [0; LONGEST_NUMBER];
        let copy = &mut copy[..bytes.len()];
        copy.copy_from_slice(bytes);
        copy.iter_mut().filter(|byte| **byte == b',').for_each(|byte| *byte = b'.');
        match (fast_float2::parse(copy), self.decimal) {
            (Ok(_), Some(b'.')) => Err(MixedDecimals),
            (Ok(number), _) => {
                self.decimal = Some(b',');
                Ok(Cell::Number(number))
            }
            (Err(_), _) => Ok(Cell::Word),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separators_are_told_from_decimal_commas() {
        for (line, expected) in [
            ("1 2 3", &["1", "2", "3"][..]),
            ("  1   2  ", &["1", "2"]),
            ("1,2,3", &["1", "2", "3"]),
            ("1, 2, 3", &["1", "2", "3"]),
            ("1\t\t3", &["1", "", "3"]),
            (" 1\t\t2 3", &["1", "2", "3"]),
            ("1,5 2,5", &["1,5", "2,5"]),
            ("1,5;2,5; 3", &["1,5", "2,5", "3"]),
            ("\"1,5\",\"2,5\"", &["1,5", "2,5"]),
            ("\"a;b\",2", &["a;b", "2"]),
            (",1,", &["", "1", ""]),
            ("\"1", &["1"]),
        ] {
            let cells: Vec<&str> = Separator::of(line).cells(line).collect();
            assert_eq!(cells, expected, "{line}");
        }
    }

    #[test]
    fn minus_signs_and_thousands() {
        let read = |cell: &str| Numbers::default().read(cell).ok();
        assert_eq!(read("\u{2212}1.5"), Some(Cell::Number(-1.5)));
        assert_eq!(read("\u{2212}1,5"), Some(Cell::Number(-1.5)));
        assert_eq!(read("\u{2212}-1"), Some(Cell::Word));
        assert_eq!(read("\u{2212}\u{2212}1"), Some(Cell::Word));
        let cells = ["1,234,567", "1,234.5", "-1.234,5", "1 234.5", "1'234", "12\u{202f}345"];
        assert!(cells.iter().all(|cell| has_thousands(cell) && read(cell) == Some(Cell::Word)));
        assert!(
            !["x", "1x", "", "-", "2024-01-01", "2024.01.01", "01.02.2024", "12"]
                .iter()
                .any(|cell| has_thousands(cell))
        );
    }

    #[test]
    fn lines_end_as_on_any_system() {
        let found: Vec<(usize, &str)> = lines("1\r2\r\n3\n\r4\r").collect();
        assert_eq!(found, [(1, "1"), (2, "2"), (3, "3"), (5, "4")]);
    }

    #[test]
    fn comments_are_cut_off_but_not_missing_values() {
        let text = "\u{feff}# a\n% b\n1 2 # c\n\n3 #N/A 4\n#N/A 5\n6#7\n";
        let found: Vec<(usize, &str)> = lines(text).collect();
        assert_eq!(found, [(3, "1 2 "), (5, "3 #N/A 4"), (6, "#N/A 5"), (7, "6#7")]);
    }
}
