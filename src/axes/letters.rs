//! Accents: marks added to plain letters, so that most accented Latin letters need no glyphs of their
//! own.
//!
//! ```text
//!    ╱      ╲╱     o o    ○            the mark is centered above the letter,
//!   E      S      u      A      c     or below the baseline
//!                               ¸
//! ```

/// A mark above or below a letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Accent {
    Grave,
    Acute,
    Circumflex,
    Tilde,
    Diaeresis,
    Ring,
    Cedilla,
    Caron,
    DoubleAcute,
    Dot,
}

use Accent::*;

/// An accent, the letters that carry it, and the same letters without it.
const ACCENTED: [(Accent, &str, &str); 10] = [
    (Grave, "ÀÈÌÒÙàèìòù", "AEIOUaeiou"),
    (Acute, "ÁÉÍÓÚÝáéíóúýĆćŃńŚśŹź", "AEIOUYaeiouyCcNnSsZz"),
    (Circumflex, "ÂÊÎÔÛâêîôû", "AEIOUaeiou"),
    (Tilde, "ÃÑÕãñõ", "ANOano"),
    (Diaeresis, "ÄËÏÖÜŸäëïöüÿ", "AEIOUYaeiouy"),
    (Ring, "ÅåŮů", "AaUu"),
    (Cedilla, "ÇçŞş", "CcSs"),
    (Caron, "ČčĎĚěŇňŘřŠšŤŽž", "CcDEeNnRrSsTZz"),
    (DoubleAcute, "ŐőŰű", "OoUu"),
    (Dot, "ŻżİĖė", "ZzIEe"),
];

/// Splits an accented letter into the plain letter and its accent.
pub(super) fn split(letter: char) -> Option<(char, Accent)> {
    ACCENTED.iter().find_map(|(accent, with, without)| {
        let place = with.chars().position(|c| c == letter)?;
        Some((without.chars().nth(place)?, *accent))
    })
}

/// The accent of a combining character, which follows its letter.
pub(super) fn combining(mark: char) -> Option<Accent> {
    Some(match mark {
        '\u{300}' => Grave,
        '\u{301}' => Acute,
        '\u{302}' => Circumflex,
        '\u{303}' => Tilde,
        '\u{307}' => Dot,
        '\u{308}' => Diaeresis,
        '\u{30a}' => Ring,
        '\u{30b}' => DoubleAcute,
        '\u{30c}' => Caron,
        '\u{327}' => Cedilla,
        _ => return None,
    })
}

impl Accent {
    /// Whether it is placed below the baseline instead of above the letter.
    pub(super) fn is_below(self) -> bool {
        self == Cedilla
    }

    /// Its strokes, in units of the glyph grid: x from the center of the letter, y from the baseline or
    /// from a little above the letter.
    pub(super) fn strokes(self) -> &'static [&'static [(f64, f64)]] {
        match self {
            Grave => &[&[(-0.7, 1.3), (0.5, 0.0)]],
            Acute => &[&[(-0.5, 0.0), (0.7, 1.3)]],
            Circumflex => &[&[(-1.0, 0.0), (0.0, 1.2), (1.0, 0.0)]],
            Tilde => &[&[(-1.3, 0.2), (-0.6, 0.9), (0.6, 0.2), (1.3, 0.9)]],
            Diaeresis => &[&[(-0.8, 0.1), (-0.8, 0.9)], &[(0.8, 0.1), (0.8, 0.9)]],
            Ring => &[&[(0.0, -0.2), (0.7, 0.5), (0.0, 1.2), (-0.7, 0.5), (0.0, -0.2)]],
            Cedilla => &[&[(0.0, 0.0), (0.0, -0.5), (0.5, -1.0), (0.0, -1.5), (-0.5, -1.5)]],
            Caron => &[&[(-1.0, 1.2), (0.0, 0.0), (1.0, 1.2)]],
            DoubleAcute => &[&[(-1.1, 0.0), (-0.3, 1.3)], &[(0.3, 0.0), (1.1, 1.3)]],
            Dot => &[&[(0.0, 0.1), (0.0, 0.9)]],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ACCENTED;

    #[test]
    fn each_accented_letter_has_its_plain_one() {
        for (accent, with, without) in ACCENTED {
            assert_eq!(with.chars().count(), without.chars().count(), "{accent:?}");
            assert!(without.is_ascii() && !with.chars().any(|c| c.is_ascii()), "{accent:?}");
        }
    }
}
