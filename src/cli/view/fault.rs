//! Why a request failed, with the place of the error.

use clap::error::{ContextKind, ContextValue};
use hiddenline::stages::surface::formula::{Formula, FormulaError, Parameter, Problem, Variables};
use serde::Serialize;

use super::composed::Composed;
use super::declared::DRAW;

/// What is wrong with a request.
#[derive(Debug, Default, Serialize)]
pub(super) struct Fault {
    pub(super) error: String,
    /// The option that it is about.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) option: Option<String>,
    /// Which value of that option, counted from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) index: Option<usize>,
    /// The character of a formula, counted from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) column: Option<usize>,
    /// A letter that would be a parameter if it had a value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) parameter: Option<String>,
}

impl Fault {
    pub(super) fn of(error: impl Into<String>) -> Self {
        Self { error: error.into(), ..Self::default() }
    }

    fn of_formula(option: &str, index: usize, error: &FormulaError) -> Self {
        let parameter = match &error.problem {
            Problem::UnknownName { name, near: None } if name.chars().count() == 1 => {
                Some(name.clone())
            }
            _ => None,
        };
        Self {
            error: error.problem.to_string(),
            option: Some(option.to_owned()),
            index: Some(index),
            column: Some(error.column),
            parameter,
        }
    }
}

impl From<clap::Error> for Fault {
    fn from(error: clap::Error) -> Self {
        let option = match error.get(ContextKind::InvalidArg) {
            Some(ContextValue::String(arg)) => {
                let name = arg.trim_start_matches('-').split([' ', '=']).next();
                name.map(str::to_owned)
            }
            _ => None,
        };
        Self { option, ..Self::of(super::message(&error)) }
    }
}

/// Finds the first formula that is none.
pub(super) fn check_formulas(composed: &Composed) -> Result<(), Fault> {
    if composed.name == DRAW {
        return Ok(());
    }
    let subjects = composed.subjects.iter().map(|text| text.to_string_lossy().into_owned());
    let plane = Variables::Plane;
    // Only the names matter here; values are checked with all other options.
    let set = composed.texts("set");
    let names = set.iter().filter_map(|text| text.split_once('='));
    let parameters: Vec<Parameter> =
        names.filter_map(|(name, _)| Parameter::new(name.trim(), 0.0).ok()).collect();
    for (option, texts, variables) in [
        ("expr", subjects.collect(), plane),
        ("where", composed.texts("where"), plane),
        ("parametric", composed.texts("parametric"), Variables::Parameters),
    ] {
        for (index, text) in texts.iter().enumerate() {
            Formula::parse_with(text, variables, &parameters)
                .map_err(|error| Fault::of_formula(option, index, &error))?;
        }
    }
    Ok(())
}
