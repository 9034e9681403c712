//! OBJ: lines, numbers, parts, and what is skipped.

use glam::dvec3;
use hiddenline::stages::read::Notice;

use super::{assert_message, good, refused};

#[test]
fn obj_comments_end_before_lines_are_joined() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
    for (faces, expected) in [
        ("f 1 2 3 \\\n4\n", &[4][..]),
        ("f 1 2 3\\\n4\n", &[4]),
        ("f 1 2 3 \\ \t\r\n4\n", &[4]),
        ("f 1 2 3 \\\n\\\n\\\n4", &[4]),
        ("f 1 2 3 \\", &[3]),
        ("f 1 2 3#4 \\\n", &[3]),
        ("f 1 2 3 # \\\nf 1 3 4\n", &[3, 3]),
        ("# \\\nf 1 2 3\n", &[3]),
        ("f \\\n1 2 \\\n# \\\nf 1 2 3\n", &[3]),
        ("xyz \\\nf 1 2 3\nf 2 3 4\n", &[3]),
    ] {
        let model = good("x.obj", format!("{vertices}{faces}"));
        let sizes: Vec<_> = model.mesh.face_starts().windows(2).map(|w| w[1] - w[0]).collect();
        assert_eq!(sizes, expected, "{faces:?}");
    }
    // Lines are counted as the file has them.
    let error = refused("x.obj", format!("{vertices}\\\n\\\n# \\\nf 1 2 \\\r\n 3 \\\r\n 5 6"));
    assert_message(&error, "x.obj:10: ", "vertex 6, but there are only 4");
    let error = refused("x.obj", format!("{vertices}f 1 2 3 \\\n\\\nx"));
    assert_message(&error, "x.obj:7: ", "`x` is not the number of a vertex");
}

#[test]
fn obj_numbers_are_the_nearest_doubles() {
    for word in [
        "0.1",
        "+0.1",
        "-.5",
        "5.",
        "1e-400",
        "1E+300",
        "123456789012345678901234567890",
        "0.1000000000000000055511151231257827021181583404541015625001",
        "9007199254740993",
        "2.2250738585072011e-308",
        "1.7976931348623158e308",
        "8.98846567431158e307",
        "6.02214076E23",
    ] {
        let value: f64 = word.parse().expect(word);
        for (name, text) in [
            ("x.obj", format!("v 3 0 {word}\nv 1 0 0 0.5 7\nv 0 1 0 1 0 0 9\nf 1 2 3\n")),
            ("x.off", format!("OFF\n3 1 0\n3 0 {word}\n1 0 0 0.5\n0 1 0 1 0 0\n3 0 1 2 255 0 0\n")),
            (
                "x.stl",
                format!(
                    "solid\nfacet outer loop vertex 3 0 {word} vertex 1 0 0 vertex 0 1 0 \
                     endloop endfacet endsolid"
                ),
            ),
        ] {
            let positions = good(name, text).mesh.positions().to_vec();
            let expected = [dvec3(3.0, 0.0, value), dvec3(1.0, 0.0, 0.0), dvec3(0.0, 1.0, 0.0)];
            assert_eq!(positions, expected, "{word} in {name}");
        }
    }
    let zeros = "0".repeat(400);
    for (word, part) in [
        ("1e400", "not a finite number"),
        ("-inf", "not a finite number"),
        ("NaN", "not a finite number"),
        (&format!("1{zeros}"), "not a finite number"),
        ("0x10", "not a decimal number"),
        ("1,5", "not a decimal number"),
        ("1e", "not a decimal number"),
        (".", "not a decimal number"),
        ("--1", "not a decimal number"),
        ("1.2.3", "not a decimal number"),
        ("1.#IND", "`1.#IND` is not a finite number"),
        ("1.#", "3 numbers expected"),
    ] {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n\nv 0 {word} 0\nf 1 2 4\n");
        assert_message(&refused("x.obj", text), "x.obj:5: ", part);
    }
    assert_message(
        &refused("x.obj", "v 1 2\nf 1 1 1"),
        "x.obj:1: ",
        "3 numbers expected for a vertex, 2 found",
    );
    let long = good("x.obj", format!("v 1{zeros}e-400 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3"));
    assert_eq!(long.mesh.positions()[0], dvec3(1.0, 0.0, 0.0));
}

#[test]
fn obj_groups_and_materials_become_parts_in_file_order() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no  my  box # note\nusemtl red#1\nf 1 2 3\n\
                f 3 2 1\ng lid\nf 1 2 3\no my box\nf 1 2 3\ng unused\n";
    let mesh = good("x.obj", text).mesh;
    let parts: Vec<_> =
        mesh.parts().iter().map(|p| (p.group.as_str(), p.material.as_str())).collect();
    assert_eq!(parts, [("", ""), ("my box", "red#1"), ("lid", "red#1")]);
    assert_eq!(mesh.face_parts(), [0, 1, 1, 2, 1]);
    assert_eq!(mesh.positions().len(), 3);
    let plain = good("x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").mesh;
    assert!(plain.parts().is_empty() && plain.face_parts().is_empty());
}

#[test]
fn what_obj_readers_skip_they_say() {
    let text = "vp 1 2\nl 1 2\ncurv 0 1 \\\n 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvp 3\np 1\nf 1 2 3\n";
    let model = good("x.obj", text);
    let said: Vec<_> = model.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        said,
        [
            "x.obj: 1 point left out, first on line 9",
            "x.obj: unknown record `vp` skipped (2 times, first on line 1)",
            "x.obj: unknown record `curv` skipped (1 time, first on line 3)",
        ]
    );
    let many: String = (0..1000).map(|i| format!("junk{i}\n")).collect();
    let model = good("x.obj", format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n{many}"));
    assert_eq!(model.warnings.len(), 7);
    assert_eq!(model.warnings[6].notice, Notice::OtherUnknownRecords { count: 994 });
}

#[test]
fn obj_normals_belong_to_corners_and_cost_no_face_where_they_are_wrong() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
    let normals = "vn 0 0 1\nvn 0 0.6 8e-1\nvn x 1 0\nvn 1 0\n";
    let (up, tilted, none) = ([0.0, 0.0, 1.0], [0.0, 0.6, 0.8], [0.0; 3]);
    for (faces, expected) in [
        ("f 1//1 2//2 3//1\n", vec![up, tilted, up]),
        ("f 1/7/1 2/8/2 3/9/1\n", vec![up, tilted, up]),
        // Counted back from the last, here from the first two.
        ("f 1//-4 2//-3 3//-4\n", vec![up, tilted, up]),
        ("f +1//+1 2//2 \\\n3//1 # four\n", vec![up, tilted, up]),
        // Neither numbers that do not exist nor normals that are none.
        ("f 1//1 2//3 3//4\n", vec![up, none, none]),
        ("f 1//1 2//5 3//0\n", vec![up, none, none]),
        ("f 1//1 2//99999999999999999999 3//-9\n", vec![up, none, none]),
        ("f 1//x 2// 3//1/2\n", vec![none, none, up]),
        // Faces without any, and such that are left out.
        (
            "f 1 2 3\nf 2//2 3//1 4//2\nf 1 2 4\n",
            vec![none, none, none, tilted, up, tilted, none, none, none],
        ),
        ("f 1//1 2//1\nf 1//2 2//2 3//1\n", vec![tilted, tilted, up]),
        ("f 1//2 2//1 \nf 1//2 2//2 3//1\nl 1 2\n", vec![tilted, tilted, up]),
        ("f 1//2 2//1\nf 1 2 3\n", vec![]),
        ("f 1//2 2//1\nf 1 2 3//1\n", vec![none, none, up]),
        ("f 1/1 2/1 3/1\n", vec![]),
    ] {
        let model = good("x.obj", format!("{vertices}{normals}{faces}"));
        assert_eq!(model.mesh.corner_normals(), expected, "{faces:?}");
    }
    // Faces may come before what they name.
    let model = good("x.obj", format!("f 1//1 2//2 3//1\n{normals}{vertices}"));
    assert_eq!(model.mesh.corner_normals(), [up, tilted, up]);
}
