//! How the viewer starts, redraws and ends.

use std::fs;
use std::io::{Read, Write};
use std::time::Duration;

use serde_json::json;

use super::{Viewer, exact, message};
use crate::program::{CUBE, assert_fails, command, hiddenline};

#[test]
fn ctrl_c_and_the_signal_to_terminate_end_it_with_success() {
    for signal in ["INT", "TERM"] {
        let mut viewer = Viewer::start(&["cube.obj"]);
        assert_eq!(viewer.draw(&exact(json!({}))).status, 200);
        viewer.signal(signal);
        assert_eq!(viewer.exit_code(), Some(0), "{signal}");
    }
}

#[test]
fn a_signal_ends_it_while_pages_are_open() {
    let mut viewer = Viewer::start(&["cube.obj"]);
    let mut events = viewer.events("a");
    events.next().unwrap();
    viewer.signal("TERM");
    assert_eq!(viewer.exit_code(), Some(0));
}

#[test]
fn with_once_closing_the_last_page_ends_it() {
    let mut viewer = Viewer::start(&["cube.obj", "--once"]);
    let open = |viewer: &Viewer| {
        let mut stream = viewer.connect();
        let headers = [format!("Host: {}", viewer.host()), viewer.token()];
        stream.write_all(&message("GET /api/events HTTP/1.1", &headers, b"")).unwrap();
        let mut first = [0];
        stream.read_exact(&mut first).unwrap();
        stream
    };
    let (one, other) = (open(&viewer), open(&viewer));
    drop(one);
    // A page that is loaded again is away for a moment.
    std::thread::sleep(Duration::from_millis(300));
    assert!(viewer.child.try_wait().unwrap().is_none());
    drop(other);
    let again = open(&viewer);
    std::thread::sleep(Duration::from_millis(2500));
    assert!(viewer.child.try_wait().unwrap().is_none());
    drop(again);
    assert_eq!(viewer.exit_code(), Some(0));
}

#[test]
fn with_watch_a_changed_model_is_drawn_anew() {
    let viewer = Viewer::start(&["cube.obj", "--watch"]);
    let mut events = viewer.events("a");
    events.next().unwrap();
    let asked = exact(json!({ "drawing-scale": "10:1" }));
    let strokes = |viewer: &Viewer| viewer.draw(&asked).strokes::<2>();
    let before = strokes(&viewer);
    fs::write(viewer.path().join("cube.obj"), "v 0 0 0\nv 3 0 0\nv 0 0 3\nf 1 2 3\n").unwrap();
    assert_eq!(events.next().unwrap(), json!({ "event": "changed" }));
    let after = strokes(&viewer);
    assert_ne!(before, after);
    assert_eq!(after.concat().len(), 4, "one triangle");
    // A broken file is reported, and drawn once it is repaired.
    fs::write(viewer.path().join("cube.obj"), "v 0 0 0\nf 1 2 9\n").unwrap();
    assert_eq!(events.next().unwrap(), json!({ "event": "changed" }));
    assert!(viewer.draw(&asked).json()["error"].as_str().unwrap().contains("cube.obj:2"));
    fs::write(viewer.path().join("cube.obj"), CUBE).unwrap();
    assert_eq!(events.next().unwrap(), json!({ "event": "changed" }));
    assert_eq!(strokes(&viewer), before);
}

#[test]
fn what_cannot_be_shown_is_told_before_anything_is_served() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.obj"), "v 0 0 0\nf 1 2 9\n").unwrap();
    fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    let view = |arguments: &[&str]| {
        hiddenline(folder.path(), &[&["view", "--no-open"], arguments].concat())
    };
    assert_fails(&view(&["nothing.obj"]), 1, "nothing.obj");
    assert_fails(&view(&["bad.obj"]), 1, "bad.obj:2");
    assert_fails(&view(&[]), 2, "specify models, or a surface with --expr");
    assert_fails(&view(&["cube.obj", "--levels", "3"]), 2, "--levels is for surfaces");
    assert_fails(&view(&["--expr", "x", "--weld", "1"]), 2, "--weld is for models");
    assert_fails(&view(&["cube.obj", "--lines", "nosuch"]), 2, "nosuch");
    assert_fails(&view(&["cube.obj", "--expr", "x"]), 2, "cannot be used with");
    assert_fails(&view(&["--expr", "x +"]), 1, "expected a value");
}

#[test]
fn a_model_from_standard_input_is_drawn_more_than_once() {
    use std::process::Stdio;
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["view", "--no-open", "-", "--input-format", "obj"];
    let mut command = command(folder.path(), &arguments);
    let mut child = command.stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(CUBE.as_bytes()).unwrap();
    let viewer = Viewer::listening(child, folder);
    for scale in ["1", "2"] {
        let reply = viewer.draw(&exact(json!({ "scale": scale, "input-format": "obj" })));
        assert_eq!(reply.status, 200);
    }
}

#[test]
fn settings_hold_for_the_viewer() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cube.obj"), CUBE).unwrap();
    fs::write(folder.path().join("hiddenline.toml"), "[defaults]\npage = 'a5'\nengine = 'bsp'\n")
        .unwrap();
    let viewer = Viewer::start_in(folder, &["cube.obj"]);
    assert_eq!(viewer.about()["options"], json!({ "page": "a5" }));
}
