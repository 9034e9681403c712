//! Axis options.

use clap::{Args, ValueEnum};
use hiddenline::stages::axes::{Axes, AxesStyle, BoxFront, TickRule, Titles, ZAxis};

use super::input_args::AxisName;
use crate::cli::choice::one_of;
use crate::cli::values;

#[derive(Args)]
#[command(next_help_heading = "Axes")]
pub(in crate::cli) struct AxesArgs {
    /// Axes around the surface [default: edges, but frame in top views]
    #[arg(long, value_enum, value_name = "STYLE")]
    axes: Option<StyleName>,
    /// Leave out axes and titles, like --axes none; implied by --exact
    #[arg(long, conflicts_with_all = ["title", "axis_titles", "axes"])]
    no_axes: bool,
    /// Edges of --axes box in front of the surface
    #[arg(long, value_parser = one_of::<BoxFront>(), default_value = BoxFront::Dashed.name())]
    box_front: BoxFront,
    /// Side of the drawing with the z axis
    #[arg(long, value_parser = one_of::<ZAxis>(), default_value = ZAxis::Left.name())]
    z_axis: ZAxis,
    /// Tick spacing for each axis; `90,,` sets it for x only
    #[arg(long, value_name = "X,Y,Z", value_parser = steps)]
    tick_step: Option<Steps>,
    /// Axes with ticks at multiples of π, labeled with π
    #[arg(long, value_enum, value_delimiter = ',', value_name = "AXES")]
    ticks_pi: Vec<AxisName>,
    /// Title above the drawing
    #[arg(long, value_name = "TEXT", allow_hyphen_values = true)]
    title: Option<String>,
    /// Axis titles; `s^{-1}` is superscript, `x_{0}` is subscript, and `\,` is a comma in a title
    #[arg(long, value_name = "X,Y,Z", default_value = "x,y,z", value_parser = axis_titles)]
    #[arg(allow_hyphen_values = true)]
    axis_titles: AxisTitles,
    /// Height of numbers in millimeters, or a length such as 0.1in; titles are slightly larger [default: to
    /// suit the page and the pen]
    #[arg(long, value_name = "MM", value_parser = values::positive_length)]
    text_height: Option<f64>,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum StyleName {
    /// Three edges of the box
    Edges,
    /// The same, and the rectangle that the box stands on
    Base,
    /// The three faces behind the surface, with a grid
    Back,
    /// The same, and the other edges of the box
    Box,
    /// The four sides of a map, for --view top and bottom
    Frame,
    /// Neither axes nor titles
    None,
}

/// Titles of the three axes.
#[derive(Debug, Clone)]
struct AxisTitles([String; 3]);

/// Steps between ticks of the three axes, where they are given.
#[derive(Debug, Clone, Copy)]
struct Steps([Option<f64>; 3]);

/// Three titles with commas between them; `\,` is a comma in a title.
fn axis_titles(text: &str) -> Result<AxisTitles, String> {
    let titles = values::with_commas(text).try_into().map_err(
        |_| "expected three axis titles separated by commas; a comma in a title is written `\\,`",
    )?;
    Ok(AxisTitles(titles))
}

/// Three numbers above 0 with commas between them, each of which can be left out.
fn steps(text: &str) -> Result<Steps, String> {
    let step = |text: &str| match text.trim() {
        "" => Ok(None),
        text => values::positive(text).map(Some),
    };
    let steps: Vec<Option<f64>> = text.split(',').map(step).collect::<Result<_, _>>()?;
    let steps =
        steps.try_into().map_err(|_| "expected three steps separated by commas, as in 90,,")?;
    Ok(Steps(steps))
}

impl AxesArgs {
    /// The axes; `None` if there are to be none.
    pub(in crate::cli) fn axes(self, pen_width_mm: f64) -> Result<Option<Axes>, String> {
        let style = match self.axes {
            _ if self.no_axes => return Ok(None),
            Some(StyleName::None) if self.title.is_some() => {
                return Err("--axes none also leaves out the title: use other --axes".into());
            }
            Some(StyleName::None) => return Ok(None),
            Some(StyleName::Edges) => Some(AxesStyle::Edges),
            Some(StyleName::Base) => Some(AxesStyle::Base),
            Some(StyleName::Back) => Some(AxesStyle::Back),
            Some(StyleName::Box) => Some(AxesStyle::Box),
            Some(StyleName::Frame) => Some(AxesStyle::Frame),
            None => None,
        };
        let steps = self.tick_step.map_or([None; 3], |Steps(steps)| steps);
        let mut ticks = [TickRule::Round; 3];
        for (k, name) in AxisName::ALL.into_iter().enumerate() {
            ticks[k] = match (steps[k], self.ticks_pi.contains(&name)) {
                (Some(_), true) => {
                    return Err("--tick-step and --ticks-pi are given for the same axis".into());
                }
                (Some(step), false) => TickRule::Step(step),
                (None, true) => TickRule::Pi,
                (None, false) => TickRule::Round,
            };
        }
        let AxisTitles(axes) = self.axis_titles;
        Ok(Some(Axes {
            style,
            titles: Titles { axes, drawing: self.title.unwrap_or_default() },
            box_front: self.box_front,
            z_axis: self.z_axis,
            ticks,
            text_height_mm: self.text_height,
            pen_width_mm,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comma_in_a_title_is_escaped() {
        let of = |text| axis_titles(text).map(|AxisTitles(titles)| titles);
        assert_eq!(of(r"a\,b,c,"), Ok(["a,b", "c", ""].map(str::to_owned)));
        assert_eq!(of(r"\alpha,y,z"), Ok([r"\alpha", "y", "z"].map(str::to_owned)));
        assert!(of("x,y").is_err() && of("a,b,c,d").is_err());
    }

    #[test]
    fn steps_can_be_given_for_some_axes() {
        let of = |text| steps(text).map(|Steps(steps)| steps);
        assert_eq!(of("90,,"), Ok([Some(90.0), None, None]));
        assert_eq!(of("1, 0.5 ,2"), Ok([Some(1.0), Some(0.5), Some(2.0)]));
        assert!(of("90").is_err() && of("0,,").is_err() && of("a,,").is_err());
    }
}
