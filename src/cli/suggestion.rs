//! "Did you mean": the end of a message about an unknown name.

/// How alike names are that one may have been typed for the other; Jaro-Winkler, at most 1.
const ALIKE: f64 = 0.75;

/// What may have been meant, and everything that there is, as the end of a message.
pub(super) fn suggestion<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.collect();
    let alike = |other: &str| strsim::jaro_winkler(&name.to_ascii_lowercase(), other);
    let mut near: Vec<&str> = known.iter().copied().filter(|k| alike(k) >= ALIKE).collect();
    near.sort_by(|a, b| alike(b).total_cmp(&alike(a)));
    near.truncate(3);
    let known = known.join(", ");
    match near.as_slice() {
        [] => format!("; there are {known}"),
        near => format!("; did you mean {}? There are {known}", near.join(" or ")),
    }
}
