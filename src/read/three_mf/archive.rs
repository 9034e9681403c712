//! The ZIP archive around a 3MF model.

use std::io::{Cursor, Read};

use zip::ZipArchive;
use zip::result::ZipError;

use crate::read::error::Fault;

/// The most bytes of XML that are unpacked: parsing takes about eight times as much.
const MOST_UNPACKED: u64 = 1 << 28;

/// How many times longer XML may be than its packed form. Lists of numbers pack to a quarter or a tenth;
/// only malicious files pack to a hundredth.
const MOST_TIMES_LONGER: u64 = 100;

/// This many bytes may always be unpacked.
const FREE: u64 = 1 << 22;

/// What points to the model, by the last step of its type.
const MODEL_TYPE: &str = "/3dmodel";

/// An archive whose parts are read one by one.
pub(super) struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    n_packed: u64,
    n_unpacked: u64,
}

impl<'a> Archive<'a> {
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, Fault> {
        let zip = ZipArchive::new(Cursor::new(bytes)).map_err(fault)?;
        Ok(Self { zip, n_packed: bytes.len() as u64, n_unpacked: 0 })
    }

    /// The name of the part that holds the build items.
    pub(super) fn root_part(&mut self) -> Result<String, Fault> {
        const USUAL: &str = "3D/3dmodel.model";
        if let Ok(relationships) = self.read("_rels/.rels")
            && let Ok(document) = roxmltree::Document::parse(&relationships)
        {
            let target = document
                .descendants()
                .find(|node| node.attribute("Type").is_some_and(|kind| kind.ends_with(MODEL_TYPE)))
                .and_then(|node| node.attribute("Target"));
            if let Some(target) = target {
                return Ok(target.trim_start_matches('/').to_owned());
            }
        }
        if self.zip.index_for_name(USUAL).is_some() {
            return Ok(USUAL.to_owned());
        }
        Err(Fault::ThreeMf("there is no 3D model in the archive".to_owned()))
    }

    /// Unpacks a part that is text.
    pub(super) fn read(&mut self, name: &str) -> Result<String, Fault> {
        let allowed = MOST_UNPACKED.min(FREE + MOST_TIMES_LONGER * self.n_packed);
        let left = allowed.saturating_sub(self.n_unpacked);
        let file = self.zip.by_name(name).map_err(|error| match error {
            ZipError::FileNotFound => Fault::ThreeMf(format!("part {name} is missing")),
            other => fault(other),
        })?;
        let mut bytes = Vec::new();
        let read = file.take(left + 1).read_to_end(&mut bytes);
        self.n_unpacked += bytes.len() as u64;
        if bytes.len() as u64 > left {
            return Err(Fault::TooMuchUnpacked);
        }
        read.map_err(|error| Fault::ThreeMf(format!("part {name} is damaged: {error}")))?;
        let text = crate::read::text::decode(&bytes);
        String::from_utf8(text.into_owned())
            .map_err(|_| Fault::ThreeMf(format!("part {name} is not text")))
    }
}

fn fault(error: ZipError) -> Fault {
    Fault::ThreeMf(error.to_string())
}
