//! Messages about formulas, with the place of the error.

use hiddenline::stages::surface::formula::FormulaError;

/// Characters of a formula that are shown before the place of an error, and after it.
const SHOWN: usize = 30;

/// What is wrong with the formula called `what`, and below it the formula with a mark at the place.
pub(super) fn in_formula(what: &str, text: &str, error: &FormulaError) -> String {
    format!("in {what}, {error}\n{}", marked(text, error.column))
}

/// The formula, indented, and a caret below the character of this number, counted from 1.
///
/// Of a long formula the part around the place is shown. Line ends and tabs become blanks.
fn marked(text: &str, column: usize) -> String {
    let at = column.saturating_sub(1);
    let shown: Vec<char> =
        text.chars().map(|c| if c.is_control() || c.is_whitespace() { ' ' } else { c }).collect();
    let from = if shown.len() > 2 * SHOWN { at.saturating_sub(SHOWN) } else { 0 };
    let to = if shown.len() > 2 * SHOWN { (at + SHOWN).min(shown.len()) } else { shown.len() };
    let part: String = shown.get(from..to).unwrap_or_default().iter().collect();
    let dots = |is_cut: bool| if is_cut { "…" } else { "" };
    let before = dots(from > 0);
    let blanks = before.chars().count() + at.saturating_sub(from);
    format!("  {before}{part}{}\n  {}^", dots(to < shown.len()), " ".repeat(blanks))
}

#[cfg(test)]
mod tests {
    use super::marked;

    #[test]
    fn the_caret_stands_below_the_place() {
        assert_eq!(marked("π + $", 5), "  π + $\n      ^");
        assert_eq!(marked("(x", 3), "  (x\n    ^");
        let long = format!("{}$ + 1", "x+".repeat(100));
        let marked = marked(&long, 201);
        let (line, caret) = marked.split_once('\n').expect("two lines");
        assert_eq!(line.chars().nth(caret.chars().count() - 1), Some('$'), "{marked}");
        assert!(line.chars().count() < 70, "{marked}");
    }
}
