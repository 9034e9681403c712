//! Names of sheets, as they are written in legends.

use super::formula::Parameter;

/// A formula with mathematical signs: − · ² for - * ^2.
pub fn typeset(formula: &str) -> String {
    let mut text = String::with_capacity(formula.len());
    let mut rest = formula;
    while let Some(character) = rest.chars().next() {
        let after = &rest[character.len_utf8()..];
        let power = after.trim_start().chars().next().filter(|_| character == '^');
        let goes_on = |c: char| c.is_alphanumeric() || c == '.' || c == '(';
        let is_whole = !after.trim_start().chars().nth(1).is_some_and(goes_on);
        match (character, power) {
            ('-', _) => text.push('−'),
            ('*', _) => text.push('·'),
            ('^', Some(digit @ '0'..='9')) if is_whole => {
                text.push(RAISED[digit as usize - '0' as usize]);
                rest = &after.trim_start()[1..];
                continue;
            }
            _ => text.push(character),
        }
        rest = after;
    }
    text
}

/// Digits as exponents.
const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// The values of parameters, as in a = 1, b = −2.
pub fn name_of_values(parameters: &[Parameter]) -> String {
    let of = |p: &Parameter| format!("{} = {}", p.name(), typeset(p.text()));
    parameters.iter().map(of).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_written_with_mathematical_signs() {
        assert_eq!(typeset("-2*x^2 - y^3"), "−2·x² − y³");
        // Powers that are more than a digit keep their sign.
        assert_eq!(typeset("x^12 + x^2.5 + x^(1/2) + x^n"), "x^12 + x^2.5 + x^(1/2) + x^n");
        assert_eq!(typeset("x^ 2^y"), "x²^y");
        assert_eq!(typeset("x^-1"), "x^−1");
        assert_eq!(typeset(""), "");
        let a = Parameter::new("a", -0.5).expect("a parameter");
        let b = Parameter::new("b", 1.0 / 3.0).expect("a parameter");
        assert_eq!(name_of_values(&[a, b]), "a = −0.5, b = 0.3333333333");
    }
}
