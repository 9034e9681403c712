//! Boundary edges that lie flush in coplanar faces, whole or in part.

use std::collections::BTreeSet;

use crate::scenes::Rng;
use glam::{DVec3, dvec3};
use hiddenline::stages::camera::{Camera, Projection};
use hiddenline::stages::classify::LineSelection;
use hiddenline::stages::draw::{DrawOptions, draw};
use hiddenline::stages::engines::edge::LineEngine;
use hiddenline::stages::model::mesh::{Mesh, PolygonSoup};
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::strokes::StrokeKind;

/// A rectangle as its lowest and highest corner.
type Rectangle = [[i32; 2]; 2];

const BOUNDARY: LineSelection = LineSelection::NONE.with(StrokeKind::Boundary);

/// Rectangles in the plane that `place` puts them in.
fn scene(rectangles: &[Rectangle], place: impl Fn(usize, i32, i32) -> DVec3) -> Scene {
    let mut soup = PolygonSoup::default();
    for (number, &[[x0, y0], [x1, y1]]) in rectangles.iter().enumerate() {
        let first = soup.positions.len() as u32;
        let corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
        soup.positions.extend(corners.map(|[x, y]| place(number, x, y)));
        soup.push_face(&[first, first + 1, first + 2, first + 3]);
    }
    Scene::new(Mesh::new(soup).unwrap().0).with_flush_edges()
}

fn flat(_: usize, x: i32, y: i32) -> DVec3 {
    dvec3(f64::from(x), f64::from(y), 0.0)
}

/// A side of a rectangle: its ends, and the step to the cells on the other side.
fn sides([[x0, y0], [x1, y1]]: Rectangle) -> [([[i32; 2]; 2], [i32; 2]); 4] {
    [
        ([[x0, y0], [x1, y0]], [0, -1]),
        ([[x0, y1], [x1, y1]], [0, 1]),
        ([[x0, y0], [x0, y1]], [-1, 0]),
        ([[x1, y0], [x1, y1]], [1, 0]),
    ]
}

/// The flush parts of a side, cell by cell: stretches between corners of the rectangles beyond.
fn true_parts(
    rectangles: &[Rectangle],
    own: usize,
    (ends, out): ([[i32; 2]; 2], [i32; 2]),
) -> Vec<[[i32; 2]; 2]> {
    let axis = usize::from(ends[0][0] == ends[1][0]);
    let (from, to) = (ends[0][axis], ends[1][axis]);
    let (line, beyond) = (ends[0][1 - axis], out[1 - axis]);
    // The cell just beyond the side, as its lower corner.
    let across = line + beyond.min(0);
    let covers = |r: &Rectangle, along: i32| {
        (r[0][axis]..r[1][axis]).contains(&along)
            && (r[0][1 - axis]..r[1][1 - axis]).contains(&across)
    };
    let others = || rectangles.iter().enumerate().filter(|(i, _)| *i != own).map(|(_, r)| r);
    let mut stops = BTreeSet::from([from, to]);
    for r in others().filter(|r| (from..to).any(|along| covers(r, along))) {
        if r[0][1 - axis] == line || r[1][1 - axis] == line {
            stops.extend([r[0][axis], r[1][axis]].into_iter().filter(|t| (from..to).contains(t)));
        }
    }
    let stops: Vec<i32> = stops.into_iter().collect();
    let mut parts: Vec<[i32; 2]> = Vec::new();
    for pair in stops.windows(2) {
        if (pair[0]..pair[1]).all(|along| others().any(|r| covers(r, along))) {
            match parts.last_mut().filter(|last| last[1] == pair[0]) {
                Some(last) => last[1] = pair[1],
                None => parts.push([pair[0], pair[1]]),
            }
        }
    }
    let at = |t: i32| if axis == 0 { [t, line] } else { [line, t] };
    parts.into_iter().map(|part| part.map(at)).collect()
}

#[test]
fn parts_of_boundary_edges_are_flush_where_cells_beyond_are_covered() {
    let (mut n_whole, mut n_parts) = (0, 0);
    for seed in 0..400 {
        let mut rng = Rng(seed);
        let mut random = |n: usize| rng.below(n) as i32;
        let n = 2 + random(5) as usize;
        let rectangles: Vec<Rectangle> = (0..n)
            .map(|_| {
                let (x, y) = (random(5), random(5));
                [[x, y], [x + 1 + random(3), y + 1 + random(3)]]
            })
            .collect();
        // One plane in space, on whose lattice nothing is rounded.
        let [u, v] = [dvec3(3.0, -1.0, 2.0), dvec3(1.0, 4.0, -5.0)];
        let place = |x: i32, y: i32| f64::from(x) * u + f64::from(y) * v + dvec3(7.0, 0.25, -3.0);
        let scene = scene(&rectangles, |_, x, y| place(x, y));
        let topology = scene.topology();
        let vertex = |[x, y]: [i32; 2]| {
            let found = scene.mesh().positions().iter().position(|&p| p == place(x, y));
            found.unwrap() as u32
        };
        for (own, &rectangle) in rectangles.iter().enumerate() {
            for side in sides(rectangle) {
                let ends = side.0.map(vertex);
                let edge = topology.find_edge(ends[0], ends[1]).unwrap();
                if topology.uses(edge).len() != 1 {
                    continue;
                }
                let pair = |ends: [u32; 2]| [ends[0].min(ends[1]), ends[0].max(ends[1])];
                let expected: BTreeSet<[u32; 2]> = true_parts(&rectangles, own, side)
                    .into_iter()
                    .map(|part| pair(part.map(vertex)))
                    .collect();
                let parts = scene.boundary_parts().iter().filter(|part| part.edge == edge);
                let mut joined: Vec<[u32; 2]> = Vec::new();
                for part in parts.clone().filter(|part| part.is_flush) {
                    match joined.last_mut().filter(|last| last[1] == part.ends[0]) {
                        Some(last) => last[1] = part.ends[1],
                        None => joined.push(part.ends),
                    }
                }
                let mut found: BTreeSet<[u32; 2]> = joined.into_iter().map(pair).collect();
                assert_eq!(scene.is_split(edge), !found.is_empty());
                if scene.is_flush(edge) {
                    found.insert(pair(ends));
                    n_whole += 1;
                }
                assert_eq!(found, expected, "seed {seed}: {rectangles:?}, {side:?}");
                // The parts follow each other along the edge, boundary ones as long as they can be.
                let parts: Vec<_> = parts.collect();
                for pair in parts.windows(2) {
                    assert_eq!(pair[0].ends[1], pair[1].ends[0]);
                    assert!(pair[0].is_flush || pair[1].is_flush);
                }
                if let (Some(first), Some(last)) = (parts.first(), parts.last()) {
                    assert_eq!([first.ends[0], last.ends[1]], topology.edge(edge));
                    n_parts += parts.len();
                }
            }
        }
    }
    assert!(n_whole > 100 && n_parts > 400, "{n_whole} whole edges, {n_parts} parts");
}

/// The length of all strokes, seen from above.
fn length(scene: &Scene, lines: LineSelection, engine: LineEngine) -> f64 {
    let (eye, target) = (dvec3(3.0, 2.0, 50.0), dvec3(3.0, 2.0, 0.0));
    let camera = Camera::new(eye, target, DVec3::Y, Projection::Orthographic).unwrap();
    let options = DrawOptions { lines, engine, ..DrawOptions::default() };
    let drawn = draw(scene, &camera, &options, 1.0);
    let lengths = drawn
        .drawing
        .iter()
        .map(|stroke| stroke.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>());
    lengths.sum()
}

#[test]
fn of_a_plate_beside_half_of_another_only_the_common_border_is_drawn() {
    // Their union has the border 16; they touch along 2.
    let plates = [[[0, 0], [4, 2]], [[1, 2], [3, 4]]];
    let with_mesh = BOUNDARY.with(StrokeKind::Mesh);
    let outline = LineSelection::NONE.with_outline();
    for engine in [LineEngine::Roberts, LineEngine::Appel, LineEngine::AllPairs] {
        let close = |found: f64, expected: f64| {
            assert!((found - expected).abs() < 1e-9, "{engine:?}: {found}, not {expected}");
        };
        let flush = scene(&plates, flat);
        close(length(&flush, BOUNDARY, engine), 16.0);
        close(length(&flush, with_mesh, engine), 18.0);
        close(length(&flush, outline, engine), 16.0);
        // Three together cover all of one side, and none of them alone.
        let row = [[[0, 0], [6, 2]], [[0, 2], [1, 4]], [[1, 2], [4, 3]], [[4, 2], [6, 4]]];
        close(length(&scene(&row, flat), BOUNDARY, engine), 22.0);
    }
}

#[test]
fn a_line_that_coincides_with_a_flush_part_is_not_lost() {
    // Under the seam of two plates hangs a slanted fin whose upper edge is a piece of the seam.
    let plates = [[[0, 0], [4, 2]], [[1, 2], [3, 4]], [[1, -1], [2, 0]]];
    let hung = |n: usize, x: i32, y: i32| match n {
        2 => dvec3(f64::from(x), f64::from(2 + y), f64::from(y)),
        _ => flat(n, x, y),
    };
    let scene = scene(&plates, hung);
    for engine in [LineEngine::Roberts, LineEngine::Appel, LineEngine::AllPairs] {
        let found = length(&scene, BOUNDARY, engine);
        assert!((found - 17.0).abs() < 1e-9, "{engine:?}: {found}");
    }
}

#[test]
fn parts_before_a_larger_face_are_no_outline() {
    let plates = [[[0, 0], [4, 2]], [[1, 2], [3, 4]], [[-1, -1], [6, 6]]];
    let deeper = |n: usize, x: i32, y: i32| flat(n, x, y) - (n / 2) as f64 * DVec3::Z;
    let scene = scene(&plates, deeper);
    let found = length(&scene, LineSelection::NONE.with_outline(), LineEngine::Roberts);
    assert!((found - 28.0).abs() < 1e-9, "{found}");
}

#[test]
fn faces_that_are_out_of_plane_by_the_last_bits_are_not_flush() {
    let plates = [[[0, 0], [4, 2]], [[1, 2], [3, 4]]];
    let lifted = |n: usize, x: i32, y: i32| flat(n, x, y) + (1.0 + n as f64 * 1e-15) * DVec3::Z;
    let scene = scene(&plates, lifted);
    assert!(scene.boundary_parts().is_empty());
    assert!((0..scene.topology().edges().len() as u32).all(|edge| !scene.is_flush(edge)));
}
