//! The files around glTF: GLB chunks, and the buffers that the JSON names.
//!
//! ```text
//!  GLB: "glTF" │ version 2 │ length │ n │ "JSON" │ n bytes │ n │ "BIN\0" │ n bytes
//! ```

use std::borrow::Cow;
use std::io::Read as _;
use std::path::{Component, Path, PathBuf};

use base64::Engine as _;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};
use gltf_json::{Buffer, Root};

use crate::read::error::Fault;
use crate::read::text::{decode, shown};

const MAGIC: &[u8] = b"glTF";
const HEADER: usize = 12;

/// Base64 as data URIs have it, with or without padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Whether bytes are a GLB file, or JSON in whose beginning glTF's one required member stands.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    let text = decode(bytes);
    let start = &text[..text.len().min(1 << 16)];
    bytes.starts_with(MAGIC)
        || start.trim_ascii_start().starts_with(b"{")
            && start.windows(7).any(|window| window == b"\"asset\"")
}

/// The JSON, and the binary chunk of a GLB file.
pub(super) fn open(bytes: &[u8]) -> Result<(Root, Option<&[u8]>), Fault> {
    let (text, chunk) = match chunks(bytes)? {
        Some((json, chunk)) => (Cow::Borrowed(json), chunk),
        None => (decode(bytes), None),
    };
    let root = Root::from_slice(&text).map_err(|error| Fault::Gltf(error.to_string()))?;
    if !root.asset.version.starts_with("2.") {
        let version = shown(root.asset.version.as_bytes());
        return Err(Fault::Gltf(format!("version {version}, not 2.0")));
    }
    Ok((root, chunk))
}

/// What a GLB file holds: its JSON, and its binary chunk if it has one.
type Chunks<'a> = (&'a [u8], Option<&'a [u8]>);

/// Splits a GLB file; `None` for other files.
fn chunks(bytes: &[u8]) -> Result<Option<Chunks<'_>>, Fault> {
    if !bytes.starts_with(MAGIC) {
        return Ok(None);
    }
    let word =
        |at: usize| bytes.get(at..at + 4)?.first_chunk::<4>().map(|b| u32::from_le_bytes(*b));
    if let Some(version) = word(4).filter(|&version| version != 2) {
        return Err(Fault::Gltf(format!("GLB version {version}, not 2")));
    }
    let (mut json, mut binary) = (None, None);
    let mut at = HEADER;
    while let (Some(length), Some(kind)) = (word(at), word(at + 4)) {
        let end = (at + 8).checked_add(length as usize).filter(|&end| end <= bytes.len());
        let Some(end) = end else {
            return Err(Fault::Truncated {
                expected: format!("a chunk of {length} bytes"),
                found: format!("there are {}", bytes.len() - at - 8),
            });
        };
        let chunk = &bytes[at + 8..end];
        match &kind.to_le_bytes() {
            b"JSON" if json.is_none() => json = Some(chunk),
            b"BIN\0" if binary.is_none() => binary = Some(chunk),
            _ => {}
        }
        // Chunks are padded to four bytes; some programs do not count the padding.
        at = end.next_multiple_of(4);
    }
    let json = json.ok_or_else(|| Fault::Truncated {
        expected: "a JSON chunk".to_owned(),
        found: "there is none".to_owned(),
    })?;
    Ok(Some((json, binary)))
}

/// The contents of all buffers.
pub(super) fn buffers<'a>(
    root: &Root,
    chunk: Option<&'a [u8]>,
    folder: Option<&Path>,
) -> Result<Vec<Cow<'a, [u8]>>, Fault> {
    let buffers = root.buffers.iter().enumerate();
    buffers
        .map(|(index, buffer)| match (&buffer.uri, chunk) {
            (Some(uri), _) => match uri.strip_prefix("data:") {
                Some(data) => from_data(index, data).map(Cow::Owned),
                None => from_file(buffer, uri, folder).map(Cow::Owned),
            },
            (None, Some(chunk)) if index == 0 => Ok(Cow::Borrowed(chunk)),
            // Compressed files have such a buffer; nothing may read from it.
            (None, _) => Ok(Cow::Borrowed(&[][..])),
        })
        .collect()
}

/// A buffer within the JSON, after `data:`.
fn from_data(index: usize, data: &str) -> Result<Vec<u8>, Fault> {
    let no_base64 = || Fault::Gltf(format!("buffer {index} is a data URI that is not base64"));
    let (kind, content) = data.split_once(',').ok_or_else(no_base64)?;
    if !kind.ends_with(";base64") {
        return Err(no_base64());
    }
    BASE64.decode(content.trim()).map_err(|_| no_base64())
}

/// A buffer in a separate file, which has to be in the model's folder or below.
fn from_file(buffer: &Buffer, uri: &str, folder: Option<&Path>) -> Result<Vec<u8>, Fault> {
    let name = shown(uri.as_bytes());
    let relative = local_path(uri).ok_or_else(|| Fault::BufferElsewhere(name.clone()))?;
    let folder = folder.ok_or_else(|| Fault::BufferWithoutFolder(name.clone()))?;
    let missing = |error: std::io::Error| Fault::MissingBuffer { name: name.clone(), error };
    let path = folder.join(relative);
    if !path.metadata().map_err(missing)?.is_file() {
        return Err(missing(std::io::ErrorKind::IsADirectory.into()));
    }
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(missing)?;
    file.take(buffer.byte_length.0).read_to_end(&mut bytes).map_err(missing)?;
    Ok(bytes)
}

/// The path that a URI means, if it leads nowhere but into the folder that it starts from.
fn local_path(uri: &str) -> Option<PathBuf> {
    let path = PathBuf::from(unescape(uri)?);
    let scheme = uri.split(['/', '?', '#']).next().is_some_and(|first| first.contains(':'));
    let is_within = path.components().all(|step| matches!(step, Component::Normal(_)));
    let has_odd_bytes = path.to_str().is_none_or(|path| path.contains(['\\', '\0']));
    (!scheme && is_within && !has_odd_bytes && path.components().next().is_some()).then_some(path)
}

/// A URI with its `%20` and the like decoded; `None` when they are not UTF-8.
fn unescape(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let hex = after.get(..2).and_then(|hex| std::str::from_utf8(hex).ok());
        let code = hex.filter(|hex| hex.bytes().all(|b| b.is_ascii_hexdigit()));
        let code = code.and_then(|hex| u8::from_str_radix(hex, 16).ok());
        match code.filter(|_| first == b'%') {
            Some(code) => {
                bytes.push(code);
                rest = &after[2..];
            }
            None => {
                bytes.push(first);
                rest = after;
            }
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_paths_within_the_folder_are_local() {
        for (uri, path) in
            [("a.bin", "a.bin"), ("sub/b%20c.bin", "sub/b c.bin"), ("100%.bin", "100%.bin")]
        {
            assert_eq!(local_path(uri), Some(PathBuf::from(path)), "{uri}");
        }
        for uri in [
            "../a.bin",
            "sub/../../a",
            "%2e%2e/a",
            "/etc/passwd",
            "%2Fetc",
            "http://x/a",
            "file:a",
            "C:\\a",
            "..\\a",
            "",
            ".",
            "a%00b",
            "%ff",
            "//server/share",
        ] {
            assert_eq!(local_path(uri), None, "{uri}");
        }
    }
}
