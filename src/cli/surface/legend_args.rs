//! Legend options.

use clap::{Args, ValueEnum};
use hiddenline::stages::axes::LegendPlace;
use hiddenline::stages::draw::surface::Legend;

use super::input::SurfaceInput;
use crate::cli::values;

#[derive(Args)]
#[command(next_help_heading = "Axes")]
pub(super) struct LegendArgs {
    /// Add a legend of sheets and levels, to the right of the drawing unless a place is given
    ///
    /// If there are several sheets, each then has its own pen: 1, 2, 3 and so on. Sheets whose pens have the
    /// same color and width are dashed.
    #[arg(long, value_enum, value_name = "PLACE")]
    legend: Option<PlaceName>,
    /// Sheet names for the legend, separated by commas; `\,` is a comma in a name
    ///
    /// {a} stands for the value of a parameter, as in --for a=1,2 --names "a = {a}". By default sheets are
    /// named by their formulas, or by the values of --for.
    #[arg(long, value_name = "NAMES", value_parser = names, allow_hyphen_values = true)]
    names: Option<Names>,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum PlaceName {
    Left,
    /// The place if none is given
    Right,
    Top,
    Bottom,
    /// No legend
    None,
}

/// Names of sheets.
#[derive(Debug, Clone)]
struct Names(Vec<String>);

fn names(text: &str) -> Result<Names, String> {
    Ok(Names(values::with_commas(text).iter().map(|name| name.trim().to_owned()).collect()))
}

impl LegendArgs {
    /// Names the sheets; the legend, if there is to be one. The error is a message about usage.
    pub(super) fn legend(self, sheets: &mut SurfaceInput) -> Result<Option<Legend>, String> {
        if let Some(Names(names)) = &self.names {
            sheets.name_sheets(names)?;
        }
        let place = match self.legend {
            None | Some(PlaceName::None) => return Ok(None),
            Some(PlaceName::Left) => LegendPlace::Left,
            Some(PlaceName::Right) => LegendPlace::Right,
            Some(PlaceName::Top) => LegendPlace::Top,
            Some(PlaceName::Bottom) => LegendPlace::Bottom,
        };
        Ok(Some(place.into()))
    }
}
