//! The postfix tape: operations on a stack whose entries are blocks of samples.

use std::mem::{Discriminant, discriminant};

use super::function::Function;

/// How many samples are evaluated together, to amortize the dispatch of operations.
const BLOCK: usize = 64;

/// Named constants and their values.
pub const CONSTANTS: [(&str, f64); 4] = [
    ("pi", std::f64::consts::PI),
    ("e", std::f64::consts::E),
    ("tau", std::f64::consts::TAU),
    ("nan", f64::NAN),
];

/// The functions. `if(c, a, b)` is `c ? a : b`; `log` and `ln` are both the natural logarithm;
/// `sinc(t)` is sin t / t, and 1 at 0; `min` and `max` take two or more arguments.
pub const FUNCTIONS: [&str; 41] = [
    "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh",
    "atanh", "sqrt", "cbrt", "exp", "ln", "log", "log2", "log10", "pow", "abs", "sign", "floor",
    "ceil", "round", "trunc", "fract", "mod", "min", "max", "clamp", "hypot", "if", "sinc", "erf",
    "gamma", "j0", "j1", "y0", "y1",
];

/// How many arguments a function takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Takes {
    One,
    Two,
    Three,
    TwoOrMore,
}

impl Takes {
    pub(super) fn allows(self, given: usize) -> bool {
        match self {
            Self::One => given == 1,
            Self::Two => given == 2,
            Self::Three => given == 3,
            Self::TwoOrMore => given >= 2,
        }
    }

    pub(super) fn in_words(self) -> &'static str {
        match self {
            Self::One => "1 argument",
            Self::Two => "2 arguments",
            Self::Three => "3 arguments",
            Self::TwoOrMore => "2 or more arguments",
        }
    }
}

/// One operation of the tape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Op {
    Constant(f64),
    First,
    Second,
    Radius,
    Angle,
    Negate,
    Not,
    Add,
    Subtract,
    Multiply,
    Divide,
    Modulo,
    Power,
    Square,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
    And,
    Or,
    Select,
    Clamp,
    Min,
    Max,
    /// The angle of the point with the second argument as x and the first as y.
    Arctangent,
    Hypotenuse,
    Unary(Function),
}

impl Op {
    /// Equal for equal operations, the bits of constants included.
    pub(super) fn key(self) -> (Discriminant<Self>, u64) {
        let detail = match self {
            Self::Constant(value) => value.to_bits(),
            Self::Unary(function) => function as u64,
            _ => 0,
        };
        (discriminant(&self), detail)
    }

    /// How many operands it takes from the stack.
    pub(super) fn n_operands(self) -> usize {
        use Op::*;
        match self {
            Constant(_) | First | Second | Radius | Angle => 0,
            Negate | Not | Square | Unary(_) => 1,
            Select | Clamp => 3,
            _ => 2,
        }
    }
}

/// A function's name, the number of arguments it takes, and its operation.
pub(super) fn function(name: &str) -> Option<(&'static str, Takes, Op)> {
    let name = FUNCTIONS.iter().find(|known| **known == name)?;
    let unary = |function| (Takes::One, Op::Unary(function));
    let (takes, op) = match *name {
        "sin" => unary(Function::Sin),
        "cos" => unary(Function::Cos),
        "tan" => unary(Function::Tan),
        "asin" => unary(Function::Asin),
        "acos" => unary(Function::Acos),
        "atan" => unary(Function::Atan),
        "atan2" => (Takes::Two, Op::Arctangent),
        "sinh" => unary(Function::Sinh),
        "cosh" => unary(Function::Cosh),
        "tanh" => unary(Function::Tanh),
        "asinh" => unary(Function::Asinh),
        "acosh" => unary(Function::Acosh),
        "atanh" => unary(Function::Atanh),
        "sqrt" => unary(Function::Sqrt),
        "cbrt" => unary(Function::Cbrt),
        "exp" => unary(Function::Exp),
        "ln" | "log" => unary(Function::Ln),
        "log2" => unary(Function::Log2),
        "log10" => unary(Function::Log10),
        "pow" => (Takes::Two, Op::Power),
        "abs" => unary(Function::Abs),
        "sign" => unary(Function::Sign),
        "floor" => unary(Function::Floor),
        "ceil" => unary(Function::Ceil),
        "round" => unary(Function::Round),
        "trunc" => unary(Function::Trunc),
        "fract" => unary(Function::Fract),
        "mod" => (Takes::Two, Op::Modulo),
        "min" => (Takes::TwoOrMore, Op::Min),
        "max" => (Takes::TwoOrMore, Op::Max),
        "clamp" => (Takes::Three, Op::Clamp),
        "hypot" => (Takes::Two, Op::Hypotenuse),
        "if" => (Takes::Three, Op::Select),
        "sinc" => unary(Function::Sinc),
        "erf" => unary(Function::Erf),
        "gamma" => unary(Function::Gamma),
        "j0" => unary(Function::J0),
        "j1" => unary(Function::J1),
        "y0" => unary(Function::Y0),
        _ => unary(Function::Y1),
    };
    Some((name, takes, op))
}

/// A formula in postfix order. Running it needs a stack of `depth` blocks.
#[derive(Debug, Clone, Default)]
pub(super) struct Tape {
    ops: Vec<Op>,
    /// Stack height after the last operation, in blocks.
    height: usize,
    depth: usize,
}

impl PartialEq for Tape {
    fn eq(&self, other: &Self) -> bool {
        self.ops.iter().map(|op| op.key()).eq(other.ops.iter().map(|op| op.key()))
    }
}

impl Tape {
    pub(super) fn push(&mut self, op: Op) {
        use Op::*;
        // Squares are by far the most common powers; the result is rounded like a product.
        if let (Power, Some(Constant(two))) = (op, self.ops.last())
            && *two == 2.0
        {
            self.ops.pop();
            self.ops.push(Square);
            self.height -= 1;
            return;
        }
        self.height = self.height + 1 - op.n_operands();
        self.depth = self.depth.max(self.height);
        self.ops.push(op);
    }

    /// The operations in the order in which they are carried out.
    pub(super) fn ops(&self) -> &[Op] {
        &self.ops
    }

    /// Evaluates the tape at each pair of variables.
    pub(super) fn run(&self, a: &[f64], b: &[f64], out: &mut [f64]) {
        let mut stack = vec![[0.0; BLOCK]; self.depth + 1];
        let blocks = a.chunks(BLOCK).zip(b.chunks(BLOCK)).zip(out.chunks_mut(BLOCK));
        for ((a, b), out) in blocks {
            let n = a.len().min(b.len()).min(out.len());
            self.run_block(&a[..n], &b[..n], &mut stack);
            out[..n].copy_from_slice(&stack[0][..n]);
        }
    }

    fn run_block(&self, a: &[f64], b: &[f64], stack: &mut [[f64; BLOCK]]) {
        use Op::*;
        let n = a.len();
        // Index of the first free block.
        let mut top = 0;
        for op in &self.ops {
            match *op {
                Constant(value) => push(stack, &mut top, n, |_| value),
                First => push(stack, &mut top, n, |k| a[k]),
                Second => push(stack, &mut top, n, |k| b[k]),
                Radius => push(stack, &mut top, n, |k| (a[k] * a[k] + b[k] * b[k]).sqrt()),
                Angle => push(stack, &mut top, n, |k| libm::atan2(b[k], a[k])),
                Negate => unary(stack, top, n, |s| -s),
                Not => unary(stack, top, n, |s| truth(!holds(s))),
                Square => unary(stack, top, n, |s| s * s),
                Unary(function) => unary(stack, top, n, function.evaluator()),
                Add => binary(stack, &mut top, n, |s, t| s + t),
                Subtract => binary(stack, &mut top, n, |s, t| s - t),
                Multiply => binary(stack, &mut top, n, |s, t| s * t),
                Divide => binary(stack, &mut top, n, |s, t| s / t),
                Modulo => binary(stack, &mut top, n, modulo),
                Power => binary(stack, &mut top, n, libm::pow),
                Less => binary(stack, &mut top, n, |s, t| truth(s < t)),
                LessOrEqual => binary(stack, &mut top, n, |s, t| truth(s <= t)),
                Greater => binary(stack, &mut top, n, |s, t| truth(s > t)),
                GreaterOrEqual => binary(stack, &mut top, n, |s, t| truth(s >= t)),
                Equal => binary(stack, &mut top, n, |s, t| truth(s == t)),
                NotEqual => binary(stack, &mut top, n, |s, t| truth(s != t)),
                And => binary(stack, &mut top, n, |s, t| truth(holds(s) && holds(t))),
                Or => binary(stack, &mut top, n, |s, t| truth(holds(s) || holds(t))),
                Min => binary(stack, &mut top, n, |s, t| extreme(s, t, s < t)),
                Max => binary(stack, &mut top, n, |s, t| extreme(s, t, s > t)),
                Arctangent => binary(stack, &mut top, n, libm::atan2),
                Hypotenuse => binary(stack, &mut top, n, libm::hypot),
                Select => ternary(stack, &mut top, n, |c, s, t| if holds(c) { s } else { t }),
                Clamp => ternary(stack, &mut top, n, |t, low, high| {
                    let raised = extreme(t, low, t > low);
                    extreme(raised, high, raised < high)
                }),
            }
        }
    }
}

fn push(stack: &mut [[f64; BLOCK]], top: &mut usize, n: usize, f: impl Fn(usize) -> f64) {
    stack[*top][..n].iter_mut().enumerate().for_each(|(k, s)| *s = f(k));
    *top += 1;
}

fn unary(stack: &mut [[f64; BLOCK]], top: usize, n: usize, f: impl Fn(f64) -> f64) {
    stack[top - 1][..n].iter_mut().for_each(|s| *s = f(*s));
}

fn binary(stack: &mut [[f64; BLOCK]], top: &mut usize, n: usize, f: impl Fn(f64, f64) -> f64) {
    *top -= 1;
    let (below, above) = stack.split_at_mut(*top);
    let target = &mut below[*top - 1];
    target[..n].iter_mut().zip(&above[0][..n]).for_each(|(s, t)| *s = f(*s, *t));
}

fn ternary(
    stack: &mut [[f64; BLOCK]],
    top: &mut usize,
    n: usize,
    f: impl Fn(f64, f64, f64) -> f64,
) {
    *top -= 2;
    let (below, above) = stack.split_at_mut(*top);
    let target = &mut below[*top - 1];
    for k in 0..n {
        target[k] = f(target[k], above[0][k], above[1][k]);
    }
}

fn holds(value: f64) -> bool {
    value != 0.0 && !value.is_nan()
}

fn truth(value: bool) -> f64 {
    if value { 1.0 } else { 0.0 }
}

/// `s` if it is chosen and `t` otherwise; NaN if either is NaN.
fn extreme(s: f64, t: f64, s_is_chosen: bool) -> f64 {
    if s.is_nan() || s_is_chosen { s } else { t }
}

/// The remainder with the sign of the divisor.
fn modulo(s: f64, t: f64) -> f64 {
    let remainder = libm::fmod(s, t);
    if remainder != 0.0 && (remainder < 0.0) != (t < 0.0) { remainder + t } else { remainder }
}
