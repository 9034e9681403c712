//! Enclosures of formulas: values, slopes and second derivatives of samples lie inside.

use hiddenline::stages::surface::AxisScale;
use hiddenline::stages::surface::formula::{Axis, Class, Formula, Interval, Jet, Variables};

/// A generator of random numbers: xorshift.
struct Random(u64);

impl Random {
    fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() >> 33) as usize % n
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Boxes for each formula. Once, all formulas were tried on 100,000 boxes each.
const BOXES: usize = 400;

/// Every operation and function, plain and of functions that bend.
const FORMULAS: &[&str] = &[
    "x + y",
    "x - y^2",
    "x*y",
    "x/y",
    "1/x",
    "1/(x*y)",
    "x^2",
    "x*x",
    "-x^3",
    "x^4",
    "x^5",
    "x^-1",
    "x^-2",
    "x^-3",
    "x^0",
    "x^1",
    "x^2.5",
    "x^1.5",
    "x^0.5",
    "x^-0.5",
    "x^y",
    "(x^2+1)^y",
    "2^x",
    "(-2)^x",
    "r^1.5",
    "pow(x, 7)",
    "sin(x)",
    "cos(x)",
    "tan(x)",
    "sin(3*x*y)",
    "cos(x*x)",
    "tan(x*y)",
    "asin(x)",
    "acos(x)",
    "atan(x*y)",
    "sinh(x)",
    "cosh(x)",
    "tanh(x*y)",
    "asinh(x)",
    "acosh(x)",
    "atanh(x)",
    "asin(sin(x))",
    "sqrt(x)",
    "sqrt(9 - r^2)",
    "sqrt(x*x)",
    "cbrt(x)",
    "cbrt(x*y - 1)",
    "exp(x)",
    "exp(-r^2)",
    "exp(400*x)",
    "ln(x)",
    "log2(x)",
    "log10(x)",
    "ln(r^2)",
    "abs(x)",
    "abs(x) - abs(y)",
    "abs(sin(x))",
    "sign(x)",
    "floor(x)",
    "ceil(x)",
    "round(x)",
    "trunc(x)",
    "fract(x)",
    "mod(x, y)",
    "x % 2",
    "(x*x) % -3",
    "min(x, y)",
    "max(x*x, y, 1)",
    "clamp(x, -1, y)",
    "hypot(x, y)",
    "hypot(sin(x), y*y)",
    "r",
    "theta",
    "atan2(y, x)",
    "atan2(x, y*y + 1)",
    "atan2(x - 1, sin(y))",
    "sinc(x)",
    "sinc(r)",
    "sinc(x*y)",
    "erf(x)",
    "erf(x*y)",
    "gamma(x)",
    "j0(x)",
    "j1(x*y)",
    "y0(x)",
    "y1(x)",
    "x < y ? x : y",
    "if(x*y > 1 && x < 3 || !(y > 2), x^2, 1/y)",
    "x == 0 ? 1 : sin(x)/x",
    "(x <= y) + (x >= 1) - (x != 2)",
    "nan ? x : y",
    "1/0",
    "nan > x ? 1 : 2",
    "ln(-1 - x*x)",
    "3*x^2*y - y^3 + 0.5",
    "1/(1 + 1e8*(x - 0.1371)^2)",
    "3*(1-x)^2*exp(-x^2-(y+1)^2) - 10*(x/5-x^3-y^5)*exp(-x^2-y^2)",
];

fn parsed(text: &str) -> Formula {
    Formula::parse(text, Variables::Plane).expect(text)
}

/// A box about a place where formulas often change their rule, or about any.
fn random_range(random: &mut Random) -> Interval {
    let middle = match random.below(4) {
        // Enclosures know no negative zero.
        0 => random.between(-2.0, 2.0).round() + 0.0,
        1 => random.between(-0.5, 0.5),
        _ => random.between(-5.0, 5.0),
    };
    let size = 10f64.powf(random.between(-6.0, 0.7));
    match random.below(6) {
        0 => Interval::point(middle),
        1 => Interval::new(middle, middle + size),
        2 => Interval::new(middle - size, middle),
        _ => Interval::new(middle - size * random.between(0.0, 1.0), middle + size),
    }
}

/// Some numbers of a range, its ends among them.
fn some(range: Interval, random: &mut Random) -> [f64; 6] {
    let mut inside = || random.between(range.low, range.high).clamp(range.low, range.high);
    [range.low, inside(), inside(), inside(), inside(), range.high]
}

fn is_near(value: f64, range: Interval, error: f64) -> bool {
    range.low - error <= value && value <= range.high + error
}

#[test]
fn samples_of_random_boxes_lie_in_their_jets() {
    let mut random = Random::new(7);
    for &text in FORMULAS {
        let formula = parsed(text);
        let jets = formula.jets();
        let mut room = Vec::new();
        let mut counts = [0; 6];
        for _ in 0..BOXES {
            let (a, b) = (random_range(&mut random), random_range(&mut random));
            let along = [
                [a.width(), 0.0],
                [0.0, b.width()],
                [a.width(), b.width()],
                [a.width(), -b.width()],
            ][random.below(4)];
            let jet = jets.over(a, b, along, &mut room);
            counts[jet.class as usize] += 1;
            check_values(text, &formula, jet, (a, b), &mut random);
            check_slopes(text, &formula, jet, (a, b), along, &mut random);
        }
        // A rule that knows nothing would pass.
        let well = counts[2..].iter().sum::<usize>();
        let is_nowhere = ["1/0", "ln(-1 - x*x)", "(-2)^x"].contains(&text);
        assert!(is_nowhere || well > BOXES / 9, "{text}: {counts:?}");
    }
}

fn check_values(
    text: &str,
    formula: &Formula,
    jet: Jet,
    (a, b): (Interval, Interval),
    random: &mut Random,
) {
    for x in some(a, random) {
        for y in some(b, random) {
            let value = formula.value(x, y);
            let place = format!("{text} at {x:?}, {y:?}: {value:?}, {jet:?}");
            match jet.class {
                Class::Nowhere => assert!(!value.is_finite(), "{place}"),
                Class::Partial => {
                    assert!(!value.is_finite() || jet.value.contains(value), "{place}")
                }
                _ => assert!(jet.value.contains(value), "{place}"),
            }
        }
    }
}

/// Differences of samples are slopes somewhere between them, and differences of those second
/// derivatives.
fn check_slopes(
    text: &str,
    formula: &Formula,
    jet: Jet,
    (a, b): (Interval, Interval),
    along: [f64; 2],
    random: &mut Random,
) {
    if jet.class < Class::Lipschitz {
        return;
    }
    let start = |range: Interval, step: f64, t: f64| {
        if step < 0.0 { range.high + step * t } else { range.low + step * t }
    };
    let fixed = [random.between(a.low, a.high), random.between(b.low, b.high)];
    let at = |t: f64| {
        let x = if along[0] == 0.0 { fixed[0] } else { start(a, along[0], t) };
        let y = if along[1] == 0.0 { fixed[1] } else { start(b, along[1], t) };
        formula.value(x.clamp(a.low, a.high), y.clamp(b.low, b.high))
    };
    let t = random.between(0.1, 0.9);
    let h = random.between(0.01, 0.1);
    let [before, here, after] = [t - h, t, t + h].map(at);
    // Rounding of the samples, and of t times a step that is as large as the place.
    let size = 1.0 + jet.value.largest().min(1e30);
    let drift = if jet.first.is_bounded() { jet.first.largest() } else { return };
    let rounded = |range: Interval, step: f64| {
        if step == 0.0 { 0.0 } else { 1e-15 * range.largest() / step.abs().max(1e-300) }
    };
    let place = rounded(a, along[0]) + rounded(b, along[1]);
    let error = 1e-14 * size + drift * place;
    let slope = (after - here) / h;
    assert!(
        is_near(slope, jet.first, 2.0 * error / h),
        "{text} over {a:?}, {b:?}: slope {slope}, {jet:?}"
    );
    if jet.class == Class::Smooth {
        let bend = (after - 2.0 * here + before) / (h * h);
        let is_inside = is_near(bend, jet.second, 4.0 * error / (h * h));
        assert!(is_inside, "{text} over {a:?}, {b:?}: second {bend}, {jet:?}");
    }
}

fn as_theirs(range: Interval) -> maryada::Interval {
    maryada::Interval::nums_to_interval(range.low, range.high, &mut ())
}

#[test]
fn functions_enclose_what_another_library_does() {
    let mut random = Random::new(11);
    type Theirs = fn(maryada::Interval) -> maryada::Interval;
    let functions: [(&str, Theirs); 19] = [
        ("sin(x)", maryada::sin),
        ("cos(x)", maryada::cos),
        ("tan(x)", maryada::tan),
        ("asin(x)", maryada::asin),
        ("acos(x)", maryada::acos),
        ("atan(x)", maryada::atan),
        ("sinh(x)", maryada::sinh),
        ("cosh(x)", maryada::cosh),
        ("tanh(x)", maryada::tanh),
        ("asinh(x)", maryada::asinh),
        ("acosh(x)", maryada::acosh),
        ("atanh(x)", maryada::atanh),
        ("sqrt(x)", maryada::sqrt),
        ("exp(x)", maryada::exp),
        ("ln(x)", maryada::log),
        ("log2(x)", maryada::log2),
        ("log10(x)", maryada::log10),
        ("x*x", maryada::sqr),
        ("1/x", maryada::recip),
    ];
    for (text, theirs) in functions {
        let jets = parsed(text).jets();
        let mut room = Vec::new();
        for _ in 0..BOXES / 4 {
            let range = random_range(&mut random);
            let jet = jets.over(range, Interval::ZERO, [1.0, 0.0], &mut room);
            // The real value of each number.
            for x in some(range, &mut random) {
                let value = theirs(as_theirs(Interval::point(x)));
                if maryada::is_empty(value) {
                    continue;
                }
                let value = Interval::new(maryada::inf(value), maryada::sup(value));
                assert!(jet.value.overlaps(value), "{text} at {x:?}: {value:?}, {jet:?}");
            }
            // Not much more than they enclose.
            if jet.class >= Class::Defined && range.largest() < 100.0 {
                let theirs = theirs(as_theirs(range));
                let (low, high) = (maryada::inf(theirs), maryada::sup(theirs));
                let slack = 1e-14 * (1.0 + jet.value.largest());
                let is_close = jet.value.low >= low - slack && jet.value.high <= high + slack;
                assert!(is_close, "{text} over {range:?}: {jet:?}, {low} to {high}");
            }
        }
    }
}

#[test]
fn products_and_powers_enclose_what_another_library_does() {
    let mut random = Random::new(12);
    type Theirs = fn(maryada::Interval, maryada::Interval) -> maryada::Interval;
    let functions: [(&str, Theirs); 9] = [
        ("x + y", maryada::add),
        ("x - y", maryada::sub),
        ("x*y", maryada::mul),
        ("x/y", maryada::div),
        ("min(x, y)", maryada::min),
        ("max(x, y)", maryada::max),
        ("x^y", maryada::pow),
        ("atan2(x, y)", maryada::atan2),
        ("hypot(x, y)", |x, y| maryada::sqrt(maryada::add(maryada::sqr(x), maryada::sqr(y)))),
    ];
    for (text, theirs) in functions {
        let jets = parsed(text).jets();
        let mut room = Vec::new();
        for _ in 0..BOXES {
            let (a, b) = (random_range(&mut random), random_range(&mut random));
            let jet = jets.over(a, b, [1.0, 0.0], &mut room);
            let both = theirs(as_theirs(a), as_theirs(b));
            // Theirs are powers of numbers that are not negative.
            let is_other = text == "x^y" && a.low < 0.0;
            if jet.class < Class::Continuous || maryada::is_empty(both) || is_other {
                continue;
            }
            let (low, high) = (maryada::inf(both), maryada::sup(both));
            let slack = 1e-13 * (1.0 + jet.value.largest());
            let is_close =
                (jet.value.low - low).abs() <= slack && (jet.value.high - high).abs() <= slack;
            assert!(is_close, "{text} over {a:?}, {b:?}: {jet:?}, {low} to {high}");
        }
    }
}

#[test]
fn equal_operands_are_squares() {
    let over = |text: &str| {
        let range = Interval::new(-1.0, 1.0);
        parsed(text).jets().over(range, range, [1.0, 0.0], &mut Vec::new())
    };
    for text in ["x*x", "(x + y - y)*(x + y - y)", "x^2"] {
        assert_eq!(over(text).value.low, 0.0, "{text}");
    }
    assert_eq!(over("x*x").class, Class::Smooth);
    assert!(over("sqrt(x*x + y*y)").class >= Class::Continuous);
}

#[test]
fn classes_say_where_formulas_end_jump_and_bend() {
    let over = |text: &str, low: f64, high: f64| {
        let jets = parsed(text).jets();
        jets.over(Interval::new(low, high), Interval::new(-0.5, 0.5), [1.0, 0.0], &mut Vec::new())
            .class
    };
    for (text, low, high, class) in [
        ("1/x", -1.0, 1.0, Class::Partial),
        ("1/x", 0.5, 1.0, Class::Smooth),
        ("1/(x - x)", 0.5, 0.5, Class::Nowhere),
        ("floor(x)", 0.5, 1.5, Class::Defined),
        ("floor(x)", 0.5, 0.9, Class::Smooth),
        ("abs(x)", -1.0, 1.0, Class::Lipschitz),
        ("abs(x)", 0.0, 1.0, Class::Smooth),
        ("sqrt(x)", 0.0, 1.0, Class::Continuous),
        ("sqrt(x)", -1.0, 1.0, Class::Partial),
        ("sqrt(x)", -2.0, -1.0, Class::Nowhere),
        ("cbrt(x)", -1.0, 1.0, Class::Continuous),
        ("r", -1.0, 1.0, Class::Lipschitz),
        ("theta", -1.0, -0.5, Class::Defined),
        ("theta", 0.5, 1.0, Class::Smooth),
        ("tan(x)", 1.5, 1.6, Class::Partial),
        ("tan(x)", 1.6, 4.7, Class::Smooth),
        ("if(x > 0, x, 0)", -1.0, 1.0, Class::Defined),
        ("if(x > 0, x, 1/0)", -1.0, 1.0, Class::Partial),
        ("if(x > 0, x, 1/0)", 0.5, 1.0, Class::Smooth),
        ("min(x, 1/x)", -1.0, 1.0, Class::Partial),
        ("exp(1000*x)", 0.5, 1.0, Class::Partial),
        ("sign(floor(x))", 1.5, 2.5, Class::Smooth),
        ("gamma(x)", 0.5, 1.0, Class::Continuous),
        ("x^2.5", 0.0, 1.0, Class::Smooth),
        ("x^1.5", 0.0, 1.0, Class::Lipschitz),
        ("x^0.5", 0.0, 1.0, Class::Continuous),
        ("x^-0.5", 0.0, 1.0, Class::Partial),
        ("x^1.5", 0.5, 1.0, Class::Smooth),
    ] {
        assert_eq!(over(text, low, high), class, "{text} from {low} to {high}");
    }
}

#[test]
fn a_line_gives_what_a_box_of_no_width_gives() {
    let mut random = Random::new(5);
    for &text in FORMULAS {
        let jets = parsed(text).jets();
        let mut room = Vec::new();
        for axis in [Axis::First, Axis::Second] {
            let mut line = jets.along(axis);
            let at = random.between(-3.0, 3.0);
            line.go_to(at);
            for _ in 0..4 {
                let (range, fixed) = (random_range(&mut random), Interval::point(at));
                let boxed = match axis {
                    Axis::First => jets.over(range, fixed, [1.0, 0.0], &mut room),
                    Axis::Second => jets.over(fixed, range, [0.0, 1.0], &mut room),
                };
                assert_eq!(line.over(range), boxed, "{text}");
            }
        }
    }
}

#[test]
fn rounded_operations_enclose_the_exact_ones() {
    let mut random = Random::new(13);
    let graphs = ["1/x", "x/y", "x*y", "x + y", "x^2", "sqrt(x)"].map(|text| parsed(text).jets());
    let mut room = Vec::new();
    for _ in 0..2000 {
        let [a, b] = [0; 2].map(|_| random.between(1.0, 2.0));
        let signed = |x: f64, random: &mut Random| if random.below(2) == 0 { x } else { -x };
        let (a, b) = (signed(a, &mut random), signed(b, &mut random));
        let values: Vec<Interval> = graphs
            .iter()
            .map(|jets| {
                let [x, y] = [a, b].map(Interval::point);
                jets.over(x, y, [1.0, 0.0], &mut room).value
            })
            .collect();
        // A multiplication and an addition are rounded together, so the sign of the result is right.
        let exceeds = |quotient: f64, above: f64, below: f64| {
            quotient.mul_add(below, -above) * below.signum()
        };
        let reciprocal = Interval::point(a).recip();
        for (value, above, below) in [(reciprocal, 1.0, a), (values[0], 1.0, a), (values[1], a, b)]
        {
            let (low, high) = (exceeds(value.low, above, below), exceeds(value.high, above, below));
            assert!(low <= 0.0 && high >= 0.0, "{above} / {below}: {value:?}");
        }
        for (value, a, b) in [(values[2], a, b), (values[4], a, a)] {
            assert!(a.mul_add(b, -value.low) >= 0.0, "{a} · {b}: {value:?}");
            assert!(a.mul_add(b, -value.high) <= 0.0, "{a} · {b}: {value:?}");
        }
        // What rounding takes off a sum.
        let sum = a + b;
        let of_b = sum - a;
        let rest = (a - (sum - of_b)) + (b - of_b);
        assert!(values[3].low - sum <= rest && rest <= values[3].high - sum, "{a} + {b}");
        if a > 0.0 {
            let Interval { low, high } = values[5];
            assert!(low.mul_add(low, -a) <= 0.0 && high.mul_add(high, -a) >= 0.0, "√{a}");
        }
    }
}

#[test]
fn poles_of_the_tangent_are_found_between_neighboring_numbers() {
    let mut random = Random::new(14);
    let jets = parsed("tan(x)").jets();
    let (mut room, mut n_checked) = (Vec::new(), 0);
    for _ in 0..4000 {
        let quarters = 2.0 * random.between(0.0, 1e3).powi(3).floor() + 1.0;
        let mut x = quarters * std::f64::consts::FRAC_PI_2;
        (0..8).for_each(|_| x = x.next_down());
        // The tangent is positive before a pole and negative after it.
        for _ in 0..16 {
            let next = x.next_up();
            if libm::tan(x) > 0.0 && libm::tan(next) < 0.0 {
                let jet = jets.over(Interval::new(x, next), Interval::ZERO, [1.0, 0.0], &mut room);
                assert!(jet.class <= Class::Partial, "{quarters} quarter turns: {jet:?}");
                n_checked += 1;
            }
            x = next;
        }
    }
    assert!(n_checked > 1000, "{n_checked}");
}

#[test]
fn logarithmic_axes_are_enclosed_in_their_own_coordinates() {
    let mut random = Random::new(15);
    let scale = |factor: f64, is_log: bool| AxisScale { factor, is_log };
    let scales = [scale(2.0, true), scale(0.5, true), scale(3.0, true)];
    let drawn = |text: &str, u: f64, v: f64| {
        let [x, y] = [u / 2.0, v / 0.5].map(|at| libm::pow(10.0, at));
        3.0 * libm::log10(parsed(text).value(x, y))
    };
    for text in ["x", "x*y + 1", "exp(x/10)", "r", "2 + sin(x)*cos(y)", "x^2 + y^3"] {
        let jets = parsed(text).jets().scaled(scales);
        let mut room = Vec::new();
        for _ in 0..200 {
            let [u, v] = [0; 2].map(|_| random.between(-1.0, 1.0));
            let size = 0.1 * random.between(0.0, 1.0);
            let a = Interval::new(u, u + size);
            let jet = jets.over(a, Interval::point(v), [1.0, 0.0], &mut room);
            let at = |part: f64| drawn(text, u + part * size, v);
            for part in [0.0, 0.3, 1.0] {
                assert!(is_near(at(part), jet.value, 1e-12), "{text}: {} {jet:?}", at(part));
            }
            if size > 1e-3 && jet.class == Class::Smooth {
                // Somewhere the slope is that of the chord.
                let slope = (at(1.0) - at(0.0)) / size;
                assert!(is_near(slope, jet.first, 1e-9), "{text}: {slope} {jet:?}");
            }
        }
    }
}

#[test]
fn a_branch_without_values_does_not_widen_those_of_the_other() {
    let range = Interval::new(-1.0, 1.0);
    for text in ["x > 0 ? nan : 2 + x", "x > 0 ? 2 + x : nan"] {
        let jet = parsed(text).jets().over(range, range, [1.0, 0.0], &mut Vec::new());
        let Interval { low, high } = jet.value;
        assert!(low <= 1.0 && high >= 3.0 && low > 0.9 && high < 3.1, "{text}: {low} to {high}");
        assert_eq!(jet.class, Class::Partial, "{text}");
    }
}
