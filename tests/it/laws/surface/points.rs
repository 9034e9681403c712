//! Scattered points: what is read, left out and merged.

use glam::{DVec3, dvec3};
use hiddenline::stages::surface::{Duplicates, PointsError, ScatteredPoints};

fn read(text: &str) -> ScatteredPoints {
    ScatteredPoints::read(text, None).expect("points")
}

#[test]
fn points_are_read_in_every_spelling() {
    let expected = [dvec3(0.5, 1.0, -2.0), dvec3(3.0, 4.0, 5.25)];
    for text in [
        "0.5 1 -2\n3 4 5.25\n",
        "0.5,1,-2,red\n3,4,5.25,green\n",
        "0,5;1;-2\n3;4;5,25\n",
        "0,5 1,0 -2,0\n3,0 4,0 5,25\n",
        "x;y;z\n0,5;1;-2\n3;4;5,25\n",
        "survey of 2020, by hand: 1,5 m\neast north height\n\n0.5\t1\t-2 # a rock\n3\t4\t5.25\n",
    ] {
        assert_eq!(read(text).points, expected, "{text}");
    }
    assert_eq!(read("a b c\n\n1 2 3\n# d\n4 5 6\n").lines, [3, 5]);
    assert_eq!(read("a b c\nd e\n1 2 3\n").n_titles, 2);
}

#[test]
fn points_without_a_height_are_left_out_and_counted() {
    let text = "0 0 1\n1 0 nan\n2 0 -\n3 0 null\n4 0 -9999\n5 0 2\n";
    let found = ScatteredPoints::read(text, Some(-9999.0)).expect("points");
    assert_eq!(found.points, [DVec3::Z, dvec3(5.0, 0.0, 2.0)]);
    assert_eq!((found.n_without_height, &found.lines[..]), (4, &[1, 6][..]));
    for (text, line) in [("0 0 1\n1 2\n", 2), ("0 0 1\nnan 0 1\n", 2), ("0 0 1\n\n1 1 x\n", 3)] {
        let error = ScatteredPoints::read(text, None).expect_err("an error");
        assert_eq!(error, PointsError::NotAPoint { line });
    }
    let mixed = ScatteredPoints::read("0,5;0;1\n0.5;1;1\n", None).expect_err("an error");
    assert_eq!(mixed, PointsError::MixedDecimals { line: 2 });
}

#[test]
fn points_at_one_place_are_merged_as_asked() {
    // The second place is written with both zeros.
    let text = "1 1 4\n0 5 1\n1 1 8\n-0 5 1\n2 2 7\n1 1 6\n";
    let merged = |duplicates| {
        let mut points = read(text);
        points.merge(duplicates).map(|n| (n, points.points[0].z, points.lines))
    };
    assert_eq!(merged(Duplicates::First), Ok((3, 4.0, vec![1, 2, 5])));
    assert_eq!(merged(Duplicates::Mean), Ok((3, 6.0, vec![1, 2, 5])));
    assert_eq!(merged(Duplicates::Max), Ok((3, 8.0, vec![1, 2, 5])));
    let clash = PointsError::TwoHeights { points: [0, 2], x: 1.0, y: 1.0, heights: [4.0, 8.0] };
    assert_eq!(merged(Duplicates::Error), Err(clash));
    // Of several such places the one is named that shows first in the file.
    let mut two = read("5 5 0\n1 1 0\n1 1 1\n0 0 0\n5 5 1\n0 0 1\n");
    let first = PointsError::TwoHeights { points: [1, 2], x: 1.0, y: 1.0, heights: [0.0, 1.0] };
    assert_eq!(two.merge(Duplicates::Error), Err(first));
    let mut equal = read("0 0 1\n1 0 1\n0 0 1\n");
    assert_eq!(equal.merge(Duplicates::Error), Ok(1));
    assert_eq!(equal.points, [DVec3::Z, dvec3(1.0, 0.0, 1.0)]);
    let mut huge = read("0 0 1e308\n0 0 1.5e308\n1 1 1\n");
    assert_eq!(huge.merge(Duplicates::Mean), Ok(1));
    assert_eq!(huge.points[0].z, 1.25e308);
}

#[test]
fn columns_are_found_by_their_names() {
    let expected = [dvec3(0.0, 0.0, 1.0), dvec3(1.0, 0.5, 0.25)];
    for text in [
        "id,x,y,z\n7,0,0,1\n8,1,0.5,0.25\n",
        "z,x,y\n1,0,0\n0.25,1,0.5\n",
        "\"Y\";\"Z\";\"X\"\n0;1;0\n0,5;0,25;1\n",
        "name x y z color\np1 0 0 1 red\np2 1 0.5 0.25 blue\n",
        // No names, or not all: the first three.
        "a,b,c,d\n0,0,1,9\n1,0.5,0.25,9\n",
        "x,y,height\n0,0,1\n1,0.5,0.25\n",
        "x,y,z,z\n0,0,1,9\n1,0.5,0.25,9\n",
    ] {
        assert_eq!(read(text).points, expected, "{text}");
    }
}
