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
}

/// Why a name or a value makes no parameter.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ParameterError {
    /// Not letters and digits that begin with a letter.
    #[error("`{0}` cannot name a parameter; take letters and digits that begin with a letter")]
    Name(String),
    /// A variable, constant, function or operator.
    #[error("`{0}` has a meaning in formulas already; take another name")]
    Taken(String),
    /// Infinite, or not a number.
    #[error("the value of `{0}` must be finite")]
    NotFinite(String),
}

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
        Ok(Self { name: known.clone(), value })
    }

    /// The name, in lowercase: formulas do not tell cases apart.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The value.
    pub fn value(&self) -> f64 {
        self.value
    }
}
