//! Formulas: meaning, error columns, hostile input.

use hiddenline::stages::surface::formula::{
    CONSTANTS, FUNCTIONS, Formula, MAX_LENGTH, Problem, Variables,
};

fn value(text: &str, x: f64, y: f64) -> f64 {
    match Formula::parse(text, Variables::Plane) {
        Ok(formula) => formula.value(x, y),
        Err(error) => panic!("{text}: {error}"),
    }
}

fn message(text: &str) -> String {
    Formula::parse(text, Variables::Plane).expect_err(text).to_string()
}

#[test]
fn operators_bind_as_in_mathematics() {
    for (text, expected) in [
        ("-x^2", -9.0),
        ("2^3^2", 512.0),
        ("2^-1", 0.5),
        ("1e3 + .5", 1000.5),
        ("8 - 3 - 2", 3.0),
        ("8 / 4 / 2", 1.0),
        ("2 + 3 * 4", 14.0),
        ("-2 ** 2", -4.0),
        ("2 * -x", -6.0),
        ("-7 % 3", 2.0),
        ("mod(7, -3)", -2.0),
        ("x < 4 && y > 4", 1.0),
        ("!(x < 4) || y == 5", 1.0),
        ("not x > 1 or y != 5", 0.0),
        ("x > 1 ? y > 9 ? 1 : 2 : 3", 2.0),
        ("x > 9 ? 1 : y > 1 ? 2 : 3", 2.0),
        ("if(x > 9, 1/0, 7)", 7.0),
        ("min(4, x, y) + max(1, x, y, 2)", 8.0),
        ("r", 34f64.sqrt()),
        ("theta", libm::atan2(5.0, 3.0)),
        ("π - pi", 0.0),
        ("2e", f64::NAN),
        ("x² + y³", 134.0),
        ("-x²", -9.0),
        ("2^x²", 512.0),
        ("x²^2", 81.0),
        ("(x - 1)¹⁰", 1024.0),
        ("(x + 1)⁻²", 0.0625),
    ] {
        if text == "2e" {
            assert!(Formula::parse(text, Variables::Plane).is_err());
        } else {
            assert_eq!(value(text, 3.0, 5.0), expected, "{text}");
        }
    }
}

#[test]
fn what_is_not_a_number_is_neither_true_nor_hidden_by_min() {
    assert_eq!(value("nan ? 1 : 2", 0.0, 0.0), 2.0);
    assert_eq!(value("0/0 == 0/0", 0.0, 0.0), 0.0);
    for text in ["min(nan, 1)", "min(1, nan)", "max(nan, 1)", "max(1, nan)"] {
        assert!(value(text, 0.0, 0.0).is_nan(), "{text}");
    }
}

#[test]
fn every_listed_name_is_known() {
    for name in FUNCTIONS {
        let parsed = (1..=3).any(|n| {
            let text = format!("{name}({})", vec!["0.5"; n].join(","));
            Formula::parse(&text, Variables::Plane).is_ok()
        });
        assert!(parsed, "{name}");
    }
    for (name, value_of_it) in CONSTANTS {
        assert_eq!(value(name, 0.0, 0.0).to_bits(), value_of_it.to_bits(), "{name}");
    }
    assert_eq!(value("sinc(0) + gamma(5) + j0(0) + erf(0)", 0.0, 0.0), 26.0);
}

#[test]
fn errors_name_the_column() {
    for (text, expected) in [
        ("", "column 1: the formula is empty"),
        ("1 + sine(x)", "column 5: unknown name `sine`; did you mean `sin`?"),
        ("x + zebra", "column 5: unknown name `zebra`"),
        ("(x + 1", "column 7: expected `)` but found the end of the formula"),
        ("x + * 2", "column 5: expected a value but found `*`"),
        ("x 2", "column 3: expected an operator but found the number 2; write a product as `x*2`"),
        ("2x", "column 2: expected an operator but found `x`; write a product as `2*x`"),
        ("(x+1)(y)", "column 6: expected an operator but found `(`; write a product as `(…)*(…)`"),
        ("x + xy", "column 5: unknown name `xy`; did you mean `x*y`?"),
        ("sin(2x)", "column 6: expected an operator but found `x`; write a product as `2*x`"),
        ("x !", "column 3: expected an operator but found `!`"),
        ("z = x^2", "column 1: a formula is only the right-hand side; leave out `z =`"),
        ("f(x, y) = x", "column 1: a formula is only the right-hand side; leave out `f(…) =`"),
        ("x = 3", "column 3: `=` is not an operator; write a condition with `==`, `<=` or `>=`"),
        (
            "(x = 3) && y",
            "column 4: `=` is not an operator; write a condition with `==`, `<=` or `>=`",
        ),
        ("π + $", "column 5: `$` is not allowed in a formula"),
        ("1.2.3", "column 1: `1.2.3` is not a valid number"),
        ("1e999", "column 1: `1e999` is not a valid number"),
        ("sin + 1", "column 1: `sin` is a function: write `sin(…)`"),
        ("1 + sin(x, y)", "column 5: `sin` takes 1 argument, not 2"),
        ("min(x)", "column 1: `min` takes 2 or more arguments, not 1"),
        ("0 < x < 1", "column 7: comparisons do not chain: write `a < b && b < c`"),
        (
            "x ? 1",
            "column 6: expected `:` and the value otherwise but found the end of the formula",
        ),
        ("u + 1", "column 1: unknown name `u`"),
    ] {
        assert_eq!(message(text), expected, "{text}");
    }
    assert!(Formula::parse("u*cos(v)", Variables::Parameters).is_ok());
    assert!(Formula::parse("x", Variables::Parameters).is_err());
}

#[test]
fn hostile_formulas_are_refused_not_crashed_on() {
    let deep = |open: &str, close: &str| {
        format!("{}x{}", open.repeat(5000 / open.len()), close.repeat(5000 / open.len()))
    };
    for text in [deep("(", ")"), deep("-", ""), deep("sin(", ")"), deep("2^", ""), deep("x?1:", "")]
    {
        let error = Formula::parse(&text, Variables::Plane).expect_err("too deep");
        assert_eq!(error.problem, Problem::TooDeep);
    }
    let long = "x+".repeat(MAX_LENGTH);
    let error = Formula::parse(&long, Variables::Plane).expect_err("too long");
    assert_eq!(error.problem, Problem::TooLong);
    // Long but flat is fine.
    assert_eq!(value(&format!("{}0", "x+".repeat(9000)), 1.0, 0.0), 9000.0);
}

#[test]
fn blocks_of_samples_give_the_same_as_single_ones() {
    let formula = Formula::parse("x > y ? sin(x*y) : r^3 % 0.7", Variables::Plane).expect("valid");
    let x: Vec<f64> = (0..1000).map(|k| f64::from(k % 37) * 0.31 - 5.0).collect();
    let y: Vec<f64> = (0..1000).map(|k| f64::from(k % 53) * 0.17 - 4.0).collect();
    let mut out = vec![0.0; 1000];
    formula.values(&x, &y, &mut out);
    for k in 0..1000 {
        assert_eq!(out[k].to_bits(), formula.value(x[k], y[k]).to_bits());
    }
}

proptest::proptest! {
    #[test]
    fn no_text_makes_the_parser_panic(text in "[-+*/^%()<>=!&|?:,. a-z0-9πθ²⁰⁻]{0,60}") {
        if let Ok(formula) = Formula::parse(&text, Variables::Plane) {
            formula.value(0.5, -2.0);
        }
    }
}
