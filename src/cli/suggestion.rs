//! "Did you mean": known names that resemble an unknown one.

/// Names at least this much like an unknown one are suggested (Jaro-Winkler similarity).
const ALIKE: f64 = 0.75;

/// The end of a message about an unknown name: what may have been meant, and all known names.
pub(super) fn suggestion<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.collect();
    let near = near(name, &known);
    let known = known.join(", ");
    if near.is_empty() {
        format!("; choose from {known}")
    } else {
        format!("; did you mean {}? Choose from {known}", near.join(" or "))
    }
}

/// The known names most like `name`, the best first: at most three, often none.
pub(super) fn near<'a>(name: &str, known: &[&'a str]) -> Vec<&'a str> {
    let alike = |other: &str| strsim::jaro_winkler(&name.to_ascii_lowercase(), other);
    let mut near: Vec<&str> = known.iter().copied().filter(|k| alike(k) >= ALIKE).collect();
    near.sort_by(|a, b| alike(b).total_cmp(&alike(a)));
    near.truncate(3);
    near
}
