//! A line of text as letters: accents, superscripts, subscripts, and look-alikes.
//!
//! ```text
//!   ω in rad s⁻¹      −1 raised: characters of their own
//!   x_{max}           max lowered: braces after `_` or `^`
//! ```

use super::letters::{Accent, combining, split};

/// Whether a letter stands on the line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Script {
    OnLine,
    Raised,
    Lowered,
}

/// A letter as the font draws it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Letter {
    /// The plain letter, without its accent.
    pub(super) character: char,
    pub(super) accent: Option<Accent>,
    pub(super) script: Script,
}

/// The letters of a line. `^{…}` raises and `_{…}` lowers what is between the braces, up to the first
/// closing one; without a closing brace the characters stand for themselves.
pub(super) fn letters(line: &str) -> Vec<Letter> {
    let mut letters: Vec<Letter> = Vec::with_capacity(line.len());
    let mut rest = line;
    while let Some(character) = rest.chars().next() {
        let braces = match character {
            '^' => Script::Raised,
            '_' => Script::Lowered,
            _ => Script::OnLine,
        };
        let after = &rest[character.len_utf8()..];
        if braces != Script::OnLine
            && let Some((inner, outside)) = after.strip_prefix('{').and_then(|t| t.split_once('}'))
        {
            inner.chars().for_each(|c| push(&mut letters, c, braces));
            rest = outside;
        } else {
            push(&mut letters, character, Script::OnLine);
            rest = after;
        }
    }
    letters
}

/// Adds a character; a combining accent goes to the letter before it.
fn push(letters: &mut Vec<Letter>, character: char, script: Script) {
    if let Some(accent) = combining(character)
        && let Some(last) = letters.last_mut().filter(|last| last.accent.is_none())
    {
        last.accent = Some(accent);
        return;
    }
    let (character, accent) = match split(character) {
        Some((plain, accent)) => (plain, Some(accent)),
        None => (character, None),
    };
    let (character, script) = match raised_or_lowered(character) {
        Some((plain, own)) if script == Script::OnLine => (plain, own),
        Some((plain, _)) => (plain, script),
        None => (look_alike(character), script),
    };
    letters.push(Letter { character, accent, script });
}

/// The plain letter of a raised or lowered character.
fn raised_or_lowered(character: char) -> Option<(char, Script)> {
    let find = |all: &str, plain: &str, script| {
        let place = all.chars().position(|c| c == character)?;
        Some((plain.chars().nth(place)?, script))
    };
    find("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ⁿⁱ", "0123456789+−ni", Script::Raised)
        .or_else(|| find("₀₁₂₃₄₅₆₇₈₉₊₋ᵢⱼₙₓ", "0123456789+−ijnx", Script::Lowered))
}

/// The character that is drawn for one that looks the same.
fn look_alike(character: char) -> char {
    const ALIKE: [(&str, &str); 2] = [
        ("‐‑–—‘’´′“”„″μ⋅∑∏∆\u{2126}", "--−−\'\'\'\'\"\"\"\"µ·ΣΠΔΩ"),
        ("οΟυΑΒΕΖΗΙΚΜΝΡΤΥΧςϑϕϵ", "oOuABEZHIKMNPTYXσθφε"),
    ];
    if character.is_whitespace() {
        return ' ';
    }
    let find = |(from, to): &(&str, &str)| {
        let place = from.chars().position(|c| c == character)?;
        to.chars().nth(place)
    };
    ALIKE.iter().find_map(find).unwrap_or(character)
}

#[cfg(test)]
mod tests {
    use super::*;
    use Script::*;

    fn scripts(line: &str) -> Vec<(char, Script)> {
        letters(line).iter().map(|letter| (letter.character, letter.script)).collect()
    }

    #[test]
    fn braces_raise_and_lower_what_is_between_them() {
        let raised = [('s', OnLine), ('−', Raised), ('1', Raised), ('x', OnLine)];
        assert_eq!(scripts("s^{−1}x"), raised);
        assert_eq!(scripts("s⁻¹x"), raised);
        assert_eq!(scripts("x_{in}"), [('x', OnLine), ('i', Lowered), ('n', Lowered)]);
        assert_eq!(scripts("xᵢ"), [('x', OnLine), ('i', Lowered)]);
    }

    #[test]
    fn other_carets_and_braces_stand_for_themselves() {
        for line in ["x^2", "a_b", "^{", "_{abc", "{}", "a^"] {
            let plain: Vec<_> = line.chars().map(|c| (c, OnLine)).collect();
            assert_eq!(scripts(line), plain, "{line}");
        }
        assert_eq!(scripts("a^{}b"), [('a', OnLine), ('b', OnLine)]);
    }

    #[test]
    fn raised_letters_keep_their_accents() {
        let accented = letters("x^{é}");
        assert_eq!(accented[1].script, Raised);
        assert!(accented[1].accent.is_some());
        assert_eq!(letters("x^{e\u{301}}"), accented);
    }
}
