//! Splits text into tokens, each with the column where it starts.

use super::{FormulaError, Problem};

/// A token of the formula language.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Token {
    Number(f64),
    Name(String),
    /// An operator or parenthesis, in its canonical spelling.
    Symbol(&'static str),
    /// An exponent in superscript digits, as in `x²`.
    Raised(f64),
    End,
}

/// A token and the column of its first character, counted from 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Placed {
    pub(super) token: Token,
    pub(super) column: usize,
}

impl Token {
    /// The token as an error message names it.
    pub(super) fn describe(&self) -> String {
        match self {
            Self::Number(value) => format!("the number {value}"),
            Self::Name(name) => format!("`{name}`"),
            Self::Symbol(symbol) => format!("`{symbol}`"),
            Self::Raised(value) => format!("the exponent {value}"),
            Self::End => "the end of the formula".to_owned(),
        }
    }
}

/// Longest spellings first, so that `<=` is not read as `<`.
const SYMBOLS: [(&str, &str); 29] = [
    ("**", "^"),
    ("<=", "<="),
    (">=", ">="),
    ("==", "=="),
    ("!=", "!="),
    ("&&", "&&"),
    ("||", "||"),
    ("≤", "<="),
    ("≥", ">="),
    ("≠", "!="),
    ("−", "-"),
    ("·", "*"),
    ("×", "*"),
    ("<", "<"),
    (">", ">"),
    ("=", "="),
    ("!", "!"),
    ("+", "+"),
    ("-", "-"),
    ("*", "*"),
    ("/", "/"),
    ("%", "%"),
    ("^", "^"),
    ("(", "("),
    (")", ")"),
    (",", ","),
    ("?", "?"),
    (":", ":"),
    ("π", "π"),
];

pub(super) fn tokens(text: &str) -> Result<Vec<Placed>, FormulaError> {
    let mut tokens = Vec::new();
    let mut rest = text;
    let mut column = 1;
    while let Some(first) = rest.chars().next() {
        let length = if first.is_whitespace() {
            first.len_utf8()
        } else if first.is_ascii_digit() || (first == '.' && starts_fraction(rest)) {
            let length = number_length(rest);
            let word = &rest[..length];
            // A number that overflows is an error, not an infinite constant.
            let value = fast_float2::parse::<f64, _>(word).ok().filter(|value| value.is_finite());
            let value = value.ok_or_else(|| FormulaError {
                column,
                problem: Problem::Number(word.to_owned()),
            })?;
            tokens.push(Placed { token: Token::Number(value), column });
            length
        } else if let Some((spelling, symbol)) =
            SYMBOLS.iter().find(|(spelling, _)| rest.starts_with(spelling))
        {
            let token =
                if *symbol == "π" { Token::Name("pi".to_owned()) } else { Token::Symbol(symbol) };
            tokens.push(Placed { token, column });
            spelling.len()
        } else if let Some((length, value)) = raised(rest) {
            tokens.push(Placed { token: Token::Raised(value), column });
            length
        } else if first.is_alphabetic() || first == '_' {
            let is_in_name =
                |c: char| (c.is_alphanumeric() || c == '_') && c != 'π' && !RAISED.contains(&c);
            let length = rest.find(|c: char| !is_in_name(c)).unwrap_or(rest.len());
            let token = match rest[..length].to_lowercase().as_str() {
                "and" => Token::Symbol("&&"),
                "or" => Token::Symbol("||"),
                "not" => Token::Symbol("!"),
                "θ" => Token::Name("theta".to_owned()),
                name => Token::Name(name.to_owned()),
            };
            tokens.push(Placed { token, column });
            length
        } else {
            return Err(FormulaError { column, problem: Problem::Character(first) });
        };
        column += rest[..length].chars().count();
        rest = &rest[length..];
    }
    if tokens.is_empty() {
        return Err(FormulaError { column: 1, problem: Problem::Empty });
    }
    tokens.push(Placed { token: Token::End, column });
    Ok(tokens)
}

/// Superscript digits from 0 to 9.
const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// The superscript exponent at the start of `text`, with its length in bytes.
fn raised(text: &str) -> Option<(usize, f64)> {
    let (digits, sign) = text.strip_prefix('⁻').map_or((text, 1.0), |digits| (digits, -1.0));
    let digit = |c: char| RAISED.iter().position(|raised| *raised == c);
    let end = digits.find(|c| digit(c).is_none()).unwrap_or(digits.len());
    let value = |value: f64, c| digit(c).map(|digit| value * 10.0 + digit as f64);
    let value = digits[..end].chars().try_fold(0.0, value).filter(|value| value.is_finite())?;
    (end > 0).then_some((text.len() - digits.len() + end, sign * value))
}

fn starts_fraction(text: &str) -> bool {
    text.as_bytes().get(1).is_some_and(u8::is_ascii_digit)
}

/// Length in bytes of the number at the start of `text`. An `e` is part of it only when digits follow.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |mut at: usize| {
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at
    };
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent_end = digits(end + 1 + sign);
        if exponent_end > end + 1 + sign {
            end = exponent_end;
        }
    }
    // `1.2.3` is one malformed number, not two numbers.
    while matches!(bytes.get(end), Some(b'.' | b'0'..=b'9')) {
        end += 1;
    }
    end
}
