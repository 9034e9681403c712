//! Settings from files and the environment: every option has one, and only options have.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::{CUBE, assert_fails, command, hiddenline, text};

const COMMANDS: [&str; 6] = ["draw", "surface", "fill", "preview", "view", "optimize"];

/// The names of a command's options, from its help.
fn options(command: &str) -> BTreeSet<String> {
    let help = text(&hiddenline(Path::new("."), &[command, "--help"]).stdout);
    let words = help.lines().filter_map(|line| {
        let line = line.trim_start();
        let line =
            line.split_once(", ").filter(|(short, _)| short.len() == 2).map_or(line, |p| p.1);
        line.strip_prefix("--")?.split([' ', '=', '[', ']', '.']).next()
    });
    words.map(str::to_owned).collect()
}

fn with_cube() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    folder
}

fn settings(folder: &Path, content: &str) {
    fs::write(folder.join("hiddenline.toml"), content).unwrap();
}

#[test]
fn every_option_of_every_command_can_be_set() {
    let folder = with_cube();
    let mut all: BTreeSet<String> = COMMANDS.into_iter().flat_map(options).collect();
    for name in ["help", "preset"] {
        assert!(all.remove(name), "--{name}");
    }
    assert!(all.len() > 80, "{} options", all.len());
    let mut file = "[preset.all]\n".to_owned();
    all.iter().for_each(|name| file += &format!("{name} = 'x'\n"));
    settings(folder.path(), &file);
    let output = hiddenline(folder.path(), &["draw", "cube.obj"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    // The variables are known, too; that their values are wrong is another matter.
    let mut set = command(folder.path(), &["config", "show"]);
    for name in &all {
        set.env(format!("HIDDENLINE_{}", name.replace('-', "_").to_uppercase()), "1");
    }
    let stderr = text(&set.output().unwrap().stderr);
    assert!(!stderr.contains("is not a setting"), "{stderr}");
}

#[test]
fn settings_do_what_the_options_do() {
    let folder = with_cube();
    let folder = folder.path();
    // An SVG would name the command that made it.
    let draw = ["draw", "cube.obj", "--format", "json"];
    let typed = hiddenline(folder, &[&draw[..], &["--eye=-9,-7,5", "--exact"]].concat()).stdout;
    assert!(typed != hiddenline(folder, &draw).stdout);
    let mut set = command(folder, &draw);
    let set = set.env("HIDDENLINE_EYE", "-9,-7,5").env("HIDDENLINE_EXACT", "1").output().unwrap();
    assert!(set.stdout == typed, "{}", text(&set.stderr));
    settings(folder, "[defaults]\neye = '-9,-7,5'\nexact = true\n");
    assert!(hiddenline(folder, &draw).stdout == typed);
    settings(
        folder,
        "[defaults]\nparametric = ['cos(u)', 'sin(u)', 'v']\nsamples = 9\nformat = 'json'\n",
    );
    let set = hiddenline(folder, &["surface"]);
    fs::remove_file(folder.join("hiddenline.toml")).unwrap();
    let typed =
        ["surface", "--parametric", "cos(u)", "sin(u)", "v", "--samples", "9", "--format=json"];
    assert!(set.stdout == hiddenline(folder, &typed).stdout, "{}", text(&set.stderr));
    assert!(!set.stdout.is_empty());
}

#[test]
fn unknown_settings_are_refused_with_their_line_and_unknown_variables_with_a_warning() {
    let folder = with_cube();
    let folder = folder.path();
    settings(folder, "[defaults]\npage = 'a4'\n\n[preset.b]\n'pgae' = 'a2'\n");
    let output = hiddenline(folder, &["draw", "cube.obj", "-o", "a.svg"]);
    let message = "hiddenline.toml:5: unknown setting `pgae`; did you mean page";
    assert_fails(&output, 1, message);
    assert!(!folder.join("a.svg").exists());
    assert_fails(&hiddenline(folder, &["config", "show"]), 1, message);
    settings(folder, "");
    let mut set = command(folder, &["draw", "cube.obj", "-o", "a.svg"]);
    let output = set.env("HIDDENLINE_MARGINS", "20").output().unwrap();
    assert!(output.status.success());
    let stderr = text(&output.stderr);
    assert!(
        stderr.contains("warning: HIDDENLINE_MARGINS is not a setting; did you mean margin"),
        "{stderr}"
    );
    let run = |arguments: &[&str]| {
        let output = command(folder, arguments).env("HIDDENLINE_MARGINS", "20").output().unwrap();
        (output.status.code(), text(&output.stderr))
    };
    let (code, stderr) = run(&["draw", "cube.obj", "-o", "b.svg", "--strict"]);
    assert!(code == Some(1) && !folder.join("b.svg").exists(), "{stderr}");
    assert_eq!(run(&["draw", "cube.obj", "-o", "b.svg", "-q"]), (Some(0), String::new()));
    for arguments in [&["config", "show"][..], &["preview", "cube.obj", "-o", "b.png"]] {
        let (code, stderr) = run(arguments);
        assert!(code == Some(0) && stderr.contains("HIDDENLINE_MARGINS is not"), "{stderr}");
    }
}

#[test]
fn what_only_another_command_takes_is_left_to_that_one() {
    let folder = with_cube();
    let folder = folder.path();
    settings(folder, "[defaults]\nengine = 'bsp'\nlines = 'silhouette'\n");
    let output = hiddenline(folder, &["draw", "cube.obj"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let output = hiddenline(folder, &["fill", "cube.obj", "--stats"]);
    assert!(text(&output.stderr).contains("\"engine\":\"bsp\""), "{}", text(&output.stderr));
    assert!(hiddenline(folder, &["surface", "x*y", "--samples", "5"]).status.success());
    settings(folder, "[defaults]\nengine = 'nosuch'\n");
    assert_fails(
        &hiddenline(folder, &["draw", "cube.obj"]),
        1,
        "with settings from hiddenline.toml",
    );
}

#[test]
fn a_setting_is_a_plain_value() {
    let folder = with_cube();
    let folder = folder.path();
    for (line, message) in [
        ("page = ['a4', 'a3']", "page takes one value"),
        ("page = { a = 1 }", "page takes one value"),
        ("pen = [['visible=1']]", "pen takes one value"),
        ("strict = 'maybe'", "strict must be true or false"),
    ] {
        settings(folder, &format!("[defaults]\n{line}\n"));
        assert_fails(&hiddenline(folder, &["draw", "cube.obj"]), 1, message);
    }
    settings(folder, "[defaults]\npen = ['visible=1:0.3mm:red', 'hidden=2']\nlandscape = false\n");
    let output = hiddenline(folder, &["draw", "cube.obj"]);
    assert!(text(&output.stdout).contains("#ff0000"), "{}", text(&output.stderr));
}
