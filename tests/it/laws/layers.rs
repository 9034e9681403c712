//! The layout of the source: no stage imports a later one, and no files import each other in a circle.
//!
//! The order of the stages is that of the modules in `src/lib.rs`. A file may use what its own parents
//! define, as it is a part of them.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The imports of each module that is a file: from module to modules, as paths below the crate.
type Imports = BTreeMap<String, BTreeSet<String>>;

fn source() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    let mut folders = vec![(root, String::new())];
    while let Some((folder, module)) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
            let inner = if module.is_empty() { stem.clone() } else { format!("{module}::{stem}") };
            if path.is_dir() {
                folders.push((path, inner));
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let name = if stem == "mod" { module.clone() } else { inner };
                files.push((name, fs::read_to_string(&path).unwrap()));
            }
        }
    }
    files
}

/// The paths that a file names: in `use` items that are not re-exports, and inline from `crate::` on.
fn named_paths(text: &str) -> Vec<String> {
    let code: String = text
        .lines()
        .take_while(|line| line.trim() != "#[cfg(test)]")
        .map(|line| line.split("//").next().unwrap())
        .collect::<Vec<_>>()
        .join("\n");
    let mut paths = Vec::new();
    // Items begin a line, which words in a message do not.
    for item in format!("\n{code}").split(';') {
        let start = item.rfind("\nuse ").map(|at| at + 5);
        match start {
            Some(start) => expand("", &item[start..], &mut paths),
            None => {
                let is_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
                let inline = item.match_indices("crate::").map(|(at, _)| &item[at..]);
                let inline = inline.map(|rest| rest.split(|c| !is_path(c)).next().unwrap());
                // `hiddenline::` is the library as the program sees it, `pub(in crate::…)` no import.
                paths.extend(inline.map(|path| path.trim_end_matches(':').to_owned()));
            }
        }
    }
    paths
}

/// `a::{b, c::{d, e}}` as `a::b`, `a::c::d` and `a::c::e`.
fn expand(prefix: &str, tree: &str, paths: &mut Vec<String>) {
    let tree = tree.trim();
    let Some(open) = tree.find('{') else {
        let name = tree.split(" as ").next().unwrap().trim();
        paths.push(format!("{prefix}{name}"));
        return;
    };
    let prefix = format!("{prefix}{}", tree[..open].trim());
    let inner = tree[open + 1..].trim_end().strip_suffix('}').unwrap();
    let (mut depth, mut start) = (0, 0);
    for (at, c) in inner.char_indices().chain([(inner.len(), ',')]) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                if !inner[start..at].trim().is_empty() {
                    expand(&prefix, &inner[start..at], paths);
                }
                start = at + 1;
            }
            _ => {}
        }
    }
}

fn imports(files: &[(String, String)]) -> Imports {
    let modules: BTreeSet<&str> = files.iter().map(|(module, _)| module.as_str()).collect();
    let deepest = |segments: &[&str]| {
        let lengths = (1..=segments.len()).rev();
        let mut paths = lengths.map(|n| segments[..n].join("::"));
        paths.find(|path| modules.contains(path.as_str()))
    };
    let mut imports = Imports::new();
    for (module, text) in files.iter().filter(|(module, _)| module != "lib" && module != "main") {
        let own: Vec<&str> = module.split("::").collect();
        let found = imports.entry(module.clone()).or_default();
        for path in named_paths(text) {
            let mut segments: Vec<&str> = path.split("::").map(str::trim).collect();
            let mut base = match segments[0] {
                "crate" => Vec::new(),
                "self" | "super" => own.clone(),
                child if modules.contains(format!("{module}::{child}").as_str()) => own.clone(),
                _ => continue,
            };
            while let Some(first @ ("crate" | "self" | "super")) = segments.first().copied() {
                segments.remove(0);
                if first == "super" {
                    base.pop();
                }
            }
            base.extend(segments);
            found.extend(deepest(&base).filter(|other| other != module));
        }
    }
    imports
}

/// Modules in the order of `src/lib.rs`.
fn stages(files: &[(String, String)]) -> Vec<String> {
    let (_, text) = files.iter().find(|(module, _)| module == "lib").unwrap();
    let declared =
        text.lines().filter_map(|line| line.trim().strip_prefix("pub mod ")?.strip_suffix(';'));
    declared.map(str::to_owned).collect()
}

fn against_the_order(imports: &Imports, stages: &[String]) -> Vec<String> {
    let stage = |module: &str| stages.iter().position(|s| module.split("::").next() == Some(s));
    let pairs = imports.iter().flat_map(|(from, to)| to.iter().map(move |to| (from, to)));
    let wrong = pairs.filter(|(from, to)| stage(from).is_some() && stage(from) < stage(to));
    wrong.map(|(from, to)| format!("{from} -> {to}")).collect()
}

/// The modules that can be reached from themselves.
fn in_circles(imports: &Imports) -> Vec<String> {
    let is_part =
        |from: &str, to: &str| from.strip_prefix(to).is_some_and(|rest| rest.starts_with("::"));
    let reaches_itself = |start: &String| {
        let (mut open, mut seen) = (vec![start], BTreeSet::new());
        while let Some(module) = open.pop() {
            for next in imports.get(module).into_iter().flatten() {
                if is_part(module, next) {
                    continue;
                }
                if next == start {
                    return true;
                }
                if seen.insert(next) {
                    open.push(next);
                }
            }
        }
        false
    };
    imports.keys().filter(|module| reaches_itself(module)).cloned().collect()
}

#[test]
fn no_stage_imports_a_later_one() {
    let files = source();
    let stages = stages(&files);
    assert!(stages.len() > 12, "{stages:?}");
    let imports = imports(&files);
    assert!(imports.values().map(BTreeSet::len).sum::<usize>() > 300);
    assert_eq!(against_the_order(&imports, &stages), [""; 0]);
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    assert_eq!(in_circles(&imports(&source())), [""; 0]);
}

#[test]
fn both_laws_notice_what_breaks_them() {
    let file = |module: &str, text: &str| (module.to_owned(), text.to_owned());
    let files = [
        file("lib", "pub mod a;\n\npub mod b;\n#[cfg(feature = \"x\")]\npub mod c;\n"),
        file("a", "use crate::b::{self, Deep as D};\n"),
        file("b", "use glam::{DVec2,\n    DVec3};\nuse crate::{a::X, c::deep::{Y, Z}};\n"),
        file("c", "//! See [`crate::a`].\nuse self::deep::Y;\npub use crate::b;\n"),
        file("c::deep", "use super::Z;\nfn f() { crate::a::g(); }\n"),
    ];
    let found = imports(&files);
    assert_eq!(against_the_order(&found, &stages(&files)), ["a -> b", "b -> c::deep"]);
    assert_eq!(in_circles(&found), ["a", "b", "c::deep"]);
}
