//! Choices of the library on the command line: one parser for every enum with `ALL` and names.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use hiddenline::stages::camera::framing::{NamedView, ProjectionKind};
use hiddenline::stages::write::Format;
use hiddenline::stages::write::svg::StrokeElement;

/// A value of an enum that the command line names as the library does.
pub(super) trait Choice: Copy + Send + Sync + 'static {
    /// Every value, in the order of the documentation.
    const ALL: &'static [Self];

    /// The name as it is typed.
    fn name(self) -> &'static str;
}

/// Implements [`Choice`] by the `ALL` and `name` of the types.
macro_rules! choices {
    ($($choice:ty),*) => {
        $(impl Choice for $choice {
            const ALL: &'static [Self] = &<$choice>::ALL;

            fn name(self) -> &'static str {
                self.name()
            }
        })*
    };
}

choices!(Format, NamedView, ProjectionKind, StrokeElement);

/// Takes the names of all values; help lists them, and messages suggest them.
pub(super) fn one_of<T: Choice>() -> impl TypedValueParser<Value = T> {
    let values = T::ALL.iter().map(|choice| PossibleValue::new(choice.name()));
    PossibleValuesParser::new(values).try_map(|name| {
        let found = T::ALL.iter().copied().find(|choice| choice.name() == name);
        found.ok_or("unknown name")
    })
}
