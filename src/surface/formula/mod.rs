//! Formulas: text such as `sin(x) * exp(-y^2)` parsed once and evaluated many times.
//!
//! ```text
//!   text ─► tokens ─► operator precedence ─► postfix tape ─► values, a block of samples at a time
//! ```
//!
//! Written here because no crate tried was right about `-x^2` (minus the square), `2^3^2` (512),
//! `1e3`, the column of an error and hostile nesting at once: exmex, fasteval2, meval, evalexpr
//! and fidget each fail one. Elementary functions come from `libm`, so that the same formula gives
//! the same bits everywhere.
//!
//! # Language
//!
//! Loosest first: `c ? a : b`; `||` or `or`; `&&` or `and`; `< <= > >= == !=`; `+ -`; `* / %`;
//! unary `- + !` or `not`; `^` or `**` (binds to the right, `-x^2` is `-(x^2)`), or raised digits as
//! in `x²`. True is 1, false is
//! 0, and anything but 0 is true; what is not a number is false. `%` and `mod` take the sign of the
//! divisor. Both branches of a condition may be evaluated; only the chosen one counts. Names are
//! listed in [`FUNCTIONS`] and [`CONSTANTS`].

mod lexer;
mod parser;
mod tape;

pub use tape::{CONSTANTS, FUNCTIONS};

use tape::Tape;
use thiserror::Error;

/// Longest formula that is read, in bytes.
pub const MAX_LENGTH: usize = 20_000;

/// Deepest nesting of parentheses, functions, signs and powers that is read.
pub const MAX_DEPTH: usize = 200;

/// Which names stand for the two numbers that a formula is evaluated at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variables {
    /// `x` and `y`; also `r`, the distance from the origin, and `theta`, the angle from the x axis
    /// in −π..π.
    Plane,
    /// `u` and `v`, the parameters of a surface in space.
    Parameters,
}

/// A parsed formula of two variables.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    tape: Tape,
}

/// What is wrong with a formula, and where: columns count characters from 1.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("column {column}: {problem}")]
pub struct FormulaError {
    /// The character at which reading stopped, counted from 1.
    pub column: usize,
    /// What was found there.
    pub problem: Problem,
}

/// The kinds of [`FormulaError`].
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Problem {
    /// Nothing but blanks.
    #[error("the formula is empty")]
    Empty,
    /// More than [`MAX_LENGTH`] bytes.
    #[error("the formula is longer than {MAX_LENGTH} bytes")]
    TooLong,
    /// More than [`MAX_DEPTH`] levels.
    #[error("the formula is nested more than {MAX_DEPTH} levels deep")]
    TooDeep,
    /// A character that no formula has.
    #[error("`{0}` has no meaning in a formula")]
    Character(char),
    /// Digits that make no number.
    #[error("`{0}` is not a number")]
    Number(String),
    /// Neither variable, constant nor function.
    #[error("unknown name `{name}`{}", hint(.near))]
    UnknownName {
        /// As written.
        name: String,
        /// The known name that is spelled most like it, or the product that it looks like.
        near: Option<String>,
    },
    /// A value was expected.
    #[error("expected a value but found {0}")]
    ExpectedValue(String),
    /// An operator or the end was expected.
    #[error("expected an operator but found {0}")]
    ExpectedOperator(String),
    /// Two values beside each other, as in `2x`.
    #[error("expected an operator but found {found}; a product is written `{left}*{right}`")]
    MissingTimes {
        /// The second one, in words.
        found: String,
        /// The first one.
        left: String,
        /// The second one.
        right: String,
    },
    /// `=`, which assigns or compares elsewhere.
    #[error("`=` has no meaning in a formula: for a condition write `==`, `<=` or `>=`")]
    SingleEquals,
    /// `z = …`.
    #[error("a formula is only the right side: leave out `{0} =`")]
    Assignment(String),
    /// A closing parenthesis or something else is missing.
    #[error("expected {expected} but found {found}")]
    Expected {
        /// What should stand here.
        expected: &'static str,
        /// What stands here.
        found: String,
    },
    /// A function without its parentheses.
    #[error("`{0}` is a function: write `{0}(…)`")]
    FunctionNeedsArguments(&'static str),
    /// A wrong number of arguments.
    #[error("`{name}` takes {takes}, not {given}")]
    ArgumentCount {
        /// The function.
        name: &'static str,
        /// How many it takes, in words.
        takes: &'static str,
        /// How many were written.
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
    /// Reads a formula. O(length).
    ///
    /// # Errors
    /// The first place at which the text is no formula.
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
        if text.len() > MAX_LENGTH {
            return Err(FormulaError { column: 1, problem: Problem::TooLong });
        }
        let tokens = lexer::tokens(text)?;
        Ok(Self { tape: parser::parse(&tokens, variables)? })
    }

    /// The value at one pair of numbers; not a number where the formula has none.
    pub fn value(&self, a: f64, b: f64) -> f64 {
        let mut out = [0.0];
        self.values(&[a], &[b], &mut out);
        out[0]
    }

    /// The values at many pairs; as many as the shortest of the three slices has.
    ///
    /// Costs one dispatch for each operation and block of samples, so long slices are cheap.
    pub fn values(&self, a: &[f64], b: &[f64], out: &mut [f64]) {
        self.tape.run(a, b, out);
    }
}
