//! What the text formats share: encodings, words with their lines, numbers.

use std::borrow::Cow;

use super::error::Fault;

/// The bytes as ASCII-compatible text: without a UTF-8 byte order mark, and UTF-16 decoded.
///
/// Anything else is left as it is. Decoded text is at most one and a half times as long.
pub(super) fn decode(bytes: &[u8]) -> Cow<'_, [u8]> {
    let utf16 = |bytes: &[u8], unit: fn([u8; 2]) -> u16| {
        let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
        let mut text = String::with_capacity(bytes.len() / 2);
        text.extend(char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)));
        Cow::Owned(text.into_bytes())
    };
    match bytes {
        [0xEF, 0xBB, 0xBF, rest @ ..] => Cow::Borrowed(rest),
        [0xFF, 0xFE, rest @ ..] => utf16(rest, u16::from_le_bytes),
        [0xFE, 0xFF, rest @ ..] => utf16(rest, u16::from_be_bytes),
        _ => Cow::Borrowed(bytes),
    }
}

/// Whether a byte separates words but not lines.
pub(super) fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | 0x0B | 0x0C)
}

/// Whether a byte ends a line.
pub(super) fn is_line_end(byte: u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}

/// Steps over the line end that begins at `at`: CR LF counts as one.
pub(super) fn after_line_end(bytes: &[u8], at: usize) -> usize {
    if bytes.get(at) == Some(&b'\r') && bytes.get(at + 1) == Some(&b'\n') { at + 2 } else { at + 1 }
}

/// Walks through the words of a text and knows the line of each.
#[derive(Debug, Clone)]
pub(super) struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
    comment: Option<u8>,
}

impl<'a> Words<'a> {
    /// Words of a text in which `comment`, if any, hides the rest of its line.
    pub(super) fn new(bytes: &'a [u8], comment: Option<u8>) -> Self {
        Self { bytes, at: 0, line: 1, comment }
    }

    /// The line of the word read last, or of the end of the text, counted from 1.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    /// Bytes not yet read.
    pub(super) fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at.min(self.bytes.len())..]
    }

    /// The next word on this line.
    pub(super) fn next_on_line(&mut self) -> Option<&'a [u8]> {
        while self.bytes.get(self.at).is_some_and(|&byte| is_blank(byte)) {
            self.at += 1;
        }
        let start = self.at;
        let first = *self.bytes.get(start)?;
        if is_line_end(first) || Some(first) == self.comment {
            return None;
        }
        let ends = |&byte: &u8| is_blank(byte) || is_line_end(byte) || Some(byte) == self.comment;
        let length = self.bytes[start..].iter().position(ends);
        self.at = length.map_or(self.bytes.len(), |length| start + length);
        Some(&self.bytes[start..self.at])
    }

    /// The next word on this or any later line.
    pub(super) fn next(&mut self) -> Option<&'a [u8]> {
        loop {
            if let Some(word) = self.next_on_line() {
                return Some(word);
            }
            if !self.skip_line() {
                return None;
            }
        }
    }

    /// Skips what is left of this line; false at the end of the text.
    pub(super) fn skip_line(&mut self) -> bool {
        match self.rest().iter().position(|&byte| is_line_end(byte)) {
            Some(length) => {
                self.at = after_line_end(self.bytes, self.at + length);
                self.line += 1;
                true
            }
            None => {
                self.at = self.bytes.len();
                false
            }
        }
    }

    /// What is left of this line, without blanks around it.
    pub(super) fn rest_of_line(&mut self) -> &'a [u8] {
        let rest = self.rest();
        let length = rest.iter().position(|&byte| is_line_end(byte)).unwrap_or(rest.len());
        self.at += length;
        rest[..length].trim_ascii()
    }
}

/// The finite double nearest to a decimal number.
pub(super) fn number(word: &[u8]) -> Result<f64, Fault> {
    match fast_float2::parse::<f64, _>(word) {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(Fault::NotFinite(shown(word))),
        Err(_) => Err(Fault::BadNumber(shown(word))),
    }
}

/// A word as an error message shows it: escaped where it is not plain text, and cut when long.
pub(super) fn shown(word: &[u8]) -> String {
    const LONGEST: usize = 40;
    let text = String::from_utf8_lossy(&word[..word.len().min(4 * LONGEST)]);
    let mut shown: String = text
        .chars()
        .take(LONGEST)
        .map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c })
        .collect();
    if text.chars().nth(LONGEST).is_some() {
        shown.push('…');
    }
    shown
}

/// Words for a name, for people: never fails.
pub(super) fn name(word: &[u8]) -> String {
    String::from_utf8_lossy(word).into_owned()
}
