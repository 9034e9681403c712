//! Many drawings by one command: frames, tables of views, a drawing of each model, and shards.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::Stdio;

use serde_json::Value;
use tempfile::TempDir;

use super::{CUBE, assert_fails, command, hiddenline, text};

/// A pyramid without symmetry, as OBJ.
const SPIRE: &str = "v 0 0 0\nv 3 0 0\nv 2 2 0\nv 0 1 0\nv 1 1 4\n\
                     f 1 4 3 2\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";

/// A folder with models, and an empty one for drawings in it.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("out")).unwrap();
    for (name, model) in [("cube.obj", CUBE), ("spire.obj", SPIRE)] {
        fs::write(folder.path().join(name), model).unwrap();
    }
    folder
}

/// Runs `draw`, which must succeed; returns what it said.
#[track_caller]
fn draw(folder: &Path, arguments: &[&str]) -> String {
    let run = hiddenline(folder, &[&["draw"], arguments].concat());
    let said = text(&run.stderr);
    assert!(run.status.success(), "{said}");
    said
}

/// The files in a folder below, by name.
fn files(folder: &Path, name: &str) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder.join(name)).unwrap().map(|entry| entry.unwrap());
    let named = entries.map(|entry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        (name, fs::read(entry.path()).unwrap())
    });
    named.collect()
}

fn json(bytes: &[u8]) -> Value {
    serde_json::from_slice(bytes).unwrap()
}

/// All coordinates of all strokes.
fn coordinates(drawing: &Value) -> Vec<f64> {
    let strokes = drawing["strokes"].as_array().unwrap().iter();
    let points = strokes.flat_map(|stroke| stroke["points"].as_array().unwrap());
    points.flat_map(|p| p.as_array().unwrap()).map(|x| x.as_f64().unwrap()).collect()
}

#[test]
fn frames_of_a_turntable_show_the_model_turned_at_one_scale() {
    let folder = folder();
    let folder = folder.path();
    draw(folder, &["spire.obj", "--turntable", "4", "--exact", "-o", "out/f{index:02}.json"]);
    let frames = files(folder, "out");
    let names: Vec<&String> = frames.keys().collect();
    assert_eq!(names, ["f01.json", "f02.json", "f03.json", "f04.json"]);
    let frames: Vec<Value> = frames.values().map(|bytes| json(bytes)).collect();
    let mut smallest = f64::INFINITY;
    for (frame, azimuth) in frames.iter().zip(["30", "120", "210", "300"]) {
        draw(folder, &["spire.obj", "--azimuth", azimuth, "--exact", "-o", "one.json"]);
        let alone = json(&fs::read(folder.join("one.json")).unwrap());
        let (a, b) = (coordinates(frame), coordinates(&alone));
        assert_eq!(a.len(), b.len());
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-12), "azimuth {azimuth}");
        assert_eq!(frame["page_from_image"], frames[0]["page_from_image"]);
        let scale = |drawing: &Value| drawing["page_from_image"][0].as_f64().unwrap();
        assert!(scale(frame) <= scale(&alone) * (1.0 + 1e-12), "azimuth {azimuth}");
        smallest = f64::min(smallest, scale(&alone));
    }
    // Of the frames together some are wider, others higher, than any one.
    assert!(frames[0]["page_from_image"][0].as_f64().unwrap() > 0.5 * smallest);
}

#[test]
fn frames_without_a_place_for_their_number_get_one() {
    let folder = folder();
    let said = draw(folder.path(), &["cube.obj", "--turntable", "2", "-o", "out/cube.svg"]);
    let frames = files(folder.path(), "out");
    assert_eq!(frames.keys().collect::<Vec<_>>(), ["cube-001.svg", "cube-002.svg"]);
    // A quarter turn leaves the cube as it is; a half turn too.
    assert_eq!(frames["cube-001.svg"], frames["cube-002.svg"]);
    let lines: Vec<&str> = said.lines().collect();
    assert!(lines[0].starts_with("cube.obj: 8 vertices"), "{said}");
    assert!(lines[1].starts_with("out/cube-001.svg  "), "{said}");
    assert!(lines[2].starts_with("out/cube-002.svg  "), "{said}");
    assert_eq!(lines[3..], ["2 drawn"]);
}

#[test]
fn rows_of_a_table_are_camera_options() {
    let folder = folder();
    let folder = folder.path();
    let table = "# where from\nazimuth,elevation,view,eye,distance\n10,20,,,\n\n70,,,,12\n\
                 ,,isometric,,\n,,,\"9,-4,3\",\n";
    fs::write(folder.join("views.csv"), table).unwrap();
    let common = ["spire.obj", "--fov", "40", "--elevation", "-5", "--exact"];
    let many = [&common[..], &["--views", "views.csv", "-o", "out/{stem}{index}.json"]].concat();
    draw(folder, &many);
    let found = files(folder, "out");
    let rows: [&[&str]; 4] = [
        &["--elevation=-5", "--azimuth=10", "--elevation=20"],
        &["--elevation=-5", "--azimuth=70", "--distance=12"],
        &["--view=isometric"],
        &["--eye=9,-4,3"],
    ];
    assert_eq!(found.len(), rows.len());
    for (i, options) in rows.iter().enumerate() {
        let options = &options[usize::from(options.len() > 2 && i == 0)..];
        let alone = ["spire.obj", "--fov", "40", "--exact", "-o", "one.json"];
        draw(folder, &[&alone[..], options].concat());
        let alone = json(&fs::read(folder.join("one.json")).unwrap());
        let row = json(&found[&format!("spire{}.json", i + 1)]);
        assert_eq!(row["strokes"], alone["strokes"], "row {}", i + 1);
        assert_eq!(row["camera"], alone["camera"], "row {}", i + 1);
    }
}

#[test]
fn rows_with_angles_replace_a_view_that_was_typed() {
    let folder = folder();
    let folder = folder.path();
    fs::write(folder.join("views.csv"), "azimuth\n50\n\"\"\n").unwrap();
    for (typed, alone) in [(["--view", "top"], "--view=top"), (["--eye", "9,1,2"], "--eye=9,1,2")] {
        let many = ["spire.obj", "--views", "views.csv", "--exact", "-o", "out/{index}.json"];
        draw(folder, &[&many[..], &typed].concat());
        for (index, option) in [(1, "--azimuth=50"), (2, alone)] {
            draw(folder, &["spire.obj", option, "--exact", "-o", "one.json"]);
            let one = json(&fs::read(folder.join("one.json")).unwrap());
            let row = json(&fs::read(folder.join(format!("out/{index}.json"))).unwrap());
            assert_eq!((&row["camera"], &row["strokes"]), (&one["camera"], &one["strokes"]));
        }
    }
}

#[test]
fn each_model_is_drawn_as_if_it_were_alone() {
    let folder = folder();
    let folder = folder.path();
    draw(folder, &["--each", "cube.obj", "spire.obj", "-o", "out/{index}-{stem}.json"]);
    let drawings = files(folder, "out");
    assert_eq!(drawings.len(), 2);
    for (i, name) in ["cube", "spire"].into_iter().enumerate() {
        draw(folder, &[&format!("{name}.obj"), "-o", "one.json"]);
        let alone = fs::read(folder.join("one.json")).unwrap();
        assert_eq!(drawings[&format!("{}-{name}.json", i + 1)], alone, "{name}");
    }
}

#[test]
fn each_model_can_have_several_views_and_its_own_place() {
    let folder = folder();
    let folder = folder.path();
    let common = ["--each", "cube.obj", "spire.obj", "--scale", "2", "--scale", "3"];
    let output = ["--turntable", "3", "-o", "out/{stem}-{index}.json"];
    draw(folder, &[&common[..], &output].concat());
    let drawings = files(folder, "out");
    assert_eq!(drawings.len(), 6);
    draw(folder, &["spire.obj", "--scale", "3", "--turntable", "3", "-o", "{index}.json"]);
    for i in 1..=3 {
        let alone = fs::read(folder.join(format!("{i}.json"))).unwrap();
        assert_eq!(drawings[&format!("spire-{i}.json")], alone);
    }
}

#[test]
fn shards_together_are_the_whole() {
    let folder = folder();
    let folder = folder.path();
    fs::create_dir(folder.join("shards")).unwrap();
    for (what, n) in [(["--turntable", "7"].as_slice(), 7), (&["--each"], 2)] {
        let run = |more: &[&str]| {
            let models = ["cube.obj", "spire.obj", "-o", "x/{stem}{index}.svg"];
            let models = if n == 7 { &models[1..] } else { &models[..] };
            draw(folder, &[what, models, more].concat())
        };
        fs::create_dir(folder.join("x")).unwrap();
        run(&["--threads", "1"]);
        let whole = files(folder, "x");
        assert_eq!(whole.len(), n);
        fs::remove_dir_all(folder.join("x")).unwrap();
        fs::create_dir(folder.join("x")).unwrap();
        let mut n_before = 0;
        for shard in ["1/3", "3/3", "2/3"] {
            run(&["--shard", shard, "--threads", "2"]);
            let n_now = files(folder, "x").len();
            let k: usize = shard[..1].parse().unwrap();
            assert_eq!(n_now - n_before, (n + 3 - k) / 3, "{shard} of {n}");
            n_before = n_now;
        }
        assert_eq!(files(folder, "x"), whole);
        fs::remove_dir_all(folder.join("x")).unwrap();
    }
}

#[test]
fn a_task_of_a_slurm_array_draws_its_shard() {
    let folder = folder();
    let folder = folder.path();
    let task = |id: &str, count: &str| {
        let arguments = ["draw", "cube.obj", "--turntable", "5", "--shard", "slurm", "-o"];
        let mut command = command(folder, &[&arguments[..], &["out/{index}.svg"]].concat());
        for (name, value) in [("ID", id), ("MIN", "10"), ("MAX", "14"), ("COUNT", count)] {
            command.env(format!("SLURM_ARRAY_TASK_{name}"), value);
        }
        command.env("SLURM_ARRAY_TASK_STEP", "2").output().unwrap()
    };
    assert!(task("12", "3").status.success());
    assert_eq!(files(folder, "out").keys().collect::<Vec<_>>(), ["2.svg", "5.svg"]);
    assert_fails(&task("12", "2"), 1, "an array without gaps");
    let arguments = ["draw", "cube.obj", "--shard", "slurm", "-o", "out/1.svg"];
    let mut unset = command(folder, &arguments);
    let unset = unset.env_remove("SLURM_ARRAY_TASK_ID").output().unwrap();
    assert_fails(&unset, 1, "SLURM_ARRAY_TASK_ID is not set");
}

#[test]
fn drawings_that_exist_can_be_left_as_they_are() {
    let folder = folder();
    let folder = folder.path();
    fs::write(folder.join("out/cube.svg"), "mine").unwrap();
    let arguments = ["--each", "cube.obj", "spire.obj", "--skip-existing", "-o", "out/{stem}.svg"];
    let said = draw(folder, &arguments);
    assert!(said.ends_with("1 drawn, 1 skipped\n"), "{said}");
    let drawings = files(folder, "out");
    assert_eq!(drawings["cube.svg"], b"mine");
    assert!(drawings["spire.svg"].starts_with(b"<"));
    let said = draw(folder, &arguments);
    assert!(said.ends_with("0 drawn, 2 skipped\n"), "{said}");
}

#[test]
fn a_failure_ends_the_work_unless_told_otherwise() {
    let folder = folder();
    let folder = folder.path();
    fs::write(folder.join("bad.obj"), "v 1 2\n").unwrap();
    let models = ["draw", "--each", "bad.obj", "cube.obj", "spire.obj", "-o", "out/{stem}.svg"];
    let run = hiddenline(folder, &[&models[..], &["--keep-going"]].concat());
    assert_fails(&run, 1, "bad.obj");
    assert!(text(&run.stderr).ends_with("error: 2 drawn, 1 failed\n"), "{}", text(&run.stderr));
    assert_eq!(files(folder, "out").len(), 2);
    let run = hiddenline(folder, &[&models[..], &["--threads", "1"]].concat());
    assert_fails(&run, 1, "1 failed; --keep-going draws the rest anyway");
}

#[test]
fn names_of_models_are_read_from_a_list() {
    let folder = folder();
    let folder = folder.path();
    fs::write(folder.join("list.txt"), "cube.obj\r\n\nspire.obj\n").unwrap();
    draw(folder, &["--each", "--list", "list.txt", "-o", "out/{stem}.svg"]);
    assert_eq!(files(folder, "out").len(), 2);
    let arguments = ["draw", "--each", "--list", "-", "-o", "out/{index}.svg"];
    let mut listed = command(folder, &arguments);
    let mut listed = listed.stdin(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    listed.stdin.take().unwrap().write_all(b"spire.obj\0cube.obj\0").unwrap();
    assert!(listed.wait().unwrap().success());
    assert_eq!(files(folder, "out").len(), 4);
    fs::write(folder.join("empty.txt"), "\n").unwrap();
    let run = hiddenline(folder, &["draw", "--list", "empty.txt", "-o", "out/a.svg"]);
    assert_fails(&run, 1, "--list empty.txt: no names");
    let run = hiddenline(folder, &["draw", "-o", "out/a.svg"]);
    assert_fails(&run, 2, "<MODEL>");
}

#[test]
fn what_cannot_be_meant_is_refused() {
    let folder = folder();
    let folder = folder.path();
    let fails = |arguments: &[&str], code: i32, message: &str| {
        assert_fails(&hiddenline(folder, &[&["draw"], arguments].concat()), code, message);
    };
    fails(&["cube.obj", "--turntable", "3"], 2, "several drawings need names; use -o");
    let same = ["--each", "cube.obj", "spire.obj", "-o", "out/a.svg"];
    fails(&same, 2, "several drawings would be written to out/a.svg; use a name with {stem}");
    fails(&["cube.obj", "--shard", "3/2", "-o", "out/a.svg"], 2, "K from 1 to N");
    fails(&["cube.obj", "--turntable", "2", "-o", "no/{index}.svg"], 1, "folder no does not exist");
    fails(&["--each", "cube.obj", "spire.obj", "-o", "{stem}.obj"], 2, "use --format");
    let onto = ["--each", "cube.obj", "spire.obj", "--format", "svg", "-o", "{stem}.obj"];
    fails(&onto, 1, "cannot write cube.obj: it is an input file");
    for (table, message) in [
        ("azimut\n1\n", "t.csv:1: `azimut` is not a camera option; did you mean azimuth?"),
        ("azimuth\n1\nx\n", "t.csv:3: invalid value 'x' for '--azimuth <DEG>': not a number"),
        ("azimuth,fov\n1\n", "t.csv: "),
        ("azimuth,eye\n1,\"1,2,3\"\n", "t.csv:2: "),
        ("azimuth\n", "t.csv: no views"),
        ("", "t.csv: no views"),
    ] {
        fs::write(folder.join("t.csv"), table).unwrap();
        fails(&["cube.obj", "--views", "t.csv", "-o", "out/{index}.svg"], 1, message);
    }
    fails(&["cube.obj", "--views", "none.csv", "-o", "out/{index}.svg"], 1, "--views none.csv: ");
    assert!(files(folder, "out").is_empty());
}
