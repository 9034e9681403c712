//! Paper sizes, and lengths with units.

use std::str::FromStr;

use thiserror::Error;

use super::Orientation;

/// A sheet of paper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paper {
    /// From left to right.
    pub width_mm: f64,
    /// From top to bottom.
    pub height_mm: f64,
    /// Name of the size; `None` for a size given in numbers, which is not turned to suit the drawing.
    pub name: Option<&'static str>,
}

/// Names and sizes, upright.
const NAMED: [(&str, f64, f64); 10] = [
    ("a0", 841.0, 1189.0),
    ("a1", 594.0, 841.0),
    ("a2", 420.0, 594.0),
    ("a3", 297.0, 420.0),
    ("a4", 210.0, 297.0),
    ("a5", 148.0, 210.0),
    ("a6", 105.0, 148.0),
    ("letter", 215.9, 279.4),
    ("legal", 215.9, 355.6),
    ("tabloid", 279.4, 431.8),
];

/// Why a text is not a paper size or not a length.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum PaperError {
    /// Neither a name nor two lengths.
    #[error(
        "`{0}` is not a paper size: use a0 to a6, letter, legal, tabloid, or WIDTHxHEIGHT in mm"
    )]
    Unknown(String),
    /// Not a number with a unit.
    #[error("`{0}` is not a length: use a number, with mm, cm or in unless it is in millimeters")]
    Length(String),
    /// Zero, negative, or larger than any paper.
    #[error("`{0}`: width and height must be above 0 and at most 100 m")]
    Size(String),
}

/// The longest side that a page may have.
const LONGEST_SIDE_MM: f64 = 100_000.0;

impl Paper {
    /// 297 × 420 mm.
    pub const A3: Self = Self { width_mm: 297.0, height_mm: 420.0, name: Some("a3") };

    /// 210 × 297 mm.
    pub const A4: Self = Self { width_mm: 210.0, height_mm: 297.0, name: Some("a4") };

    /// 148 × 210 mm.
    pub const A5: Self = Self { width_mm: 148.0, height_mm: 210.0, name: Some("a5") };

    /// 8.5 × 11 in.
    pub const LETTER: Self = Self { width_mm: 215.9, height_mm: 279.4, name: Some("letter") };

    /// A sheet of any size, in millimeters. It is not turned to suit the drawing.
    pub const fn new(width_mm: f64, height_mm: f64) -> Self {
        Self { width_mm, height_mm, name: None }
    }

    /// The sheet in the requested or suitable orientation.
    pub(super) fn turned(self, asked: Option<Orientation>, suits: Orientation) -> Self {
        let orientation = match (asked, self.name) {
            (Some(orientation), _) => orientation,
            (None, Some(_)) => suits,
            (None, None) => return self,
        };
        let (short, long) = (self.width_mm.min(self.height_mm), self.width_mm.max(self.height_mm));
        match orientation {
            Orientation::Landscape => Self { width_mm: long, height_mm: short, ..self },
            Orientation::Portrait => Self { width_mm: short, height_mm: long, ..self },
        }
    }

    /// Name and orientation, or the size: `A4 landscape`, `200 x 300 mm`.
    pub fn description(&self) -> String {
        let orientation = if self.width_mm >= self.height_mm { "landscape" } else { "portrait" };
        match self.name {
            Some(name) => {
                let mut letters = name.chars();
                let first = letters.next().map(|c| c.to_ascii_uppercase()).into_iter();
                format!("{} {orientation}", first.chain(letters).collect::<String>())
            }
            None => format!("{} x {} mm", self.width_mm, self.height_mm),
        }
    }
}

impl FromStr for Paper {
    type Err = PaperError;

    /// Reads a name, or width and height as `200x300`, `20x30cm`, `8.5inx11in`.
    fn from_str(text: &str) -> Result<Self, PaperError> {
        let lower = text.trim().to_ascii_lowercase();
        if let Some(&(name, width_mm, height_mm)) = NAMED.iter().find(|(name, ..)| *name == lower) {
            return Ok(Self { width_mm, height_mm, name: Some(name) });
        }
        let unknown = || PaperError::Unknown(text.to_owned());
        let (width, height) = lower.split_once('x').ok_or_else(unknown)?;
        let (height, height_unit) = split_unit(height);
        let (width, width_unit) = split_unit(width);
        let unit_mm = height_unit.unwrap_or(1.0);
        let width_mm = number(width).ok_or_else(unknown)? * width_unit.unwrap_or(unit_mm);
        let height_mm = number(height).ok_or_else(unknown)? * unit_mm;
        let fits = |side: f64| side > 0.0 && side <= LONGEST_SIDE_MM;
        if !(fits(width_mm) && fits(height_mm)) {
            return Err(PaperError::Size(text.to_owned()));
        }
        Ok(Self { width_mm, height_mm, name: None })
    }
}

/// Reads a length as `10`, `10mm`, `1cm` or `0.5in`, in millimeters.
///
/// # Errors
/// The text is not a finite number with one of these units.
pub fn parse_length_mm(text: &str) -> Result<f64, PaperError> {
    let (value, unit_mm) = split_unit(text.trim());
    number(value)
        .map(|value| value * unit_mm.unwrap_or(1.0))
        .ok_or_else(|| PaperError::Length(text.to_owned()))
}

fn number(text: &str) -> Option<f64> {
    text.trim().parse::<f64>().ok().filter(|value| value.is_finite())
}

/// Number and unit in millimeters, if the text ends in one.
fn split_unit(text: &str) -> (&str, Option<f64>) {
    [("mm", 1.0), ("cm", 10.0), ("in", 25.4)]
        .iter()
        .find_map(|&(unit, mm)| text.strip_suffix(unit).map(|value| (value, Some(mm))))
        .unwrap_or((text, None))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paper_is_named_or_measured() {
        let size = |text: &str| text.parse::<Paper>().map(|p| (p.width_mm, p.height_mm));
        assert_eq!(size("a4"), Ok((210.0, 297.0)));
        assert_eq!(size("A0"), Ok((841.0, 1189.0)));
        assert_eq!(size("letter"), Ok((215.9, 279.4)));
        assert_eq!(size("200x300"), Ok((200.0, 300.0)));
        assert_eq!(size("20x30cm"), Ok((200.0, 300.0)));
        assert_eq!(size("10inx20cm"), Ok((254.0, 200.0)));
    }

    #[test]
    fn nonsense_is_no_paper() {
        for text in ["", "a7", "x", "10x", "10x-1", "0x10", "nanx10", "infx3", "1e9x1"] {
            assert!(text.parse::<Paper>().is_err(), "{text}");
        }
    }

    #[test]
    fn lengths_have_units() {
        assert_eq!(parse_length_mm("0.5in"), Ok(12.7));
        assert_eq!(parse_length_mm("2 cm"), Ok(20.0));
        assert_eq!(parse_length_mm("3"), Ok(3.0));
        assert!(parse_length_mm("3 miles").is_err());
        assert!(parse_length_mm("inf").is_err());
    }
}
