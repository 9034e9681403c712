//! A single-stroke font: each letter is drawn as centerlines, not outlines.
//!
//! ```text
//!   8 ┬ ╷   ╱╲     capitals, digits and ascenders
//!   6 ┼ │  ╱──╲    lowercase letters
//!   2 ┴ └─╱    ╲   the baseline
//!   0              descenders
//! ```
//!
//! Glyphs are drawn on a grid 4 units wide and 8 units high. A glyph has a width and strokes. Each point
//! is two digits, x and y; a blank lifts the pen.

use glam::{DVec2, dvec2};

use super::letters::{Accent, combining, split};

/// Height of capitals above the baseline, in units of the glyph grid.
const CAPITAL: f64 = 6.0;

/// Space after each glyph, in units of the glyph grid.
const GAP: f64 = 1.6;

const BASELINE: f64 = 2.0;

/// Height of lowercase letters above the baseline, in units of the glyph grid.
const SMALL: f64 = 4.0;

/// Gap between a letter and the accent above it.
const ABOVE: f64 = 0.6;

/// Minimum width of a letter with an accent.
const WIDEST_ACCENT: f64 = 2.6;

/// A character, its width and its strokes.
type Glyph = (char, u8, &'static str);

#[rustfmt::skip]
const GLYPHS: &[Glyph] = &[
    ('!', 0, "0804 0302"), ('"', 2, "0806 2826"), ('#', 4, "1218 3238 0444 0646"),
    ('$', 4, "473818070615354443321203 2921"), ('%', 4, "0248 0718 3243"), ('&', 4, "4206071827260403122244"),
    ('\'', 0, "0806"), ('(', 1, "18060412"), (')', 1, "08161402"), ('*', 4, "2337 2733 0545"),
    ('+', 4, "2337 0545"), (',', 1, "1201"), ('-', 3, "0535"), ('.', 0, "0203"), ('/', 3, "0238"),
    ('0', 3, "180703122233372818") , ('1', 2, "071828 2822"), ('2', 4, "07183847460242"),
    ('3', 4, "07183847463525 354443321203"), ('4', 4, "380444 3832"), ('5', 4, "480805354443321203"),
    ('6', 4, "3818060312324344351504"), ('7', 4, "084812"), ('8', 4, "15060718384746351504031232434435"),
    ('9', 4, "1232444738180706153546"), (':', 0, "0302 0605"), (';', 1, "1615 1201"), ('<', 3, "370533"),
    ('=', 3, "0434 0636"), ('>', 3, "073503"), ('?', 3, "07182837362524 2322"), ('@', 4, "3635251413233336 3343474838180703123242"),
    ('A', 4, "022842 1434"), ('B', 4, "02083847463505 3544433202"), ('C', 4, "4738180703123243"),
    ('D', 4, "02082846442202"), ('E', 4, "48080242 0535"), ('F', 4, "480802 0535"),
    ('G', 4, "47381807031232434525"), ('H', 4, "0802 4842 0545"), ('I', 0, "0802"),
    ('J', 3, "3833221203"), ('K', 4, "0802 4804 1542"), ('L', 3, "080232"), ('M', 4, "0208254842"),
    ('N', 4, "02084248"), ('O', 4, "180703123243473818"), ('P', 4, "02083847463505"),
    ('Q', 4, "180703123243473818 2442"), ('R', 4, "02083847463505 2542"), ('S', 4, "473818070615354443321203"),
    ('T', 4, "0848 2822"), ('U', 4, "080312324348"), ('V', 4, "082248"), ('W', 4, "0812253248"),
    ('X', 4, "0842 0248"), ('Y', 4, "082548 2522"), ('Z', 4, "08480242"), ('[', 1, "18080212"),
    ('\\', 3, "0832"), (']', 1, "08181202"), ('^', 3, "061836"), ('_', 4, "0141"), ('`', 1, "0817"),
    ('a', 3, "36160503122233 3632"), ('b', 3, "0802 0516263533221203"), ('c', 3, "3626160503122232"),
    ('d', 3, "3832 3626160503122233"), ('e', 3, "043435261605031232"), ('f', 2, "28180702 0525"),
    ('g', 3, "361605041333 3631201001"), ('h', 3, "0802 0516263532"), ('i', 0, "0602 0807"),
    ('j', 1, "16110010 1817"), ('k', 3, "0802 3603 1432"), ('l', 1, "080312"), ('m', 4, "0602 0516252622 2536454642"),
    ('n', 3, "0602 0516263532"), ('o', 3, "160503122233352616"), ('p', 3, "0600 0516263533221203"),
    ('q', 3, "3630 3526160503122233"), ('r', 2, "0602 051626"), ('s', 3, "3616051434231203"),
    ('t', 2, "08031222 0626"), ('u', 3, "0603122233 3632"), ('v', 4, "062246"), ('w', 4, "0612243246"),
    ('x', 3, "0632 0236"), ('y', 3, "0622 3610"), ('z', 3, "06360232"), ('{', 2, "28181605141222"),
    ('|', 0, "0801"), ('}', 2, "08181625141202"), ('~', 4, "05162434 3445"),
    ('Æ', 4, "022848 282242 1545"), ('Ð', 4, "02082846442202 0525"), ('Ø', 4, "180703123243473818 0248"),
    ('Þ', 4, "0802 073746453404"), ('ß', 3, "0207182837362534332212"), ('æ', 4, "061625231203142444453625 233242"),
    ('ð', 3, "3526160503122233352718 1738"), ('ø', 3, "160503122233352616 0236"), ('þ', 3, "0800 0516263533221203"),
    ('Ł', 3, "080232 0426"), ('ł', 1, "080312 0415"), ('ı', 0, "0602"),
    ('¡', 0, "0807 0602"), ('¿', 3, "33221203041516 1718"), ('«', 3, "160514 362534"), ('»', 3, "061504 263524"),
    ('£', 4, "4738281712 0242 0535"), ('€', 4, "4738281713223243 0636 0434"), ('·', 0, "0504"),
    ('°', 2, "1827160718"), ('±', 4, "2428 0646 0242"), ('×', 4, "1337 1733"), ('÷', 4, "0545 2726 2423"),
    ('¹', 1, "071815"), ('²', 2, "0718270525"), ('³', 2, "082817261505"), ('µ', 3, "0600 03122233 3632"),
    ('π', 4, "0646 1612 3632"), ('θ', 3, "180703122233372818 0535"),
];

/// The strokes of a line of text, and its width. `height` is the height of capitals; the origin is at the
/// left end of the baseline, with x to the right and y up. Accented letters are composed of a letter and
/// an accent. Characters that are not in the font, see [`missing`], become question marks.
pub fn text(line: &str, height: f64) -> (Vec<Vec<DVec2>>, f64) {
    let unit = height / CAPITAL;
    let mut strokes = Vec::new();
    let mut at = 0.0;
    for (character, accent) in letters(line) {
        if character == ' ' {
            at += 3.0 + GAP;
            continue;
        }
        let Some((_, width, drawing)) = glyph(character).or_else(|| glyph('?')) else { continue };
        let mut parts: Vec<&str> = drawing.split(' ').filter(|part| part.len() >= 4).collect();
        let mut room = f64::from(*width);
        if let Some(accent) = accent {
            room = room.max(WIDEST_ACCENT);
            if matches!(character, 'i' | 'j') && !accent.is_below() {
                // The accent replaces the dot.
                parts.truncate(1);
            }
        }
        let left = at + (room - f64::from(*width)) / 2.0;
        for part in parts {
            let digit = |byte: u8| f64::from(byte.saturating_sub(b'0'));
            let points = part.as_bytes().chunks_exact(2);
            let place = |p: &[u8]| dvec2(left + digit(p[0]), digit(p[1]) - BASELINE) * unit;
            strokes.push(points.map(place).collect());
        }
        if let Some(accent) = accent {
            let top = if character.is_uppercase() { CAPITAL } else { SMALL } + ABOVE;
            let from = dvec2(at + room / 2.0, if accent.is_below() { 0.0 } else { top });
            let place = |&(x, y): &(f64, f64)| (from + dvec2(x, y)) * unit;
            strokes.extend(accent.strokes().iter().map(|s| s.iter().map(place).collect()));
        }
        at += room + GAP;
    }
    (strokes, (at - GAP).max(0.0) * unit)
}

/// The characters of a line that are not in the font, each once, in order of appearance.
pub fn missing(line: &str) -> Vec<char> {
    let mut missing: Vec<char> = Vec::new();
    for (character, _) in letters(line) {
        if character != ' ' && glyph(character).is_none() && !missing.contains(&character) {
            missing.push(character);
        }
    }
    missing
}

fn glyph(wanted: char) -> Option<&'static Glyph> {
    GLYPHS.iter().find(|(character, ..)| *character == wanted)
}

/// The letters of a line, each with its accent split off and replaced by the variant that the font has.
fn letters(line: &str) -> impl Iterator<Item = (char, Option<Accent>)> {
    let mut characters = line.chars().peekable();
    std::iter::from_fn(move || {
        let character = characters.next()?;
        let (letter, accent) = match characters.peek().and_then(|mark| combining(*mark)) {
            Some(accent) => {
                characters.next();
                (character, Some(accent))
            }
            None => match split(character) {
                Some((letter, accent)) => (letter, Some(accent)),
                None => (character, None),
            },
        };
        let letter = match letter {
            '−' | '–' | '—' | '‐' => '-',
            '‘' | '’' | '´' => '\'',
            '“' | '”' | '„' => '"',
            'μ' => 'µ',
            blank if blank.is_whitespace() => ' ',
            other => other,
        };
        Some((letter, accent))
    })
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

    #[test]
    fn western_european_letters_have_strokes_of_their_own() {
        let line = "ÀÁÂÃÄÅÆÇÈÉÊËÌÍÎÏÐÑÒÓÔÕÖ×ØÙÚÛÜÝÞßàáâãäåæçèéêëìíîïðñòóôõö÷øùúûüýþÿ¡£¿«»²³¹°±µ·€π";
        assert_eq!(missing(line), []);
        let glyphs: Vec<_> = line.chars().map(|c| text(&c.to_string(), 6.0).0).collect();
        let question = text("?", 6.0).0;
        for (k, glyph) in glyphs.iter().enumerate() {
            let character = line.chars().nth(k).expect("a character");
            assert!(!glyphs[..k].contains(glyph) && *glyph != question, "{character}");
            let mut points = glyph.iter().flatten();
            assert!(
                points.all(|p| p.x >= 0.0 && p.x <= 4.0 && p.y >= -2.0 && p.y <= 8.0),
                "{character}"
            );
        }
        assert_eq!(missing("日本 Grüße 日"), ['日', '本']);
        assert_eq!(text("日", 6.0), text("?", 6.0));
    }

    #[test]
    fn accents_can_follow_their_letters() {
        assert_eq!(text("Gru\u{308}ße, A\u{30a}s", 6.0), text("Grüße, Ås", 6.0));
        assert_ne!(text("ü", 6.0).0, text("u", 6.0).0);
        let widths = ["ï", "i"].map(|line| text(line, 6.0).1);
        assert!(widths[0] > widths[1]);
    }
}
