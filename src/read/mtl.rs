//! MTL, the material files of OBJ: the diffuse color of each material.
//!
//! tobj reads MTL files too, but it rejects the whole file at the first bad line, and some lines make
//! it panic (`Kd 0.5`). A drawing needs only two records, `newmtl` and `Kd`, so they are read here,
//! line by line: nothing else in a file can do harm, and a bad line costs only its own color.

use std::collections::{BTreeMap, BTreeSet};

use super::text::{Words, name, number, shown};

/// Warnings about one file at most; the rest are counted.
const MOST_WARNINGS: usize = 5;

/// Colors by the names of materials.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MaterialFile {
    /// Red, green and blue of `Kd`, taken for sRGB as they are, for the materials that have one.
    pub colors: BTreeMap<String, [u8; 3]>,
    /// The names of all materials.
    pub names: BTreeSet<String>,
    /// Lines that could not be read, counted from 1, and what is wrong with each.
    pub warnings: Vec<(usize, String)>,
}

/// Reads MTL text in any encoding that model files come in.
pub fn read_materials(bytes: &[u8]) -> MaterialFile {
    let text = super::text::decode(bytes);
    let mut words = Words::new(&text, None);
    let mut file = MaterialFile::default();
    let mut material: Option<String> = None;
    let mut n_bad = 0;
    loop {
        let line = words.line();
        let problem = match words.next_on_line() {
            Some(word) if word.eq_ignore_ascii_case(b"newmtl") => {
                let name = words_of_name(&mut words);
                file.names.insert(name.clone());
                material = Some(name);
                None
            }
            Some(word) if word.eq_ignore_ascii_case(b"Kd") => {
                match (diffuse(&mut words), &material) {
                    (Ok((color, is_in_range)), Some(material)) => {
                        file.colors.insert(material.clone(), color);
                        (!is_in_range).then(|| {
                            "numbers of Kd go from 0 to 1; those beyond are taken as 0 or 1"
                                .to_owned()
                        })
                    }
                    (Ok(_), None) => Some("`Kd` before the first `newmtl` is ignored".to_owned()),
                    (Err(problem), _) => Some(problem),
                }
            }
            _ => None,
        };
        if let Some(problem) = problem {
            n_bad += 1;
            if n_bad <= MOST_WARNINGS {
                file.warnings.push((line, problem));
            }
        }
        if !words.skip_line() {
            break;
        }
    }
    if n_bad > MOST_WARNINGS
        && let Some((_, last)) = file.warnings.last_mut()
    {
        *last = format!("{last} ({} more lines like this)", n_bad - MOST_WARNINGS);
    }
    file
}

/// The color of the numbers after `Kd`, and whether all are in range; a single one is a gray.
fn diffuse(words: &mut Words<'_>) -> Result<([u8; 3], bool), String> {
    let mut parts = Vec::with_capacity(3);
    while let Some(word) = words.next_on_line().filter(|word| word.first() != Some(&b'#')) {
        if matches!(word, b"xyz" | b"spectral") {
            return Err(format!(
                "`Kd {}` is not supported; write Kd as red, green, blue",
                name(word)
            ));
        }
        match number(word) {
            Ok(part) if parts.len() < 3 => parts.push(part),
            Ok(_) => break,
            Err(_) if parts.len() >= 3 => break,
            Err(_) => return Err(format!("`{}` in Kd is not a number", shown(word))),
        }
    }
    let is_in_range = parts.iter().all(|part| (0.0..=1.0).contains(part));
    match parts[..] {
        [gray] => Ok((super::parts::color_of_parts([gray; 3]), is_in_range)),
        [red, green, blue] => Ok((super::parts::color_of_parts([red, green, blue]), is_in_range)),
        _ => Err(format!("three numbers expected for Kd, {} found", parts.len())),
    }
}

/// The words left on this line, one blank between them, as OBJ files refer to them.
pub(super) fn words_of_name(words: &mut Words<'_>) -> String {
    let mut joined = Vec::new();
    while let Some(word) = words.next_on_line().filter(|word| word.first() != Some(&b'#')) {
        if !joined.is_empty() {
            joined.push(b' ');
        }
        joined.extend_from_slice(word);
    }
    name(&joined)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn colors(text: &str) -> Vec<(String, [u8; 3])> {
        read_materials(text.as_bytes()).colors.into_iter().collect()
    }

    #[test]
    fn only_names_and_diffuse_colors_count() {
        let text = "# comment\nnewmtl  red  one # note\n\tKa 0 0 0\nKd 1 0 0.5\nmap_Kd \"no such.png\"\n\
                    Ni what\nd\nTr x\nillum 99\r\nnewmtl gray\rKd 0.25\rnewmtl none\r\nnewmtl big\nKd 2 -1 0";
        let expected = [
            ("big".to_owned(), [255, 0, 0]),
            ("gray".to_owned(), [64, 64, 64]),
            ("red one".to_owned(), [255, 0, 128]),
        ];
        assert_eq!(colors(text), expected);
        let beyond = "numbers of Kd go from 0 to 1; those beyond are taken as 0 or 1";
        assert_eq!(read_materials(text.as_bytes()).warnings, [(14, beyond.to_owned())]);
    }

    #[test]
    fn a_bad_line_costs_its_own_color_only() {
        for (line, problem) in [
            ("Kd 0.5 1", "three numbers expected for Kd, 2 found"),
            ("Kd", "three numbers expected for Kd, 0 found"),
            ("kd 0.5 1", "three numbers expected for Kd, 2 found"),
            ("Kd a b c", "`a` in Kd is not a number"),
            ("Kd 1 nan 0", "`nan` in Kd is not a number"),
            ("Kd spectral x.rfl", "`Kd spectral` is not supported; write Kd as red, green, blue"),
        ] {
            let text = format!("newmtl a\nKd 1 0 0\nnewmtl odd\n{line}\nnewmtl b\nKd 0 0 1\n");
            let file = read_materials(text.as_bytes());
            assert_eq!(file.warnings, [(4, problem.to_owned())]);
            let expected = [("a".to_owned(), [255, 0, 0]), ("b".to_owned(), [0, 0, 255])];
            assert_eq!(file.colors.into_iter().collect::<Vec<_>>(), expected);
        }
        let early = read_materials(b"Kd 1 0 0\nnewmtl a\n");
        assert_eq!(early.warnings, [(1, "`Kd` before the first `newmtl` is ignored".to_owned())]);
        let many = read_materials("newmtl a\nKd x\n".repeat(100).as_bytes());
        assert_eq!(many.warnings.len(), MOST_WARNINGS);
        assert_eq!(many.warnings[4].1, "`x` in Kd is not a number (95 more lines like this)");
    }

    #[test]
    fn text_may_be_utf_16() {
        let utf16: Vec<u8> =
            "\u{FEFF}newmtl é\nKd 0 1 0".encode_utf16().flat_map(u16::to_le_bytes).collect();
        let colors = read_materials(&utf16).colors;
        assert_eq!(colors.get("é"), Some(&[0, 255, 0]));
    }
}
