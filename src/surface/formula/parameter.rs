//! Parameters of formulas: names with a fixed value.

use thiserror::Error;

use super::lexer::{Token, tokens};
use super::tape::{CONSTANTS, function};

/// Names that variables have in some formulas.
const VARIABLES: [&str; 6] = ["x", "y", "r", "theta", "u", "v"];

/// A name and its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    name: String,
    value: f64,
    text: String,
}

/// Why a name or a value cannot be a parameter.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ParameterError {
    /// Not letters and digits starting with a letter.
    #[error("`{0}` cannot name a parameter; use letters and digits, starting with a letter")]
    Name(String),
    /// A variable, constant, function or operator.
    #[error("`{0}` already has a meaning in formulas; use another name")]
    Taken(String),
    /// Infinite, or not a number.
    #[error("the value of `{0}` must be finite")]
    NotFinite(String),
    /// A list without values.
    #[error("a parameter needs a value")]
    NoValues,
    /// More than [`MAX_VALUES`](super::MAX_VALUES).
    #[error("parameters have more than {} values or combinations of values", super::MAX_VALUES)]
    TooMany,
    /// Steps that do not lead to the last value.
    #[error("the steps of `{0}` do not lead from its first to its last value")]
    Step(String),
    /// Two lists of values for one name.
    #[error("`{0}` is given two lists of values")]
    Twice(String),
}

/// Significant digits of values as written.
const DIGITS: usize = 10;

impl Parameter {
    /// A parameter for [`Formula::parse_with`](super::Formula::parse_with).
    ///
    /// # Errors
    /// See [`ParameterError`].
    pub fn new(name: &str, value: f64) -> Result<Self, ParameterError> {
        let of = |error: fn(String) -> ParameterError| Err(error(name.to_owned()));
        let is_plain = name.starts_with(|c: char| c.is_alphabetic());
        let is_plain = is_plain && name.chars().all(|c| c.is_alphanumeric() || c == '_');
        if !is_plain {
            return of(ParameterError::Name);
        }
        // Words such as `and` are operators, some letters stand for other names, and case does not count.
        let read = tokens(name).unwrap_or_default();
        let [Token::Name(known), _] = read.iter().map(|t| &t.token).collect::<Vec<_>>()[..] else {
            return of(ParameterError::Taken);
        };
        let is_constant = CONSTANTS.iter().any(|(constant, _)| constant == known);
        if is_constant || VARIABLES.contains(&known.as_str()) || function(known).is_some() {
            return of(ParameterError::Taken);
        }
        if !value.is_finite() {
            return of(ParameterError::NotFinite);
        }
        let rounded: f64 = format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value);
        Ok(Self { name: known.clone(), value, text: (rounded + 0.0).to_string() })
    }

    /// The same parameter with another text for its value, such as pi/2.
    #[must_use]
    pub fn written(self, text: &str) -> Self {
        Self { text: text.to_owned(), ..self }
    }

    /// The name, in lowercase: formulas are not case-sensitive.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The value.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// The value as text: at most ten digits, unless another text was set.
    pub fn text(&self) -> &str {
        &self.text
    }
}
