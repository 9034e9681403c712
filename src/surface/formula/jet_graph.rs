//! A formula as a graph, to be enclosed over boxes: equal subexpressions are one node.
//!
//! ```text
//!   x*x + sin(x*x)        [x] ─► [square] ─► [+]     A product of equal operands is a square, which
//!                                  └─► [sin] ─┘      is not negative even where x may be.
//! ```

use std::mem::Discriminant;

use rustc_hash::FxHashMap;

use super::function::Function;
use super::interval::Interval;
use super::jet::{Comparison, Jet};
use super::tape::{Op, Tape};
use crate::surface::AxisScale;

/// A formula that can be enclosed.
#[derive(Debug, Clone)]
pub struct JetGraph {
    /// Operands come before what they are used in; the last node is the formula.
    nodes: Vec<Node>,
    /// How both variables and the value become coordinates.
    scales: [AxisScale; 3],
}

#[derive(Debug, Clone, Copy)]
struct Node {
    op: Op,
    operands: [u32; 3],
    /// Whether it depends on the first and on the second variable.
    depends: [bool; 2],
}

/// One of the two variables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// x or u.
    First,
    /// y or v.
    Second,
}

impl Axis {
    /// The one that stays the same along this one.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::First => Self::Second,
            Self::Second => Self::First,
        }
    }
}

impl JetGraph {
    pub(super) fn new(tape: &Tape) -> Self {
        let mut nodes: Vec<Node> = Vec::new();
        let mut known: FxHashMap<(Discriminant<Op>, u64, [u32; 3]), u32> = FxHashMap::default();
        let mut stack: Vec<u32> = Vec::new();
        for &op in tape.ops() {
            let taken = stack.split_off(stack.len() - op.n_operands());
            let op = match (op, &taken[..]) {
                (Op::Multiply, [a, b]) if a == b => Op::Square,
                _ => op,
            };
            let mut operands = [0; 3];
            let n_operands = op.n_operands();
            operands[..n_operands].copy_from_slice(&taken[..n_operands]);
            let (kind, detail) = op.key();
            let id = *known.entry((kind, detail, operands)).or_insert_with(|| {
                let own = |axis: usize| match op {
                    Op::First => axis == 0,
                    Op::Second => axis == 1,
                    Op::Radius | Op::Angle => true,
                    _ => false,
                };
                let any = |axis: usize| {
                    let mut used = operands[..n_operands].iter();
                    own(axis) || used.any(|&k| nodes[k as usize].depends[axis])
                };
                nodes.push(Node { op, operands, depends: [any(0), any(1)] });
                nodes.len() as u32 - 1
            });
            stack.push(id);
        }
        Self { nodes, scales: [AxisScale::DATA; 3] }
    }

    /// The same in coordinates: of both variables, and of the value.
    #[must_use]
    pub fn scaled(self, scales: [AxisScale; 3]) -> Self {
        Self { scales, ..self }
    }

    /// The value of a variable, from its coordinate.
    fn value_of(&self, variable: usize, drawn: Jet) -> Jet {
        let AxisScale { factor, is_log } = self.scales[variable];
        let value = drawn.times(1.0 / factor);
        if is_log { Jet::constant(10.0).power(value).checked() } else { value }
    }

    /// The coordinate of a value.
    fn drawn(&self, value: Jet) -> Jet {
        let AxisScale { factor, is_log } = self.scales[2];
        let value = if is_log { value.apply(Function::Log10).checked() } else { value };
        value.times(factor)
    }

    /// Encloses the formula over a box along a direction, given as its parts along both variables.
    ///
    /// `room` is kept from call to call so that nothing is allocated. O(operations).
    pub fn over(&self, a: Interval, b: Interval, direction: [f64; 2], room: &mut Vec<Jet>) -> Jet {
        let variables = [
            self.value_of(0, Jet::variable(a, direction[0])),
            self.value_of(1, Jet::variable(b, direction[1])),
        ];
        room.clear();
        for node in &self.nodes {
            let jet = node.jet(room, variables);
            room.push(jet);
        }
        self.drawn(room.last().copied().unwrap_or(Jet::NOWHERE))
    }

    /// Prepares to enclose the formula along lines on which only one variable changes.
    pub fn along(&self, axis: Axis) -> JetLine<'_> {
        let is_moving = |node: &Node| node.depends[axis as usize];
        let all = 0..self.nodes.len() as u32;
        let (moving, fixed) = all.partition(|&k| is_moving(&self.nodes[k as usize]));
        let jets = vec![Jet::NOWHERE; self.nodes.len()];
        JetLine { graph: self, axis, moving, fixed, at: 0.0, jets }
    }
}

/// Encloses a formula along lines parallel to an axis: what does not change is computed once a line.
#[derive(Debug, Clone)]
pub struct JetLine<'a> {
    graph: &'a JetGraph,
    axis: Axis,
    moving: Vec<u32>,
    fixed: Vec<u32>,
    at: f64,
    jets: Vec<Jet>,
}

impl JetLine<'_> {
    /// Goes to the line on which the other variable has this value.
    pub fn go_to(&mut self, at: f64) {
        self.at = at;
        let variables = self.variables(Interval::ALL);
        for &k in &self.fixed {
            self.jets[k as usize] = self.graph.nodes[k as usize].jet(&self.jets, variables);
        }
    }

    /// Encloses the formula over a part of the line, with derivatives by the variable that changes.
    pub fn over(&mut self, range: Interval) -> Jet {
        let variables = self.variables(range);
        for &k in &self.moving {
            self.jets[k as usize] = self.graph.nodes[k as usize].jet(&self.jets, variables);
        }
        self.graph.drawn(self.jets.last().copied().unwrap_or(Jet::NOWHERE))
    }

    fn variables(&self, range: Interval) -> [Jet; 2] {
        let moving = Jet::variable(range, 1.0);
        let fixed = Jet::variable(Interval::point(self.at), 0.0);
        match self.axis {
            Axis::First => [self.graph.value_of(0, moving), self.graph.value_of(1, fixed)],
            Axis::Second => [self.graph.value_of(0, fixed), self.graph.value_of(1, moving)],
        }
    }
}

impl Node {
    /// The jet of this node, from those of its operands and of the variables.
    #[inline]
    fn jet(&self, jets: &[Jet], [a, b]: [Jet; 2]) -> Jet {
        let operand = |k: usize| jets[self.operands[k] as usize];
        let compare = |a: Jet, b: Jet, comparison| a.compare(b, comparison);
        let jet = match self.op {
            Op::Constant(value) => Jet::constant(value),
            Op::First => a,
            Op::Second => b,
            Op::Radius => Jet::hypotenuse(a, b),
            Op::Angle => Jet::angle(b, a),
            Op::Negate => operand(0).negate(),
            Op::Not => operand(0).not(),
            Op::Square => operand(0).square(),
            Op::Unary(function) => operand(0).apply(function),
            Op::Add => operand(0).add(operand(1)),
            Op::Subtract => operand(0).add(operand(1).negate()),
            Op::Multiply => operand(0).multiply(operand(1)),
            Op::Divide => operand(0).divide(operand(1)),
            Op::Modulo => operand(0).modulo(operand(1)),
            Op::Power => operand(0).power(operand(1)),
            Op::Less => compare(operand(0), operand(1), Comparison::Less),
            Op::LessOrEqual => compare(operand(0), operand(1), Comparison::LessOrEqual),
            Op::Greater => compare(operand(1), operand(0), Comparison::Less),
            Op::GreaterOrEqual => compare(operand(1), operand(0), Comparison::LessOrEqual),
            Op::Equal => compare(operand(0), operand(1), Comparison::Equal),
            Op::NotEqual => compare(operand(0), operand(1), Comparison::Equal).not(),
            Op::And => operand(0).and(operand(1)),
            Op::Or => operand(0).or(operand(1)),
            Op::Select => operand(0).select(operand(1), operand(2)),
            Op::Clamp => operand(0).greatest(operand(1)).least(operand(2)),
            Op::Min => operand(0).least(operand(1)),
            Op::Max => operand(0).greatest(operand(1)),
            Op::Arctangent => Jet::angle(operand(0), operand(1)),
            Op::Hypotenuse => Jet::hypotenuse(operand(0), operand(1)),
        };
        jet.checked()
    }
}
