//! Material files: found wherever they are, read whatever is in them.

use std::fs;

use super::{hiddenline, text};

const STRIP: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nusemtl red one\nf 1 2 3 4\n\
                     usemtl blue\nf 2 5 6 3\n";

const RED_AND_BLUE: &str = "newmtl red one\nKd 1 0 0\nnewmtl blue\n\tKd 0 0 1\n";

/// Fills the strip with a material file of this place and content; the areas' colors and the messages.
fn fill(mtllib: &str, place: &str, content: &str) -> (Vec<String>, String) {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("sub")).unwrap();
    fs::write(folder.path().join("a.obj"), format!("# a\n{mtllib}\n{STRIP}")).unwrap();
    fs::write(folder.path().join(place), content).unwrap();
    let arguments = ["fill", "a.obj", "--view", "top", "--light", "0,0,1", "--no-edges"];
    let output = hiddenline(folder.path(), &[&arguments[..], &["--format", "svg"]].concat());
    let stderr = text(&output.stderr);
    assert!(output.status.success() && !stderr.contains("panic"), "{stderr}");
    let svg = text(&output.stdout);
    let mut colors: Vec<String> =
        svg.split("fill=\"#").skip(1).map(|rest| rest[..6].to_owned()).collect();
    colors.dedup();
    (colors, stderr)
}

#[test]
fn material_files_are_found_whatever_their_names_look_like() {
    let (expected, stderr) = fill("mtllib m.mtl", "m.mtl", RED_AND_BLUE);
    assert_eq!(expected.len(), 2, "{stderr}");
    assert!(!stderr.contains("warning"), "{stderr}");
    for (mtllib, place) in [
        ("mtllib sub\\m.mtl", "sub/m.mtl"),
        ("mtllib .\\SUB\\M.MTL", "sub/m.mtl"),
        ("mtllib ./m.MTL", "m.mtl"),
        ("mtllib C:\\models\\old\\m.mtl", "m.mtl"),
        ("mtllib textures/m.mtl", "m.mtl"),
        ("mtllib my materials.mtl", "my materials.mtl"),
        ("mtllib \"my materials.mtl\"", "my materials.mtl"),
        ("mtllib missing.mtl m.mtl", "m.mtl"),
        ("mtllib\tm.mtl  # note", "m.mtl"),
        ("mtllib m.mtl\nmtllib m.mtl", "m.mtl"),
    ] {
        let (colors, stderr) = fill(mtllib, place, RED_AND_BLUE);
        assert_eq!(colors, expected, "{mtllib}: {stderr}");
        assert!(!stderr.contains("warning"), "{mtllib}: {stderr}");
    }
    let (colors, stderr) = fill("mtllib gone.mtl", "m.mtl", RED_AND_BLUE);
    assert_eq!(colors.len(), 1);
    assert!(stderr.contains("a.obj:2: the material file `gone.mtl` was not found"), "{stderr}");
}

#[test]
fn materials_that_are_defined_nowhere_are_told_with_their_line() {
    let (_, stderr) = fill("mtllib m.mtl", "m.mtl", "newmtl red one\nKd 1 0 0\n");
    let told =
        "a.obj:11: the material `blue` is not in the material file; its faces have no color\n";
    assert!(stderr.contains(told), "{stderr}");
    // One without a diffuse color is defined all the same.
    let (_, stderr) = fill("mtllib m.mtl", "m.mtl", "newmtl red one\nKd 1 0 0\nnewmtl  blue # 2\n");
    assert!(!stderr.contains("warning"), "{stderr}");
    let (_, stderr) = fill("# none", "m.mtl", "newmtl red one\nKd 1 0 0\n");
    assert!(!stderr.contains("warning"), "{stderr}");
    let more = "usemtl a\nusemtl b\nusemtl c\nmtllib m.mtl";
    let (_, stderr) = fill(more, "m.mtl", "newmtl blue\n");
    assert_eq!(stderr.matches("is not in the material file").count(), 3, "{stderr}");
    assert!(
        stderr.contains("`c` is not in the material file; its faces have no color (1 more"),
        "{stderr}"
    );
    assert!(!stderr.contains("red one"), "{stderr}");
}

#[test]
fn no_line_of_a_material_file_costs_the_others() {
    let (expected, _) = fill("mtllib m.mtl", "m.mtl", RED_AND_BLUE);
    for odd in ["Kd 0.5", "Kd", "Kd 1 2 three", "Kd nan 0 0", "Kd spectral a.rfl 1"] {
        let content = format!("newmtl odd\n{odd}\n{RED_AND_BLUE}newmtl late\n{odd}");
        let (colors, stderr) = fill("mtllib m.mtl", "m.mtl", &content);
        assert_eq!(colors, expected, "{odd}");
        assert_eq!(stderr.contains("m.mtl:2: "), odd != "Kd 0.5", "{odd}: {stderr}");
    }
    for odd in ["illum x", "d", "Ns 1e999", "map_Kd", "Ka 1", "Tf xyz", "\u{0}\u{1}", "newmtl"] {
        let (colors, stderr) =
            fill("mtllib m.mtl", "m.mtl", &format!("{odd}\n{RED_AND_BLUE}{odd}"));
        assert_eq!(colors, expected, "{odd}");
        assert!(!stderr.contains("warning"), "{odd}: {stderr}");
    }
}
