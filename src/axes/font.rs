//! A single-stroke font: each letter is drawn as centerlines, not outlines.
//!
//! ```text
//!        ₙ   ┬ raised letters: 0.6 times as high, 0.55 of a capital up
//!   x ╱╲ 2   │
//!   ╱╲   ────┴ the baseline; lowered letters stand 0.2 of a capital below it
//! ```

use glam::{DVec2, dvec2};

use super::glyphs::glyph;
use super::script::{Letter, Script, letters};

/// Height of capitals above the baseline, in units of the glyph grid.
const CAPITAL: f64 = 6.0;

/// Space after each glyph, in units of the glyph grid.
const GAP: f64 = 1.6;

/// Width of a blank without the space after it, in units of the glyph grid.
const BLANK: f64 = 3.0;

const BASELINE: f64 = 2.0;

/// Height of lowercase letters above the baseline, in units of the glyph grid.
const SMALL: f64 = 4.0;

/// Gap between a letter and the accent above it.
const ABOVE: f64 = 0.6;

/// Minimum width of a letter with an accent.
const WIDEST_ACCENT: f64 = 2.6;

/// Size of raised and lowered letters as a fraction of the others.
const SCRIPT_SIZE: f64 = 0.6;

/// How far raised letters are raised, as a fraction of the height of capitals.
const RAISED: f64 = 0.55;

/// How far lowered letters are lowered, as a fraction of the height of capitals.
const LOWERED: f64 = 0.2;

/// The strokes of a line of text, and its width. `height` is the height of capitals; the origin is at the
/// left end of the baseline, with x to the right and y up.
///
/// Accented letters are composed of a letter and an accent. `^{…}` raises and `_{…}` lowers what is
/// between the braces, as the characters ² and ₂ do. Characters that are not in the font, see
/// [`missing`], become question marks.
pub fn text(line: &str, height: f64) -> (Vec<Vec<DVec2>>, f64) {
    let unit = height / CAPITAL;
    let mut strokes = Vec::new();
    let (mut at, mut end) = (0.0, 0.0);
    let letters = letters(line);
    for (k, letter) in letters.iter().enumerate() {
        let (size, base) = match letter.script {
            Script::OnLine => (1.0, 0.0),
            Script::Raised => (SCRIPT_SIZE, RAISED * CAPITAL),
            Script::Lowered => (SCRIPT_SIZE, -LOWERED * CAPITAL),
        };
        let place = |p: DVec2| (dvec2(at, base) + p * size) * unit;
        let width = draw(letter, |stroke| strokes.push(stroke.map(place).collect()));
        end = at + size * width;
        let on_line = |letter: &Letter| letter.script == Script::OnLine;
        let is_close = !on_line(letter) || letters.get(k + 1).is_some_and(|next| !on_line(next));
        at = end + if is_close { GAP / 2.0 } else { GAP };
    }
    (strokes, end * unit)
}

/// The characters of a line that are not in the font, each once, in order of appearance.
pub fn missing(line: &str) -> Vec<char> {
    let mut missing: Vec<char> = Vec::new();
    for Letter { character, .. } in letters(line) {
        if character != ' ' && glyph(character).is_none() && !missing.contains(&character) {
            missing.push(character);
        }
    }
    missing
}

/// Draws a letter at the origin, in units of the glyph grid, and returns its width.
fn draw(letter: &Letter, mut stroke: impl FnMut(&mut dyn Iterator<Item = DVec2>)) -> f64 {
    let Letter { character, accent, .. } = *letter;
    if character == ' ' {
        return BLANK;
    }
    let Some((_, width, drawing)) = glyph(character).or_else(|| glyph('?')) else { return BLANK };
    let width = f64::from(*width);
    let room = if accent.is_some() { width.max(WIDEST_ACCENT) } else { width };
    let left = (room - width) / 2.0;
    // An accent above replaces the dot, which is the last stroke.
    let has_dot = matches!(character, 'i' | 'j');
    let replaces_dot = has_dot && accent.is_some_and(|accent| !accent.is_below());
    for part in drawing.split(' ').take(if replaces_dot { 1 } else { usize::MAX }) {
        let digit = |byte: u8| f64::from(byte.saturating_sub(b'0'));
        let place = |p: &[u8]| dvec2(left + digit(p[0]), digit(p[1]) - BASELINE);
        stroke(&mut part.as_bytes().chunks_exact(2).map(place));
    }
    if let Some(accent) = accent {
        let top = if character.is_uppercase() { CAPITAL } else { SMALL } + ABOVE;
        let from = dvec2(room / 2.0, if accent.is_below() { 0.0 } else { top });
        for part in accent.strokes() {
            stroke(&mut part.iter().map(|&(x, y)| from + dvec2(x, y)));
        }
    }
    room
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_printable_character_has_strokes_of_its_own() {
        let glyphs: Vec<_> = ('!'..='~').map(|c| text(&c.to_string(), 6.0).0).collect();
        for (k, glyph) in glyphs.iter().enumerate() {
            assert!(
                !glyph.is_empty() && !glyphs[..k].contains(glyph),
                "{:?}",
                char::from(33 + k as u8)
            );
            let points = glyph.iter().flatten();
            assert!(points.clone().all(|p| p.x >= 0.0 && p.x <= 4.0 && p.y >= -2.0 && p.y <= 7.0));
        }
    }

    /// Letters that stand for themselves, in the order of the tables that they come from.
    const LATIN: &str =
        "ÀÁÂÃÄÅÆÇÈÉÊËÌÍÎÏÐÑÒÓÔÕÖ×ØÙÚÛÜÝÞßàáâãäåæçèéêëìíîïðñòóôõö÷øùúûüýþÿ¡£¿«»²³¹°±µ·€π";
    const GREEK: &str = "αβγδεζηθικλνξπρστφχψωΓΔΘΛΞΠΣΦΨΩ";
    const SIGNS: &str = "∂∇∞√∫≤≥≠≈−→⁰⁴⁵⁶⁷⁸⁹⁺⁻ⁿ₀₁₂₃₄₅₆₇₈₉₊₋ᵢ";

    #[test]
    fn letters_of_western_europe_and_science_have_strokes_of_their_own() {
        for line in [LATIN, &[GREEK, SIGNS].concat()] {
            assert_eq!(missing(line), []);
            let glyphs: Vec<_> = line.chars().map(|c| text(&c.to_string(), 6.0).0).collect();
            let question = text("?", 6.0).0;
            for (k, glyph) in glyphs.iter().enumerate() {
                let character = line.chars().nth(k).expect("a character");
                assert!(!glyphs[..k].contains(glyph) && *glyph != question, "{character}");
                assert!(glyph.iter().all(|stroke| stroke.len() > 1), "{character}");
                let mut points = glyph.iter().flatten();
                assert!(
                    points.all(|p| p.x >= 0.0 && p.x <= 4.0 && p.y >= -2.0 && p.y <= 8.0),
                    "{character}"
                );
            }
        }
        assert_eq!(missing("日本 Grüße 日"), ['日', '本']);
        assert_eq!(text("日", 6.0), text("?", 6.0));
    }

    #[test]
    fn letters_that_look_alike_are_drawn_alike() {
        for (line, same) in [
            ("ΑΒΕΖΗΙΚΜΝΟΡΤΥΧ", "ABEZHIKMNOPTYX"),
            ("ουςϑϕ", "ouσθφ"),
            ("x²", "x^{2}"),
            ("s⁻¹", "s^{−1}"),
            ("aᵢ", "a_{i}"),
        ] {
            assert_eq!(text(line, 6.0), text(same, 6.0), "{line}");
        }
    }

    #[test]
    fn a_minus_is_as_wide_as_a_plus_and_a_hyphen_is_shorter() {
        let width = |line| text(line, 6.0).1;
        assert_eq!(width("−"), width("+"));
        assert!(width("-") < width("−"));
    }

    #[test]
    fn signs_are_symmetric() {
        for line in ["+", "×", "*", "±", "−", "=", "φ", "Φ", "Ψ", "ψ", "Ω", "ω", "∞", "Δ", "∇"]
        {
            let (strokes, width) = text(line, 6.0);
            let mut points: Vec<_> = strokes.iter().flatten().map(|p| (p.x, p.y)).collect();
            let mut mirrored: Vec<_> = points.iter().map(|p| (width - p.0, p.1)).collect();
            for points in [&mut points, &mut mirrored] {
                points.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
                points.dedup();
            }
            assert_eq!(points, mirrored, "{line}");
        }
    }

    #[test]
    fn raised_letters_are_small_and_close() {
        let top = |line| {
            let points = text(line, 6.0).0.into_iter().flatten();
            points.map(|p| p.y).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| {
                (low.min(y), high.max(y))
            })
        };
        let near = |(a, b): (f64, f64), (c, d): (f64, f64)| (a - c).abs() + (b - d).abs() < 1e-12;
        assert!(near(top("^{1}"), (3.3, 6.9)) && near(top("_{1}"), (-1.2, 2.4)));
        let width = |line| text(line, 6.0).1;
        assert!((width("10²") - (2.0 + 1.6 + 3.0 + 0.8 + 0.6 * 4.0)).abs() < 1e-12);
    }

    #[test]
    fn a_cedilla_hangs_below_its_letter_and_other_marks_stand_above_theirs() {
        let span = |line: &str| {
            let ys = text(line, 6.0).0.into_iter().flatten().map(|p| p.y);
            ys.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)))
        };
        for (marked, plain) in ["çc", "Şs", "Çc"].map(|pair| {
            let plain: String = pair.chars().skip(1).collect();
            let marked: String = pair.chars().take(1).collect();
            let is_capital = marked.chars().all(char::is_uppercase);
            (marked, if is_capital { plain.to_uppercase() } else { plain })
        }) {
            let ((low, high), (base, top)) = (span(&marked), span(&plain));
            assert!(low < base - 1.0 && high == top, "{marked}: {low} to {high}");
        }
        for (marked, plain) in "àâãäåčőżÀÂÃÄÅČŐŻ".chars().zip("aaaaacozAAAAACOZ".chars())
        {
            let ((low, high), (base, top)) = (span(&marked.to_string()), span(&plain.to_string()));
            assert!(high > top + 0.5 && low == base, "{marked}: {low} to {high}");
        }
    }

    #[test]
    fn accents_can_follow_their_letters() {
        assert_eq!(text("Gru\u{308}ße, A\u{30a}s", 6.0), text("Grüße, Ås", 6.0));
        assert_ne!(text("ü", 6.0).0, text("u", 6.0).0);
        let widths = ["ï", "i"].map(|line| text(line, 6.0).1);
        assert!(widths[0] > widths[1]);
    }
}
