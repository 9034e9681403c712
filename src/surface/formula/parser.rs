//! Turns tokens into a postfix tape by operator precedence (Pratt 1973).

use super::lexer::{Placed, Token};
use super::tape::{CONSTANTS, FUNCTIONS, Op, Takes, Tape, function};
use super::{FormulaError, MAX_DEPTH, Parameter, Problem, Variables};

pub(super) fn parse(
    tokens: &[Placed],
    variables: Variables,
    parameters: &[Parameter],
) -> Result<Tape, FormulaError> {
    if let Some(left) = left_side(tokens, variables) {
        return Err(FormulaError { column: 1, problem: Problem::Assignment(left) });
    }
    let tape = Tape::default();
    let mut parser = Parser { tokens, at: 0, depth: 0, variables, parameters, tape };
    parser.expression(0)?;
    match parser.peek() {
        Token::End => Ok(parser.tape),
        _ => Err(parser.fails(parser.no_operator())),
    }
}

/// The left-hand side of an equation such as `z = …` or `f(x, y) = …`; `None` if the `=` may be meant as
/// a comparison.
fn left_side(tokens: &[Placed], variables: Variables) -> Option<String> {
    let equals = tokens.iter().position(|t| t.token == Token::Symbol("="))?;
    let Token::Name(name) = &tokens.first()?.token else { return None };
    let is_variable = variable(name, variables).is_some();
    let is_call = equals > 2
        && tokens[1].token == Token::Symbol("(")
        && tokens[equals - 1].token == Token::Symbol(")");
    match (equals, is_variable, is_call) {
        (1, false, _) => Some(name.clone()),
        (_, false, true) if function(name).is_none() => Some(format!("{name}(…)")),
        _ => None,
    }
}

fn variable(name: &str, variables: Variables) -> Option<Op> {
    Some(match (variables, name) {
        (Variables::Plane, "x") | (Variables::Parameters, "u") => Op::First,
        (Variables::Plane, "y") | (Variables::Parameters, "v") => Op::Second,
        (Variables::Plane, "r") => Op::Radius,
        (Variables::Plane, "theta") => Op::Angle,
        _ => return None,
    })
}

struct Parser<'a> {
    /// Never empty; ends with [`Token::End`], which is never consumed.
    tokens: &'a [Placed],
    at: usize,
    depth: usize,
    variables: Variables,
    parameters: &'a [Parameter],
    tape: Tape,
}

/// Precedences; a higher number binds tighter.
const CONDITION: u8 = 1;
const COMPARISON: u8 = 4;
const UNARY: u8 = 7;
const POWER: u8 = 8;

fn binary(symbol: &str) -> Option<(u8, Op)> {
    Some(match symbol {
        "||" => (2, Op::Or),
        "&&" => (3, Op::And),
        "<" => (COMPARISON, Op::Less),
        "<=" => (COMPARISON, Op::LessOrEqual),
        ">" => (COMPARISON, Op::Greater),
        ">=" => (COMPARISON, Op::GreaterOrEqual),
        "==" => (COMPARISON, Op::Equal),
        "!=" => (COMPARISON, Op::NotEqual),
        "+" => (5, Op::Add),
        "-" => (5, Op::Subtract),
        "*" => (6, Op::Multiply),
        "/" => (6, Op::Divide),
        "%" => (6, Op::Modulo),
        "^" => (POWER, Op::Power),
        _ => return None,
    })
}

impl<'a> Parser<'a> {
    fn peek(&self) -> &'a Token {
        &self.tokens[self.at].token
    }

    fn next(&mut self) -> &'a Token {
        let token = self.peek();
        self.at = (self.at + 1).min(self.tokens.len() - 1);
        token
    }

    fn fails(&self, problem: Problem) -> FormulaError {
        FormulaError { column: self.tokens[self.at].column, problem }
    }

    fn fails_at(&self, at: usize, problem: Problem) -> FormulaError {
        FormulaError { column: self.tokens[at].column, problem }
    }

    fn expect(&mut self, symbol: &'static str, expected: &'static str) -> Result<(), FormulaError> {
        if *self.peek() == Token::Symbol(symbol) {
            self.next();
            return Ok(());
        }
        // A token that could start a value here suggests a missing `*`.
        if let problem @ (Problem::MissingTimes { .. } | Problem::SingleEquals) = self.no_operator()
        {
            return Err(self.fails(problem));
        }
        let found = self.peek().describe();
        Err(self.fails(Problem::Expected { expected, found }))
    }

    /// What is wrong where a value ends and no operator follows.
    fn no_operator(&self) -> Problem {
        let next = self.peek();
        let before = self.at.checked_sub(1).map(|before| &self.tokens[before].token);
        let right = match next {
            Token::Symbol("=") => return Problem::SingleEquals,
            Token::Number(value) => Some(value.to_string()),
            Token::Name(name) => Some(name.clone()),
            Token::Symbol("(") => Some("(…)".to_owned()),
            _ => None,
        };
        let left = match before {
            Some(Token::Number(value)) => Some(value.to_string()),
            Some(Token::Name(name)) => Some(name.clone()),
            Some(Token::Symbol(")")) => Some("(…)".to_owned()),
            _ => None,
        };
        match left.zip(right) {
            Some((left, right)) => Problem::MissingTimes { found: next.describe(), left, right },
            None => Problem::ExpectedOperator(next.describe()),
        }
    }

    /// Reads everything that binds at least as tightly as `tightness`.
    fn expression(&mut self, tightness: u8) -> Result<(), FormulaError> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(self.fails(Problem::TooDeep));
        }
        self.value()?;
        loop {
            // A raised exponent binds before all operators: `2^x²` is `2^(x²)`.
            if let Token::Raised(exponent) = self.peek() {
                self.next();
                self.tape.push(Op::Constant(*exponent));
                self.tape.push(Op::Power);
                continue;
            }
            let Token::Symbol(symbol) = self.peek() else { break };
            if *symbol == "?" && tightness <= CONDITION {
                self.next();
                self.expression(0)?;
                self.expect(":", "`:` and the value otherwise")?;
                self.expression(CONDITION)?;
                self.tape.push(Op::Select);
                continue;
            }
            let Some((binding, op)) = binary(symbol).filter(|(b, _)| *b >= tightness) else {
                break;
            };
            self.next();
            // `^` is right-associative, and a sign may follow it: `2^-x`.
            self.expression(if binding == POWER { UNARY } else { binding + 1 })?;
            self.tape.push(op);
            if binding == COMPARISON
                && let Token::Symbol(again) = self.peek()
                && binary(again).is_some_and(|(b, _)| b == COMPARISON)
            {
                return Err(self.fails(Problem::ChainedComparison));
            }
        }
        self.depth -= 1;
        Ok(())
    }

    fn value(&mut self) -> Result<(), FormulaError> {
        let at = self.at;
        match self.next() {
            Token::Number(value) => self.tape.push(Op::Constant(*value)),
            Token::Symbol("(") => {
                self.expression(0)?;
                self.expect(")", "`)`")?;
            }
            Token::Symbol("-") => {
                self.expression(UNARY)?;
                self.tape.push(Op::Negate);
            }
            Token::Symbol("+") => self.expression(UNARY)?,
            Token::Symbol("!") => {
                self.expression(UNARY)?;
                self.tape.push(Op::Not);
            }
            Token::Name(name) => self.name(name, at)?,
            token => {
                return Err(self.fails_at(at, Problem::ExpectedValue(token.describe())));
            }
        }
        Ok(())
    }

    fn name(&mut self, name: &str, at: usize) -> Result<(), FormulaError> {
        if *self.peek() == Token::Symbol("(")
            && let Some((name, takes, op)) = function(name)
        {
            self.next();
            return self.arguments(name, takes, op, at);
        }
        let constant = || {
            let constant = CONSTANTS.iter().find(|(constant, _)| *constant == name);
            constant.map(|(_, value)| Op::Constant(*value))
        };
        let parameter = || {
            let found = self.parameters.iter().find(|parameter| parameter.name() == name);
            found.map(|parameter| Op::Constant(parameter.value()))
        };
        let op = variable(name, self.variables).or_else(constant).or_else(parameter);
        let op = op.ok_or_else(|| self.fails_at(at, unknown(name, self.variables)))?;
        self.tape.push(op);
        Ok(())
    }

    fn arguments(
        &mut self,
        name: &'static str,
        takes: Takes,
        op: Op,
        at: usize,
    ) -> Result<(), FormulaError> {
        let mut given = 0;
        if *self.peek() != Token::Symbol(")") {
            loop {
                self.expression(0)?;
                given += 1;
                if takes == Takes::TwoOrMore && given >= 2 {
                    self.tape.push(op);
                }
                if *self.peek() != Token::Symbol(",") {
                    break;
                }
                self.next();
            }
        }
        self.expect(")", "`,` or `)`")?;
        if !takes.allows(given) {
            let takes = takes.in_words();
            return Err(self.fails_at(at, Problem::ArgumentCount { name, takes, given }));
        }
        if takes != Takes::TwoOrMore {
            self.tape.push(op);
        }
        Ok(())
    }
}

fn unknown(name: &str, variables: Variables) -> Problem {
    if let Some((function, ..)) = function(name) {
        return Problem::FunctionNeedsArguments(function);
    }
    let named = variables;
    let variables: &[&'static str] = match variables {
        Variables::Plane => &["theta"],
        Variables::Parameters => &[],
    };
    let known = FUNCTIONS.iter().chain(CONSTANTS.iter().map(|(name, _)| name)).chain(variables);
    let near = known
        .map(|known| (edit_distance(name, known), *known))
        .min()
        .filter(|(distance, _)| *distance <= 2 && 2 * distance < name.chars().count())
        .map(|(_, known)| known.to_owned());
    // Variables run together, such as `xy`.
    let letters: Vec<String> = name.chars().map(String::from).collect();
    let product = letters.iter().all(|letter| variable(letter, named).is_some());
    let near = near.or_else(|| product.then(|| letters.join("*")));
    Problem::UnknownName { name: name.to_owned(), near }
}

/// The Levenshtein distance between two names.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().take(40).enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, to) in b.iter().enumerate() {
            let changed = diagonal + usize::from(from != *to);
            diagonal = row[j + 1];
            row[j + 1] = changed.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
