//! Input options of surfaces, shared by drawings, fills and pictures.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use hiddenline::stages::surface::formula::{
    Formula, MAX_VALUES, Parameter, ParameterList, Variables,
};
use hiddenline::stages::surface::{
    Aspect, Duplicates, FormulaSheet, HeightOptions, MAX_SAMPLES, Outside, name_of_values, typeset,
};

use super::input::{SurfaceInput, SurfaceSource};
use crate::cli::choice::one_of;
use crate::cli::config;
use crate::cli::formulas::in_formula;
use crate::cli::values;

/// Everything but the formulas, which `surface` takes without the name of an option; each command
/// that has this has an argument of the name `expression` for them.
#[derive(Args)]
#[command(next_help_heading = "Surface")]
pub(in crate::cli) struct SurfaceInputArgs {
    /// Read heights from a file; `-` is standard input
    ///
    /// Rows of numbers, ESRI ASCII grid, NPY, NPZ, or a gray PNG or TIFF, recognized by content.
    #[arg(long, value_name = "FILE", conflicts_with = "expression")]
    grid: Option<PathBuf>,
    /// Read scattered points from a file with x, y and z on each line; `-` is standard input
    #[arg(long, value_name = "FILE", conflicts_with_all = ["expression", "grid", "x", "y"])]
    points: Option<PathBuf>,
    /// Three formulas of u and v, for x, y and z
    #[arg(long, value_names = ["X", "Y", "Z"], num_args = 3, allow_hyphen_values = true)]
    #[arg(value_parser = parametric)]
    #[arg(conflicts_with_all = ["expression", "grid", "points", "x", "y"])]
    parametric: Option<Vec<String>>,
    /// Range of u; its ends may be formulas such as 2*pi [default: 0:1]
    #[arg(long, value_name = "A:B", value_parser = range, allow_hyphen_values = true)]
    #[arg(requires = "parametric")]
    u: Option<(f64, f64)>,
    /// Range of v [default: 0:1]
    #[arg(long, value_name = "A:B", value_parser = range, allow_hyphen_values = true)]
    #[arg(requires = "parametric")]
    v: Option<(f64, f64)>,
    /// Domain of the surface, as a condition on x and y such as x^2+y^2<=9
    ///
    /// The surface is cut along the border of its domain. `surface` draws the border together with grid
    /// lines, or with --lines border.
    #[arg(long = "where", value_name = "EXPR", requires = "expression")]
    domain: Option<String>,
    /// Set a parameter of the formulas, as in a=2; may be repeated
    ///
    /// The name is then a constant in all formulas and in --where. It must not be a name that formulas
    /// already define, such as x or pi.
    #[arg(long, value_name = "NAME=VALUE", value_parser = parameter, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["grid", "points"])]
    set: Vec<Parameter>,
    /// Draw one sheet per value of a parameter, as in a=1,2,3 or a=0:1:0.25; repeat for all combinations
    ///
    /// a=FROM:TO:STEP takes evenly spaced values. The name is then a constant in all formulas and
    /// conditions. In sheet names, {a} stands for the value. At most 32 sheets can be drawn.
    #[arg(long = "for", value_name = "NAME=VALUES", value_parser = parameter_list)]
    #[arg(allow_hyphen_values = true, conflicts_with_all = ["grid", "points", "parametric"])]
    for_each: Vec<ParameterList>,
    /// Range of x; 5:-5 reverses the axis [default: -5:5; for files, 0 to columns - 1]
    #[arg(long, value_name = "A:B", value_parser = either_way, allow_hyphen_values = true)]
    x: Option<(f64, f64)>,
    /// Range of y, as for x [default: -5:5; for files, 0 to rows - 1]
    #[arg(long, value_name = "A:B", value_parser = either_way, allow_hyphen_values = true)]
    y: Option<(f64, f64)>,
    /// Range of heights, as for x; the surface is cut off outside it [default: all, except at poles]
    #[arg(long, value_name = "A:B", value_parser = either_way, allow_hyphen_values = true)]
    z: Option<(f64, f64)>,
    /// What to do with heights outside --z
    #[arg(long, value_parser = one_of::<Outside>(), default_value = Outside::Cut.name())]
    z_outside: Outside,
    /// Samples along each axis, or along x and along y [default: 81; for `preview`, 200]
    #[arg(long, value_name = "N|NxM", value_parser = samples, conflicts_with_all = ["grid", "points"])]
    samples: Option<(usize, usize)>,
    /// The first row of the file has the largest y
    #[arg(long, requires = "grid", conflicts_with_all = ["expression", "points", "parametric"])]
    flip_y: bool,
    /// Height that means no data in the file; such samples become holes, and such points are left out
    #[arg(long, value_name = "HEIGHT", value_parser = values::number, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["expression", "parametric"])]
    nodata: Option<f64>,
    /// Which of several points with the same x and y to keep [default: error]
    #[arg(long, value_parser = one_of::<Duplicates>(), requires = "points")]
    #[arg(conflicts_with_all = ["expression", "grid", "parametric"])]
    duplicates: Option<Duplicates>,
    /// Scale all heights by this factor
    #[arg(long, value_name = "FACTOR", value_parser = values::number, allow_hyphen_values = true)]
    #[arg(default_value_t = 1.0)]
    z_scale: f64,
    /// Proportions of the box: box, data, or lengths such as 4:4:3
    ///
    /// box draws x and y to scale, and makes the box 0.4 times as high as the longer of the two; if one of
    /// them is more than 5 times as long as the other, or logarithmic, both are equally long. data draws all
    /// three to scale. --z-scale applies on top. The default is box, or data with --parametric.
    #[arg(long, value_name = "ASPECT", value_parser = aspect)]
    aspect: Option<Aspect>,
    /// Logarithmic axes, such as x,z; formulas use the true values
    #[arg(long, value_enum, value_delimiter = ',', value_name = "AXES")]
    log: Vec<AxisName>,
}

/// One of the three axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum AxisName {
    X,
    Y,
    Z,
}

impl AxisName {
    pub(super) const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];
}

impl SurfaceInputArgs {
    /// The surface, if there is one; the error is a message about usage.
    pub(in crate::cli) fn sheets(
        self,
        texts: Vec<String>,
        default_samples: usize,
    ) -> Result<Option<SurfaceInput>, String> {
        let samples = self.samples.unwrap_or((default_samples, default_samples));
        let parameters = self.set;
        for (i, parameter) in parameters.iter().enumerate() {
            if parameters[..i].iter().any(|other| other.name() == parameter.name()) {
                return Err(format!("--set gives `{}` two values", parameter.name()));
            }
        }
        let lists = self.for_each;
        if let Some(list) = lists.iter().find(|l| parameters.iter().any(|p| p.name() == l.name())) {
            return Err(format!("`{}` is given by --set and by --for", list.name()));
        }
        let combinations = ParameterList::combinations(&lists);
        let combinations = combinations.map_err(|error| format!("--for: {error}"))?;
        let all = |values: &Vec<Parameter>| [&parameters[..], &values[..]].concat();
        let combinations: Vec<Vec<Parameter>> = combinations.iter().map(all).collect();
        let (mut of_sheets, mut names) = (Vec::new(), Vec::new());
        let mut default_aspect = Aspect::Box;
        let input = if let Some(path) = self.grid {
            SurfaceSource::File(path)
        } else if let Some(path) = self.points {
            SurfaceSource::Points(path)
        } else if let Some(texts) = self.parametric {
            default_aspect = Aspect::Data;
            let formulas = parsed(&texts, Variables::Parameters, &parameters)?;
            let formulas = formulas.try_into().map_err(|_| "expected three formulas")?;
            let (u, v) = (self.u.unwrap_or((0.0, 1.0)), self.v.unwrap_or((0.0, 1.0)));
            SurfaceSource::Parametric { formulas: Box::new(formulas), u, v, samples }
        } else if !texts.is_empty() {
            if texts.len() * combinations.len() > MAX_VALUES && !lists.is_empty() {
                let n = texts.len() * combinations.len();
                return Err(format!("--for makes {n} sheets; the limit is {MAX_VALUES}"));
            }
            let mut by_values = Vec::new();
            for parameters in &combinations {
                let formulas = parsed(&texts, Variables::Plane, parameters)?;
                let domain = self.domain.as_ref().map(|text| {
                    let parsed = Formula::parse_with(text, Variables::Plane, parameters);
                    parsed.map_err(|error| in_formula("--where", text, &error))
                });
                let domain = domain.transpose()?;
                let sheet = |height| FormulaSheet { height, domain: domain.clone() };
                by_values.push(formulas.into_iter().map(sheet).collect::<Vec<_>>());
            }
            let mut sheets = Vec::new();
            for k in 0..texts.len() {
                sheets.extend(by_values.iter().map(|sheets| sheets[k].clone()));
                of_sheets.extend(combinations.iter().cloned());
            }
            if !lists.is_empty() {
                names = names_by_values(&sheets, &of_sheets, parameters.len(), texts.len());
            }
            SurfaceSource::Formulas { texts, sheets, samples }
        } else {
            let is_range = [self.x, self.y, self.z].iter().any(Option::is_some);
            let is_given = is_range || self.samples.is_some();
            if self.nodata.is_some() {
                return Err("--nodata is for --grid and --points".into());
            }
            if is_given
                || self.aspect.is_some()
                || !self.log.is_empty()
                || self.z_scale != 1.0
                || !parameters.is_empty()
                || !lists.is_empty()
            {
                return Err(
                    "--x, --y, --z, --set, --for, --samples, --z-scale, --aspect and --log are \
                     for surfaces: use --expr, --grid, --points or --parametric"
                        .into(),
                );
            }
            return Ok(None);
        };
        let is_reversed = |range: Option<(f64, f64)>| range.is_some_and(|(from, to)| from > to);
        let sorted = |(from, to): (f64, f64)| (from.min(to), from.max(to));
        Ok(Some(SurfaceInput {
            log: AxisName::ALL.map(|axis| self.log.contains(&axis)),
            reversed: [self.x, self.y].map(is_reversed),
            options: HeightOptions {
                x: self.x.map(sorted),
                y: self.y.map(sorted),
                flip_y: self.flip_y,
                nodata: self.nodata,
            },
            duplicates: self.duplicates.unwrap_or_default(),
            z: self.z,
            outside: self.z_outside,
            z_scale: self.z_scale,
            aspect: self.aspect.unwrap_or(default_aspect),
            unused: unused_parameters(&input, &parameters, &lists),
            input,
            parameters: of_sheets,
            names,
        }))
    }
}

fn parsed(
    texts: &[String],
    variables: Variables,
    parameters: &[Parameter],
) -> Result<Vec<Formula>, String> {
    let parse = |(k, text): (usize, &String)| {
        let which = match texts.len() {
            1 => "the formula".to_owned(),
            n => format!("formula {} of {n}", k + 1),
        };
        let parsed = Formula::parse_with(text, variables, parameters);
        parsed.map_err(|error| in_formula(&which, text, &error))
    };
    texts.iter().enumerate().map(parse).collect()
}

/// Warnings about parameters that were typed and that no formula names.
fn unused_parameters(
    source: &SurfaceSource,
    fixed: &[Parameter],
    lists: &[ParameterList],
) -> Vec<String> {
    let formulas: Vec<&Formula> = match source {
        SurfaceSource::Formulas { sheets, .. } => {
            let heights = sheets.iter().map(|sheet| &sheet.height);
            heights.chain(sheets.iter().filter_map(|sheet| sheet.domain.as_ref())).collect()
        }
        SurfaceSource::Parametric { formulas, .. } => formulas.iter().collect(),
        SurfaceSource::File(_) | SurfaceSource::Points(_) => Vec::new(),
    };
    let fixed = fixed.iter().map(|parameter| ("--set", parameter.name()));
    let listed = lists.iter().map(|list| ("--for", list.name()));
    let unused = fixed.chain(listed).filter(|(option, name)| {
        config::is_typed(option) && !formulas.iter().any(|formula| formula.names(name))
    });
    unused
        .map(|(option, name)| format!("{option} {name}=… has no effect: no formula names {name}"))
        .collect()
}

/// A number or a formula without variables, such as `2*pi`.
fn constant(text: &str) -> Result<f64, String> {
    let parsed = Formula::parse(text, Variables::Plane);
    let formula = parsed.map_err(|error| in_formula(&format!("`{text}`"), text, &error))?;
    let value = formula.value(f64::NAN, f64::NAN);
    if value.is_finite() { Ok(value) } else { Err(format!("`{text}` is not a finite number")) }
}

/// A parameter of formulas as `a=2`; the value may be a formula such as `2*pi`.
fn parameter(text: &str) -> Result<Parameter, String> {
    let (name, value) = text.split_once('=').ok_or("expected a name and a value, as in a=2")?;
    Parameter::new(name.trim(), constant(value.trim())?).map_err(|error| error.to_string())
}

/// A parameter with its values as `a=1,2,3` or `a=0:1:0.25`; they may be formulas such as `pi/2`.
fn parameter_list(text: &str) -> Result<ParameterList, String> {
    let (name, values) = text.split_once('=').ok_or("expected a name and values, as in a=1,2,3")?;
    let name = name.trim();
    let list = match values.split(':').collect::<Vec<_>>()[..] {
        [values] => {
            let one = |text: &str| {
                let parameter = Parameter::new(name, constant(text.trim())?);
                let is_number = text.trim().parse::<f64>().is_ok();
                let parameter = parameter.map_err(|error| error.to_string())?;
                Ok(if is_number { parameter } else { parameter.written(text.trim()) })
            };
            let values: Result<_, String> = values.split(',').map(one).collect();
            ParameterList::of(values?)
        }
        [from, to, step] => {
            ParameterList::evenly(name, constant(from)?, constant(to)?, constant(step)?)
        }
        _ => {
            return Err(
                "expected values as in a=1,2,3, or from, to and step as in a=0:1:0.25".into()
            );
        }
    };
    list.map_err(|error| error.to_string())
}

/// What sheets are called that differ in the values of parameters, of which the first `n_fixed` are the
/// same for all.
fn names_by_values(
    sheets: &[FormulaSheet],
    parameters: &[Vec<Parameter>],
    n_fixed: usize,
    n_formulas: usize,
) -> Vec<String> {
    let name = |(sheet, parameters): (&FormulaSheet, &Vec<Parameter>)| {
        let values = name_of_values(&parameters[n_fixed..]);
        match n_formulas {
            1 => values,
            _ => format!("{}, {values}", typeset(sheet.height.text())),
        }
    };
    sheets.iter().zip(parameters).map(name).collect()
}

/// Two numbers, the smaller first, with a colon between them.
fn range(text: &str) -> Result<(f64, f64), String> {
    let (from, to) = either_way(text)?;
    if from < to { Ok((from, to)) } else { Err("the first number must be the smaller one".into()) }
}

/// Two different numbers with a colon between them.
fn either_way(text: &str) -> Result<(f64, f64), String> {
    let (from, to) = text.split_once(':').ok_or("expected two numbers, as in -2:2")?;
    let (from, to) = (constant(from)?, constant(to)?);
    if from != to { Ok((from, to)) } else { Err("the two numbers must be different".into()) }
}

/// `box`, `data`, or three lengths above 0 with colons between them.
fn aspect(text: &str) -> Result<Aspect, String> {
    match text {
        "box" => Ok(Aspect::Box),
        "data" => Ok(Aspect::Data),
        _ => {
            let lengths: Result<Vec<f64>, _> = text.split(':').map(values::positive).collect();
            let lengths = lengths.ok().and_then(|lengths| lengths.try_into().ok());
            lengths
                .map(Aspect::Lengths)
                .ok_or_else(|| "expected box, data, or three lengths, as in 4:4:3".to_owned())
        }
    }
}

/// Numbers of samples along x and y.
fn samples(text: &str) -> Result<(usize, usize), String> {
    let number = |text: &str| {
        let n = text.trim().parse::<usize>().map_err(|_| "expected a number, as in 80 or 80x60")?;
        if n < 2 { Err("at least 2 samples are needed") } else { Ok(n) }
    };
    let (x, y) = text.split_once('x').unwrap_or((text, text));
    let (x, y) = (number(x)?, number(y)?);
    if x.checked_mul(y).is_none_or(|n| n > MAX_SAMPLES) {
        return Err(format!("{x} × {y} samples exceed the limit of {MAX_SAMPLES}"));
    }
    Ok((x, y))
}

/// One of the formulas of --parametric. Since formulas may begin with a minus, clap takes the options
/// after too few of them for more.
fn parametric(text: &str) -> Result<String, String> {
    let is_option = |rest: &str| rest.starts_with(|c: char| c.is_ascii_alphabetic());
    let is_option =
        text.strip_prefix("--").is_some_and(is_option) || ["-o", "-q", "-h", "-V"].contains(&text);
    if is_option {
        return Err("three formulas are needed, for x, y and z".into());
    }
    Ok(text.to_owned())
}
