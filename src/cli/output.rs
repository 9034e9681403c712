//! The output: file, format, and messages.

mod place;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use hiddenline::stages::optimize::estimate::Motion;
use hiddenline::stages::page::PageOptions;
use hiddenline::stages::write::dxf::DxfScale;
use hiddenline::stages::write::hpgl::Plotter;
use hiddenline::stages::write::png::{Marks, Resolution};
use hiddenline::stages::write::svg::StrokeElement;
use hiddenline::stages::write::{Format, Target};

pub(super) use self::place::check_place;
use super::choice::one_of;
use super::machine::Machine;
use super::paths::is_dash;
use super::plotting::{PlotArgs, Plotting};
use super::{Refused, config, values};

#[derive(Args)]
#[command(next_help_heading = "Output")]
pub(super) struct OutputArgs {
    /// File to write, in the format given by its extension; `-` is standard output
    ///
    /// .svg; .hpgl, .plt; .gcode, .nc, .ngc; .pdf; .dxf; .png; .json
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Format of the output [default: by extension; svg on standard output]
    #[arg(long, value_parser = one_of::<Format>())]
    format: Option<Format>,
    /// SVG element written for each stroke
    #[arg(long, value_name = "ELEMENT", value_parser = one_of::<StrokeElement>())]
    #[arg(default_value = StrokeElement::default().name())]
    svg_element: StrokeElement,
    /// Resolution of a PNG in pixels per inch [default: 150]
    #[arg(long, value_parser = values::positive, conflicts_with = "png_width")]
    dpi: Option<f64>,
    /// Width of a PNG in pixels
    #[arg(long, value_name = "PX", value_parser = clap::value_parser!(u32).range(1..))]
    png_width: Option<u32>,
    /// Show pen movement in a PNG: travel, order, or both, separated by a comma
    ///
    /// travel: pen-up travel as thin red lines; order: strokes from blue (first) through green to red
    /// (last).
    #[arg(long, value_name = "WHAT", value_enum, value_delimiter = ',')]
    png_show: Vec<PngMark>,
    /// How dashed lines are written in DXF: one line per dash, or whole lines with a linetype
    ///
    /// CAM programs need lines; CAD programs can draw and edit native dashes.
    #[arg(long, value_name = "HOW", value_enum, default_value = "lines")]
    dxf_dashes: DxfDashes,
    /// Number of threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Print counts and times as JSON, on the last line of standard error
    #[arg(long)]
    stats: bool,
    /// Print nothing but errors
    #[arg(short, long, conflicts_with = "verbose")]
    quiet: bool,
    /// Print more detail
    #[arg(short, long)]
    verbose: bool,
    /// Treat warnings as errors: exit with status 1 and write nothing
    #[arg(long)]
    strict: bool,
    /// Use the preset NAME from the configuration files
    #[arg(long, value_name = "NAME")]
    preset: Option<String>,
    #[command(flatten)]
    plotting: PlotArgs,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum DxfDashes {
    /// One line per dash
    Lines,
    /// Whole lines with a linetype
    Native,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum PngMark {
    /// Pen-up travel
    Travel,
    /// Stroke order
    Order,
}

/// Checked options of the output.
pub(super) struct OutputOptions {
    /// `None` is standard output.
    pub(super) path: Option<PathBuf>,
    /// Whether `-o -` asks for standard output.
    pub(super) is_dash: bool,
    pub(super) format: Format,
    /// What plots are written as; `None` for formats that hold more than a plot.
    pub(super) target: Option<Target>,
    /// How the machine moves.
    pub(super) motion: Motion,
    /// Whether dashed lines are written whole, for the format to draw the dashes.
    pub(super) keeps_dashes_whole: bool,
    pub(super) threads: Option<usize>,
    pub(super) stats: bool,
    pub(super) quiet: bool,
    pub(super) verbose: bool,
    pub(super) strict: bool,
    pub(super) plotting: Plotting,
    /// Files that these options name.
    pub(super) inputs: Vec<PathBuf>,
    /// About options that have no effect.
    pub(super) warnings: Vec<String>,
}

impl OutputArgs {
    /// Checks what clap cannot; the error is a message about usage.
    ///
    /// With `exact`, strokes are to be left as they are.
    pub(super) fn options(self, exact: bool) -> Result<OutputOptions, Refused> {
        let is_dash_typed = self.output.as_deref().is_some_and(is_dash);
        let path = self.output.filter(|path| !is_dash(path));
        let format = output_format(self.format, path.as_deref())?;
        let Machine { target, motion } = self.plotting.machine(format)?;
        let resolution = match (self.dpi, self.png_width) {
            (_, Some(width)) => Resolution::WidthPx(width),
            (Some(dpi), None) => Resolution::Dpi(dpi),
            (None, None) => Resolution::default(),
        };
        let marks = Marks {
            travel: self.png_show.contains(&PngMark::Travel),
            order: self.png_show.contains(&PngMark::Order),
        };
        let target = match format {
            Format::Svg => Some(Target::Svg(self.svg_element)),
            Format::Pdf => Some(Target::Pdf),
            // The scale follows once the models have said their unit.
            Format::Dxf => Some(Target::Dxf(DxfScale::default())),
            Format::Png => Some(Target::Png(resolution, marks)),
            Format::Hpgl | Format::Gcode => target,
            Format::Json => None,
        };
        let mut warnings = without_effect(format);
        warnings.extend(self.plotting.shortened_overlap());
        warnings.extend(self.plotting.idle_controls(format));
        warnings.extend(config::unknown_variables());
        Ok(OutputOptions {
            inputs: self.plotting.inputs(),
            warnings,
            plotting: self.plotting.options(exact, format)?,
            keeps_dashes_whole: format == Format::Dxf && self.dxf_dashes == DxfDashes::Native,
            target,
            motion,
            format,
            path,
            is_dash: is_dash_typed,
            threads: self.threads.map(usize::from),
            stats: self.stats,
            quiet: self.quiet,
            verbose: self.verbose,
            strict: self.strict,
        })
    }
}

impl OutputOptions {
    /// The output of a picture, which no pen draws: a PNG.
    pub(super) fn picture(
        path: Option<PathBuf>,
        threads: Option<usize>,
        stats: bool,
        quiet: bool,
    ) -> Self {
        Self {
            path,
            is_dash: false,
            format: Format::Png,
            target: None,
            motion: Motion::default(),
            threads,
            stats,
            quiet,
            verbose: false,
            strict: false,
            plotting: Plotting::default(),
            keeps_dashes_whole: false,
            inputs: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// The plotter that HPGL is written for.
    pub(super) fn plotter(&self) -> Option<&Plotter> {
        match &self.target {
            Some(Target::Hpgl(plotter)) => Some(plotter),
            _ => None,
        }
    }

    /// The page with a margin so wide that the pen reaches everything between the margins.
    pub(super) fn within_reach(&self, page: PageOptions) -> PageOptions {
        let Some(plotter) = self.plotter() else { return page };
        let border_mm = plotter.unreachable_border_mm(page.paper.width_mm, page.paper.height_mm);
        PageOptions { margin_mm: page.margin_mm.max(border_mm.unwrap_or(0.0)), ..page }
    }
}

/// Warnings about options on the command line that are for a different format.
fn without_effect(format: Format) -> Vec<String> {
    let for_png = ["--dpi", "--png-width", "--png-show"].map(|option| (option, Format::Png));
    let others = [("--svg-element", Format::Svg), ("--dxf-dashes", Format::Dxf)];
    let other = |(option, of): &(&str, Format)| *of != format && config::is_typed(option);
    let options = for_png.into_iter().chain(others).filter(other);
    let warning = |(option, of): (&str, Format)| {
        let (format, of) = (format.name(), of.name());
        format!("{option} has no effect on {format}; it is for {of}")
    };
    options.map(warning).collect()
}

fn output_format(typed: Option<Format>, path: Option<&Path>) -> Result<Format, String> {
    match (typed, path) {
        (Some(format), _) => Ok(format),
        (None, None) => Ok(Format::Svg),
        (None, Some(path)) => Format::from_path(path).ok_or_else(|| {
            let known = Format::ALL.iter().flat_map(|format| format.extensions());
            let known: Vec<String> = known.map(|extension| format!(".{extension}")).collect();
            let known = known.join(", ");
            format!("`{}` has none of the extensions {known}; use --format", path.display())
        }),
    }
}
