//! Warnings about options on the command line that have no effect.
//!
//! Only options on the command line count: a setting from a file, a preset or the environment is meant for
//! many drawings, and need not apply to each of them.

use clap::ArgMatches;

use super::config;

/// An option that other options can make useless.
struct Rule {
    /// Without its dashes, as in `crease`.
    option: &'static str,
    commands: &'static [&'static str],
    is_idle: fn(&Choices) -> bool,
    /// Follows "has no effect".
    reason: &'static str,
}

const DRAWINGS: &[&str] = &["draw", "surface", "fill"];
const SCENES: &[&str] = &["draw", "surface", "fill", "preview"];
const MODELS: &[&str] = &["draw", "fill", "preview"];
const PLOTS: &[&str] = &["surface", "fill"];
const MESHES: &[&str] = &["surface", "fill", "preview"];
/// Options for strokes, which filled areas alone do not have.
const FOR_STROKES: [&str; 11] = [
    "lines",
    "crease",
    "pen-width",
    "pen",
    "optimize",
    "simplify",
    "join-tolerance",
    "overlap-tolerance",
    "split-distance",
    "split-overlap",
    "machine",
];

/// Options for axes, which `fill` draws around surfaces.
const FOR_AXES: [&str; 9] = [
    "axes",
    "title",
    "no-axes",
    "box-front",
    "z-axis",
    "tick-step",
    "ticks-pi",
    "axis-titles",
    "text-height",
];

const RULES: &[Rule] = &[
    Rule {
        option: "crease",
        commands: &["draw"],
        is_idle: |c| c.is_given("lines") && !c.has("lines", &["crease", "all"]),
        reason: "without crease among --lines",
    },
    Rule {
        option: "dxf-dashes",
        commands: &["draw"],
        is_idle: |c| !c.has("hidden", &["dashed"]),
        reason: "without --hidden dashed",
    },
    Rule {
        option: "dxf-dashes",
        commands: &["surface", "fill", "optimize"],
        is_idle: |c| c.is_given("dxf-dashes"),
        reason: "without hidden lines; dashes of other lines are always separate",
    },
    Rule {
        option: "unit",
        commands: DRAWINGS,
        // Models of different units are brought to one.
        is_idle: |c| !c.is_given("drawing-scale") && c.n_values("models") < 2,
        reason: "without --drawing-scale",
    },
    Rule { option: "near", commands: SCENES, is_idle: |c| c.is_parallel(), reason: PARALLEL },
    Rule { option: "fov", commands: SCENES, is_idle: |c| c.is_parallel(), reason: PARALLEL },
    Rule {
        option: "fov",
        commands: SCENES,
        is_idle: is_no_field_of_view,
        reason: "without --fit-fov, where --eye or --distance places the camera",
    },
    Rule { option: "distance", commands: SCENES, is_idle: |c| c.is_parallel(), reason: PARALLEL },
    Rule { option: "shortest-stroke", commands: &["draw"], is_idle: is_exact, reason: EXACT },
    Rule {
        option: "smooth",
        commands: &["draw"],
        is_idle: |c| is_exact(c) && !c.has("smooth", OFF),
        reason: EXACT,
    },
    Rule { option: "smooth-tolerance", commands: &["draw"], is_idle: is_exact, reason: EXACT },
    Rule {
        option: "smooth-tolerance",
        commands: MODELS,
        is_idle: |c| c.has("smooth", OFF),
        reason: "without --smooth",
    },
    Rule { option: "halo", commands: &["draw"], is_idle: is_exact, reason: EXACT },
    Rule { option: "thin", commands: &["draw"], is_idle: is_exact, reason: EXACT },
    Rule { option: "overlap", commands: &["draw"], is_idle: is_exact, reason: EXACT },
    Rule { option: "overlap-tolerance", commands: &["draw"], is_idle: is_exact, reason: EXACT },
    Rule {
        option: "join-tolerance",
        commands: &["draw", "surface"],
        is_idle: is_exact,
        reason: EXACT,
    },
    Rule {
        option: "overlap-tolerance",
        commands: &["draw"],
        is_idle: |c| c.has("overlap", &["keep"]),
        reason: "with --overlap keep",
    },
    Rule { option: "simplify", commands: &["draw", "surface"], is_idle: is_exact, reason: EXACT },
    Rule { option: "optimize", commands: &["draw", "surface"], is_idle: is_exact, reason: EXACT },
    Rule { option: "smoothness", commands: &["surface"], is_idle: is_exact, reason: EXACT },
    Rule {
        option: "smoothness",
        commands: &["surface"],
        is_idle: |c| c.is_given("grid") || c.is_given("points"),
        reason: "on samples from a file; it applies to formulas",
    },
    Rule { option: "labels", commands: &["surface"], is_idle: is_exact, reason: EXACT },
    Rule { option: "label-side", commands: &["surface"], is_idle: is_exact, reason: EXACT },
    Rule { option: "negative", commands: &["surface"], is_idle: is_exact, reason: EXACT },
    Rule { option: "legend", commands: &["surface"], is_idle: is_exact, reason: EXACT },
    Rule {
        option: "label-side",
        commands: &["surface"],
        is_idle: |c| !c.has("lines", &["levels"]),
        reason: "without levels among --lines",
    },
    Rule {
        option: "label-side",
        commands: &["surface"],
        is_idle: has_no_labels,
        reason: "without labels; --labels all draws them",
    },
    Rule {
        option: "names",
        commands: &["surface"],
        is_idle: |c| !c.is_present("legend") || c.has("legend", &["none"]),
        reason: "without --legend",
    },
    Rule {
        option: "z-outside",
        commands: MESHES,
        is_idle: |c| !c.is_present("z"),
        reason: "without --z",
    },
    Rule { option: "u", commands: MESHES, is_idle: is_no_patch, reason: NO_PATCH },
    Rule { option: "v", commands: MESHES, is_idle: is_no_patch, reason: NO_PATCH },
    Rule {
        option: "box-front",
        commands: PLOTS,
        is_idle: |c| !c.has("axes", &["box"]),
        reason: "without --axes box",
    },
    Rule {
        option: "z-axis",
        commands: &["surface"],
        is_idle: is_frame,
        reason: "with --axes frame",
    },
    Rule { option: "z-axis", commands: PLOTS, is_idle: has_no_axes, reason: NO_AXES },
    Rule { option: "tick-step", commands: PLOTS, is_idle: has_no_axes, reason: NO_AXES },
    Rule { option: "ticks-pi", commands: PLOTS, is_idle: has_no_axes, reason: NO_AXES },
    Rule { option: "text-height", commands: PLOTS, is_idle: has_no_axes, reason: NO_AXES },
    Rule {
        option: "every",
        commands: &["surface"],
        is_idle: |c| c.is_given("lines") && !c.has("lines", &["x", "y", "both"]),
        reason: "without x, y or both among --lines",
    },
    Rule {
        option: "leaf",
        commands: &["fill"],
        is_idle: |c| !c.has("engine", &["auto", "warnock"]),
        reason: "on this --engine; it is for warnock",
    },
    Rule {
        option: "subdivision",
        commands: &["fill"],
        is_idle: |c| !c.has("engine", &["auto", "warnock"]),
        reason: "on this --engine; it is for warnock",
    },
    Rule {
        option: "edge-width",
        commands: &["preview"],
        is_idle: |c| !c.is_set("edges"),
        reason: "without --edges",
    },
    Rule {
        option: "smooth-angle",
        commands: &["preview"],
        is_idle: |c| !c.has("shading", &["smooth"]),
        reason: "without --shading smooth",
    },
    Rule {
        option: "shading",
        commands: &["preview"],
        is_idle: |c| c.has("show", &["depth"]),
        reason: "on a picture of depths",
    },
    Rule { option: "light", commands: &["preview"], is_idle: is_data, reason: DATA },
    Rule { option: "paint", commands: &["preview"], is_idle: is_data, reason: DATA },
    Rule {
        option: "margin",
        commands: &["optimize"],
        is_idle: |c| !c.is_set("fit") && !c.is_set("center") && !c.has("crop", &["margin"]),
        reason: "without --fit, --center or --crop margin",
    },
    Rule {
        option: "center",
        commands: &["optimize"],
        is_idle: |c| c.is_set("fit"),
        reason: "with --fit, which also centers the drawing",
    },
];

const OFF: &[&str] = &["off"];
const PARALLEL: &str = "on an orthographic projection";
const EXACT: &str = "with --exact, which leaves lines as they are";
const NO_PATCH: &str = "without --parametric";
const ON_MODELS: &str = "on models; axes are for surfaces";
const NO_AXES: &str = "without axes";
const DATA: &str = "on a picture of depths or normals";

/// What was chosen for a command, typed or set.
struct Choices<'a>(&'a ArgMatches);

impl Choices<'_> {
    /// Whether an option has a value that is not its default, or its default typed.
    fn is_given(&self, option: &str) -> bool {
        let id = option.replace('-', "_");
        let has = self.0.try_contains_id(&id).unwrap_or(false);
        has && self.0.value_source(&id) == Some(clap::parser::ValueSource::CommandLine)
    }

    /// Whether a flag is on.
    fn is_set(&self, flag: &str) -> bool {
        let id = flag.replace('-', "_");
        self.0.try_get_one::<bool>(&id).ok().flatten().is_some_and(|on| *on)
    }

    /// Whether a value of an option, with commas between several, is one of `names`.
    fn has(&self, option: &str, names: &[&str]) -> bool {
        let id = option.replace('-', "_");
        let values = self.0.try_get_raw(&id).ok().flatten().into_iter().flatten();
        let mut names_in = values.filter_map(|value| value.to_str()).flat_map(|v| v.split(','));
        names_in.any(|value| names.contains(&value))
    }

    /// How many values an argument has.
    fn n_values(&self, id: &str) -> usize {
        self.0.try_get_raw(id).ok().flatten().map_or(0, Iterator::count)
    }

    /// Whether models are drawn, no surface.
    fn is_model(&self) -> bool {
        let surfaces = ["expression", "grid", "points", "parametric"];
        surfaces.iter().all(|name| !self.is_present(name))
    }

    fn is_present(&self, id: &str) -> bool {
        self.0.try_get_raw(id).ok().flatten().is_some_and(|values| values.len() > 0)
    }

    fn is_parallel(&self) -> bool {
        let is_perspective = self.has("projection", &["perspective"]);
        self.has("projection", &["orthographic"]) || (self.is_given("view") && !is_perspective)
    }
}

/// The field of view places an automatic camera, and nothing else.
fn is_no_field_of_view(choices: &Choices) -> bool {
    let is_placed = choices.is_given("eye") || choices.is_given("distance");
    is_placed && !choices.is_parallel() && !choices.is_set("fit-fov")
}

fn is_exact(choices: &Choices) -> bool {
    choices.is_set("exact")
}

fn has_no_axes(choices: &Choices) -> bool {
    is_exact(choices) || choices.is_set("no-axes") || choices.has("axes", &["none"])
}

/// Level curves have no labels unless these are requested, but in views from above without grid lines.
fn has_no_labels(choices: &Choices) -> bool {
    let has_grid_lines = choices.has("lines", &["x", "y", "both"]);
    choices.has("labels", &["none"]) || !choices.is_present("labels") && has_grid_lines
}

fn is_frame(choices: &Choices) -> bool {
    choices.has("axes", &["frame"])
}

fn is_no_patch(choices: &Choices) -> bool {
    !choices.is_given("parametric")
}

fn is_data(choices: &Choices) -> bool {
    choices.has("show", &["depth", "normals"])
}

/// Warnings about what was typed for a command but changes nothing.
pub(super) fn warnings(command: &str, matches: &ArgMatches) -> Vec<String> {
    let choices = Choices(matches);
    let is_typed = |option: &str| config::is_typed(&format!("--{option}"));
    let mut warnings = Vec::new();
    let mut warn = |option: &str, reason: &str| {
        let start = format!("--{option} has no effect ");
        if is_typed(option) && !warnings.iter().any(|said: &String| said.starts_with(&start)) {
            warnings.push(format!("{start}{reason}"));
        }
    };
    for rule in RULES.iter().filter(|rule| rule.commands.contains(&command)) {
        if (rule.is_idle)(&choices) {
            warn(rule.option, rule.reason);
        }
    }
    if command == "fill" && (choices.is_model() || choices.is_given("turntable")) {
        let reason = if choices.is_model() { ON_MODELS } else { "with --turntable" };
        FOR_AXES.iter().for_each(|option| warn(option, reason));
    }
    if command == "fill" && choices.is_set("no-edges") {
        FOR_STROKES.iter().for_each(|option| warn(option, "with --no-edges"));
    }
    warnings
}
