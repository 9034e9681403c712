//! From the bytes of a file to its text: gzip is unpacked, and any encoding that XML can declare is
//! converted.

use std::borrow::Cow;
use std::io::Read;

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};
use flate2::read::MultiGzDecoder;

use super::SvgError;

/// Bytes of text beyond which a file is refused, unpacked or not.
pub(super) const MAX_TEXT_BYTES: usize = 1 << 30;
/// How often a file may have been packed.
const MAX_PACKINGS: usize = 3;
/// The XML declaration ends within this many bytes.
const DECLARATION_BYTES: usize = 512;

/// The text of a file, and a warning where the encoding had to be guessed.
pub(super) fn decode(bytes: &[u8]) -> Result<(String, Option<String>), SvgError> {
    let mut bytes = Cow::Borrowed(bytes);
    // Some servers pack what is packed.
    for _ in 0..MAX_PACKINGS {
        if !bytes.starts_with(&[0x1f, 0x8b]) {
            break;
        }
        let mut unpacked = Vec::new();
        let limit = MAX_TEXT_BYTES as u64 + 1;
        MultiGzDecoder::new(&*bytes)
            .take(limit)
            .read_to_end(&mut unpacked)
            .map_err(SvgError::Gzip)?;
        bytes = Cow::Owned(unpacked);
    }
    match utf32(&bytes) {
        Some(text) => Ok((text, None)),
        None => to_text(&bytes),
    }
}

/// Text of four bytes a character, which XML allows and encoding_rs leaves out; `None` for other texts.
fn utf32(bytes: &[u8]) -> Option<String> {
    let is_big = bytes.starts_with(b"\0\0\xfe\xff") || bytes.starts_with(b"\0\0\0<");
    let is_little = bytes.starts_with(b"\xff\xfe\0\0") || bytes.starts_with(b"<\0\0\0");
    if !is_big && !is_little || bytes.len() > MAX_TEXT_BYTES {
        return None;
    }
    let (words, _) = bytes.as_chunks::<4>();
    let code = |word: &[u8; 4]| {
        let code = if is_big { u32::from_be_bytes(*word) } else { u32::from_le_bytes(*word) };
        char::from_u32(code).unwrap_or(char::REPLACEMENT_CHARACTER)
    };
    let text: String = words.iter().map(code).collect();
    Some(text.trim_start_matches('\u{feff}').to_owned())
}

fn to_text(bytes: &[u8]) -> Result<(String, Option<String>), SvgError> {
    if bytes.len() > MAX_TEXT_BYTES {
        return Err(SvgError::TooLarge);
    }
    let (encoding, bytes) = match Encoding::for_bom(bytes) {
        Some((encoding, n)) => (encoding, &bytes[n..]),
        None if bytes.starts_with(b"<\0") => (UTF_16LE, bytes),
        None if bytes.starts_with(b"\0<") => (UTF_16BE, bytes),
        None => (declared(bytes)?, bytes),
    };
    let (text, has_errors) = encoding.decode_without_bom_handling(bytes);
    if !has_errors {
        return Ok((text.into_owned(), None));
    }
    if encoding == UTF_8 {
        // Old programs wrote the encoding of their system without declaring it. Only texts can be
        // affected: numbers and names of elements are ASCII.
        let (text, _) = WINDOWS_1252.decode_without_bom_handling(bytes);
        let warning = "the text is not UTF-8, and no other encoding is declared; \
                       read as Windows-1252";
        return Ok((text.into_owned(), Some(warning.to_owned())));
    }
    let warning = format!("some characters are not valid {}", encoding.name());
    Ok((text.into_owned(), Some(warning)))
}

/// The encoding that the XML declaration names; UTF-8 without one.
fn declared(bytes: &[u8]) -> Result<&'static Encoding, SvgError> {
    let start = &bytes[..bytes.len().min(DECLARATION_BYTES)];
    let start = String::from_utf8_lossy(start);
    let Some(declaration) = start.trim_start().strip_prefix("<?xml") else { return Ok(UTF_8) };
    let declaration = declaration.split("?>").next().unwrap_or_default();
    let Some((_, value)) = declaration.split_once("encoding") else { return Ok(UTF_8) };
    let value = value.trim_start().trim_start_matches('=').trim_start();
    let quote = value.chars().next().filter(|c| ['"', '\''].contains(c));
    let label = quote.and_then(|quote| value[1..].split(quote).next()).unwrap_or_default();
    match Encoding::for_label(label.as_bytes()) {
        // What can be read here as single bytes is not UTF-16, whatever it says.
        Some(encoding) if encoding == UTF_16LE || encoding == UTF_16BE => Ok(UTF_8),
        Some(encoding) => Ok(encoding),
        None => Err(SvgError::Encoding(label.chars().take(40).collect())),
    }
}
