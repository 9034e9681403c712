//! Names of outputs that change from drawing to drawing.

use std::path::{Path, PathBuf};

use super::paths::is_dash;

/// The name of an output, with places for what changes from drawing to drawing.
///
/// `{stem}` is the name of the model without its extension, `{dir}` its folder, `{index}` the number of
/// the drawing, from 1; `{index:03}` writes it with three digits. All else stays as it is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct NameTemplate {
    parts: Vec<Part>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Part {
    Text(String),
    Stem,
    Folder,
    Index { n_digits: usize },
}

impl Part {
    /// What stands between braces.
    fn new(name: &str) -> Option<Self> {
        match name {
            "stem" => Some(Self::Stem),
            "dir" => Some(Self::Folder),
            "index" => Some(Self::Index { n_digits: 0 }),
            _ => {
                let n_digits = name.strip_prefix("index:")?.parse().ok()?;
                (n_digits <= 20).then_some(Self::Index { n_digits })
            }
        }
    }
}

impl NameTemplate {
    /// The template that a path stands for.
    pub(super) fn new(path: &Path) -> Self {
        // A path that is not text has no places to fill, or loses nothing that can be typed.
        let path = path.to_string_lossy();
        let (mut parts, mut text, mut rest) = (Vec::new(), String::new(), &*path);
        while let Some(open) = rest.find('{') {
            text.push_str(&rest[..open]);
            let close = rest[open..].find('}').map(|close| open + close);
            let part = close.and_then(|close| Some((Part::new(&rest[open + 1..close])?, close)));
            match part {
                Some((part, close)) => {
                    parts.push(Part::Text(std::mem::take(&mut text)));
                    parts.push(part);
                    rest = &rest[close + 1..];
                }
                None => {
                    text.push('{');
                    rest = &rest[open + 1..];
                }
            }
        }
        text.push_str(rest);
        parts.push(Part::Text(text));
        Self { parts }
    }

    /// Whether anything changes from drawing to drawing.
    pub(super) fn has_places(&self) -> bool {
        self.parts.iter().any(|part| !matches!(part, Part::Text(_)))
    }

    /// The same with the number of the drawing before the extension, unless it is somewhere already:
    /// `NAME.svg` becomes `NAME-001.svg`.
    #[must_use]
    pub(super) fn numbered(mut self) -> Self {
        if self.parts.iter().any(|part| matches!(part, Part::Index { .. })) {
            return self;
        }
        if let Some(Part::Text(last)) = self.parts.pop() {
            let name = last.rfind(std::path::is_separator).map_or(0, |slash| slash + 1);
            // A dot at the start of a name begins no extension.
            let starts_name = |dot: usize| dot == name && (name > 0 || self.parts.is_empty());
            let dot = last.rfind('.').filter(|&dot| dot >= name && !starts_name(dot));
            let (stem, extension) = last.split_at(dot.unwrap_or(last.len()));
            self.parts.push(Part::Text(format!("{stem}-")));
            self.parts.push(Part::Index { n_digits: 3 });
            self.parts.push(Part::Text(extension.to_owned()));
        }
        self
    }

    /// The name of the drawing of `model` that has number `index`.
    pub(super) fn name(&self, model: &Path, index: usize) -> PathBuf {
        let mut name = String::new();
        for part in &self.parts {
            match part {
                Part::Text(text) => name.push_str(text),
                Part::Stem if is_dash(model) => name.push_str("stdin"),
                Part::Stem => {
                    name.push_str(&model.file_stem().unwrap_or_default().to_string_lossy());
                }
                Part::Folder => match model.parent().map(Path::to_string_lossy) {
                    Some(folder) if !folder.is_empty() => name.push_str(&folder),
                    _ => name.push('.'),
                },
                Part::Index { n_digits } => name.push_str(&format!("{index:0n_digits$}")),
            }
        }
        name.into()
    }
}

#[cfg(test)]
mod tests {
    use super::NameTemplate;
    use std::path::Path;

    fn name(template: &str, model: &str, index: usize) -> String {
        let name = NameTemplate::new(Path::new(template)).name(Path::new(model), index);
        name.to_string_lossy().into_owned()
    }

    fn numbered(template: &str) -> String {
        let template = NameTemplate::new(Path::new(template)).numbered();
        template.name(Path::new("in/cow.obj"), 7).to_string_lossy().into_owned()
    }

    #[test]
    fn places_in_a_name_are_filled() {
        assert_eq!(name("out/{stem}-{index:03}.svg", "in/cow.v2.obj", 7), "out/cow.v2-007.svg");
        assert_eq!(name("{dir}/{stem}.svg", "cow.obj", 1), "./cow.svg");
        assert_eq!(name("{dir}/{index}.svg", "/a/b/cow.obj", 12), "/a/b/12.svg");
        assert_eq!(name("{index:2}.svg", "-", 1234), "1234.svg");
        assert_eq!(name("{stem}.svg", "-", 1), "stdin.svg");
        assert_eq!(name("{a}{{stem}}{index:x}{.svg", "cow.obj", 1), "{a}{cow}{index:x}{.svg");
    }

    #[test]
    fn a_name_without_number_gets_one_before_its_extension() {
        assert_eq!(numbered("a.b/cow.svg"), "a.b/cow-007.svg");
        assert_eq!(numbered("a.b/cow"), "a.b/cow-007");
        assert_eq!(numbered("{stem}.svg"), "cow-007.svg");
        assert_eq!(numbered("x/.svg"), "x/.svg-007");
        assert_eq!(numbered("f{index}.svg"), "f7.svg");
    }
}
