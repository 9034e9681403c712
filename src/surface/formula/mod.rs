//! Formulas: text such as `sin(x) * exp(-y^2)`, parsed once and evaluated many times.
//!
//! ```text
//!   text ─► tokens ─► operator precedence ─► postfix tape ─► values, a block of samples at a time
//! ```
//!
//! We wrote our own because no crate we tried handles `-x^2` (minus the square), `2^3^2` (512), `1e3`,
//! error columns and hostile nesting all at once: exmex, fasteval2, meval, evalexpr and fidget each
//! fail at least one. Elementary functions come from `libm`, so a formula gives the same bits on every
//! machine.
//!
//! # Language
//!
//! Operators from lowest to highest precedence: `c ? a : b`; `||` or `or`; `&&` or `and`;
//! `< <= > >= == !=`; `+ -`; `* / %`; unary `- + !` or `not`; `^` or `**` (right-associative; `-x^2` is
//! `-(x^2)`), or superscript digits as in `x²`.
//!
//! True is 1 and false is 0. In a condition, 0 and NaN are false and every other number is true. The
//! result of `%` and `mod` has the sign of the divisor. Both branches of a condition may be evaluated,
//! but only the selected value is used. For names see [`FUNCTIONS`] and [`CONSTANTS`].

mod function;
mod interval;
mod jet;
mod jet_graph;
mod lexer;
mod parameter;
mod parameter_list;
mod parser;
mod tape;

pub use interval::Interval;
pub use jet::{Class, Jet};
pub use jet_graph::{Axis, JetGraph, JetLine};
pub use parameter::{Parameter, ParameterError};
pub use parameter_list::{MAX_VALUES, ParameterList};
pub use tape::{CONSTANTS, FUNCTIONS};

use lexer::Token;
use tape::{Op, Tape};
use thiserror::Error;

/// Maximum length of a formula in bytes.
pub const MAX_LENGTH: usize = 20_000;

/// Maximum nesting depth of parentheses, functions, signs and powers.
pub const MAX_DEPTH: usize = 200;

/// The names of the two variables of a formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variables {
    /// `x` and `y`; also `r`, the distance from the origin, and `theta`, the angle from the x axis in
    /// radians, from −π to π.
    Plane,
    /// `u` and `v`, the parameters of a surface in space.
    Parameters,
}

/// A parsed formula of two variables.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    tape: Tape,
    text: String,
}

/// A syntax error in a formula.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("column {column}: {problem}")]
pub struct FormulaError {
    /// The character where parsing stopped, counted from 1.
    pub column: usize,
    /// What is wrong there.
    pub problem: Problem,
}

/// The kinds of [`FormulaError`].
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Problem {
    /// The text is blank.
    #[error("the formula is empty")]
    Empty,
    /// More than [`MAX_LENGTH`] bytes.
    #[error("the formula is longer than {MAX_LENGTH} bytes")]
    TooLong,
    /// More than [`MAX_DEPTH`] levels.
    #[error("the formula is nested more than {MAX_DEPTH} levels deep")]
    TooDeep,
    /// A character that is not part of the language.
    #[error("`{0}` is not allowed in a formula")]
    Character(char),
    /// A malformed or overflowing number.
    #[error("`{0}` is not a valid number")]
    Number(String),
    /// A name that is not a variable, constant or function.
    #[error("unknown name `{name}`{}", hint(.near))]
    UnknownName {
        /// The name as written.
        name: String,
        /// The known name with the closest spelling, or the product it looks like.
        near: Option<String>,
    },
    /// A value was expected.
    #[error("expected a value but found {0}")]
    ExpectedValue(String),
    /// An operator or the end was expected.
    #[error("expected an operator but found {0}")]
    ExpectedOperator(String),
    /// Two adjacent values, as in `2x`.
    #[error("expected an operator but found {found}; write a product as `{left}*{right}`")]
    MissingTimes {
        /// Description of the second value.
        found: String,
        /// The first value.
        left: String,
        /// The second value.
        right: String,
    },
    /// A single `=`.
    #[error("`=` is not an operator; write a condition with `==`, `<=` or `>=`")]
    SingleEquals,
    /// An equation such as `z = …`.
    #[error("a formula is only the right-hand side; leave out `{0} =`")]
    Assignment(String),
    /// A required token is missing.
    #[error("expected {expected} but found {found}")]
    Expected {
        /// The token expected here.
        expected: &'static str,
        /// The token found instead.
        found: String,
    },
    /// A function name without parentheses.
    #[error("`{0}` is a function: write `{0}(…)`")]
    FunctionNeedsArguments(&'static str),
    /// The wrong number of arguments.
    #[error("`{name}` takes {takes}, not {given}")]
    ArgumentCount {
        /// The function.
        name: &'static str,
        /// How many arguments it takes, in words.
        takes: &'static str,
        /// How many arguments were given.
        given: usize,
    },
    /// `a < b < c`.
    #[error("comparisons do not chain: write `a < b && b < c`")]
    ChainedComparison,
}

fn hint(near: &Option<String>) -> String {
    near.as_ref().map_or_else(String::new, |name| format!("; did you mean `{name}`?"))
}

impl Formula {
    /// Parses a formula. O(length).
    ///
    /// # Errors
    /// The first syntax error in the text.
    ///
    /// ```
    /// use hiddenline::stages::surface::formula::{Formula, Variables};
    /// let f = Formula::parse("-x^2 + 2^3^2", Variables::Plane)?;
    /// assert_eq!(f.value(3.0, 0.0), 503.0);
    /// let error = Formula::parse("1 + sine(x)", Variables::Plane).unwrap_err();
    /// assert_eq!(error.to_string(), "column 5: unknown name `sine`; did you mean `sin`?");
    /// # Ok::<(), hiddenline::stages::surface::formula::FormulaError>(())
    /// ```
    pub fn parse(text: &str, variables: Variables) -> Result<Self, FormulaError> {
        Self::parse_with(text, variables, &[])
    }

    /// Parses a formula that may also name parameters, which are constants in it. O(length · parameters).
    ///
    /// # Errors
    /// The first syntax error in the text.
    ///
    /// ```
    /// use hiddenline::stages::surface::formula::{Formula, Parameter, Variables};
    /// let a = Parameter::new("a", 3.0)?;
    /// assert_eq!(Formula::parse_with("a*x", Variables::Plane, &[a])?.value(2.0, 0.0), 6.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn parse_with(
        text: &str,
        variables: Variables,
        parameters: &[Parameter],
    ) -> Result<Self, FormulaError> {
        if text.len() > MAX_LENGTH {
            return Err(FormulaError { column: 1, problem: Problem::TooLong });
        }
        let tokens = lexer::tokens(text)?;
        let tape = parser::parse(&tokens, variables, parameters)?;
        Ok(Self { tape, text: text.trim().to_owned() })
    }

    /// The text that it was parsed from.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether the formula names a parameter, or anything else, by this name. O(length).
    pub fn names(&self, name: &str) -> bool {
        let tokens = lexer::tokens(&self.text).unwrap_or_default();
        tokens.iter().any(|placed| matches!(&placed.token, Token::Name(other) if other == name))
    }

    /// The same with values below `low` raised to it, and those above `high` lowered.
    #[must_use]
    pub(super) fn clamped(&self, low: f64, high: f64) -> Self {
        let mut clamped = self.clone();
        for op in [Op::Constant(low), Op::Constant(high), Op::Clamp] {
            clamped.tape.push(op);
        }
        clamped
    }

    /// The value at one pair of variables; NaN where the formula is undefined.
    pub fn value(&self, a: f64, b: f64) -> f64 {
        let mut out = [0.0];
        self.values(&[a], &[b], &mut out);
        out[0]
    }

    /// The formula ready to be enclosed over boxes. O(operations).
    #[doc(hidden)]
    pub fn jets(&self) -> JetGraph {
        JetGraph::new(&self.tape)
    }

    /// The values at many pairs, as many as the shortest of the three slices holds.
    ///
    /// Each operation is dispatched once per block of samples, so prefer long slices.
    pub fn values(&self, a: &[f64], b: &[f64], out: &mut [f64]) {
        self.tape.run(a, b, out);
    }
}
