//! Joining and ordering keep the ink, draw nothing twice, and lift the pen as rarely as possible.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, Vec2Swizzles, dvec2};
use hiddenline::stages::optimize::estimate::{Motion, estimate_lines};
use hiddenline::stages::optimize::{
    Effort, Graph, Joints, OptimizeOptions, optimize, optimize_lines, optimize_watched, order,
    split_by_distance,
};
use hiddenline::stages::plot::{Layer, Pen, Plot, Polylines};
use proptest::prelude::*;

type Lattice = (i64, i64);
type Step = (Lattice, Lattice);

fn polylines(lines: &[Vec<DVec2>]) -> Polylines {
    let mut result = Polylines::default();
    for line in lines {
        result.push(line.iter().copied());
    }
    result
}

/// Cuts a segment between lattice points into its smallest lattice steps, each written with its
/// lower end first: two segments overlap exactly where they share steps.
fn steps(line: &[DVec2]) -> Vec<Step> {
    fn gcd(a: i64, b: i64) -> i64 {
        if b == 0 { a.abs() } else { gcd(b, a % b) }
    }
    let mut steps = Vec::new();
    for pair in line.windows(2) {
        let (a, b) = ((pair[0].x as i64, pair[0].y as i64), (pair[1].x as i64, pair[1].y as i64));
        let n = gcd(b.0 - a.0, b.1 - a.1);
        for i in 0..n {
            let at = |i| (a.0 + (b.0 - a.0) / n * i, a.1 + (b.1 - a.1) / n * i);
            let (p, q) = (at(i), at(i + 1));
            steps.push((p.min(q), p.max(q)));
        }
    }
    steps
}

fn lattice_lines(extent: i32, n: usize) -> impl Strategy<Value = Vec<Vec<DVec2>>> {
    let point = (0..extent, 0..extent).prop_map(|(x, y)| dvec2(f64::from(x), f64::from(y)));
    prop::collection::vec(prop::collection::vec(point, 2..5), 1..n)
}

/// Sets of unit edges of a grid, some of them twice and either way around.
fn unit_edges() -> impl Strategy<Value = Vec<Vec<DVec2>>> {
    let edge = (0..7, 0..7, any::<bool>(), any::<bool>()).prop_map(|(x, y, across, back)| {
        let a = dvec2(f64::from(x), f64::from(y));
        let b = a + if across { DVec2::X } else { DVec2::Y };
        if back { vec![b, a] } else { vec![a, b] }
    });
    prop::collection::vec(edge, 1..80)
}

/// Fewest strokes that draw each edge once: a part with k odd vertices takes max(1, k / 2).
fn fewest_strokes(edges: &BTreeSet<Step>) -> usize {
    let mut neighbors: BTreeMap<Lattice, Vec<Lattice>> = BTreeMap::new();
    for &(a, b) in edges {
        neighbors.entry(a).or_default().push(b);
        neighbors.entry(b).or_default().push(a);
    }
    let mut seen = BTreeSet::new();
    let mut total = 0;
    for &start in neighbors.keys() {
        let mut odd = 0;
        let mut stack = vec![start];
        if !seen.insert(start) {
            continue;
        }
        while let Some(p) = stack.pop() {
            odd += neighbors[&p].len() % 2;
            stack.extend(neighbors[&p].iter().filter(|&&q| seen.insert(q)));
        }
        total += (odd / 2).max(1);
    }
    total
}

fn efforts() -> [Effort; 3] {
    [Effort::None, Effort::Fast, Effort::Best]
}

fn exact(effort: Effort) -> OptimizeOptions {
    OptimizeOptions {
        join_tolerance_mm: Some(0.0),
        overlap_mm: 0.0,
        effort,
        ..OptimizeOptions::default()
    }
}

fn distance_to(p: DVec2, lines: &Polylines) -> f64 {
    let mut nearest = f64::INFINITY;
    for pair in lines.iter().flat_map(|line| line.windows(2)) {
        let along = pair[1] - pair[0];
        let t = (p - pair[0]).dot(along) / along.length_squared();
        let t = if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) };
        nearest = nearest.min(p.distance(pair[0] + along * t));
    }
    nearest
}

/// Largest distance of points along `a` from `b`.
fn deviation(a: &Polylines, b: &Polylines) -> f64 {
    let mut worst = 0.0_f64;
    for pair in a.iter().flat_map(|line| line.windows(2)) {
        for i in 0..=16 {
            worst = worst.max(distance_to(pair[0].lerp(pair[1], f64::from(i) / 16.0), b));
        }
    }
    worst
}

fn pen_up(lines: &Polylines) -> f64 {
    let strokes: Vec<&[DVec2]> = lines.iter().collect();
    strokes.windows(2).map(|w| w[0][w[0].len() - 1].distance(w[1][0])).sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn every_piece_of_ink_is_drawn_exactly_once(lines in lattice_lines(9, 30)) {
        let wanted: BTreeSet<Step> = lines.iter().flat_map(|line| steps(line)).collect();
        for effort in efforts() {
            let result = optimize_lines(&polylines(&lines), None, &exact(effort));
            let mut drawn: Vec<Step> = result.lines.iter().flat_map(steps).collect();
            drawn.sort_unstable();
            prop_assert_eq!(&drawn, &wanted.iter().copied().collect::<Vec<_>>());
        }
    }

    #[test]
    fn strokes_are_as_few_as_the_graph_allows(edges in unit_edges()) {
        let wanted: BTreeSet<Step> = edges.iter().flat_map(|line| steps(line)).collect();
        for effort in efforts() {
            let result = optimize_lines(&polylines(&edges), None, &exact(effort));
            prop_assert_eq!(result.lines.len(), fewest_strokes(&wanted));
        }
    }

    #[test]
    fn ink_stays_within_a_micrometer(
        lines in prop::collection::vec(
            prop::collection::vec((0.0..40.0f64, 0.0..40.0f64), 2..6), 1..25),
        copies in prop::collection::vec((any::<prop::sample::Index>(), 0.0..1.0f64), 0..10),
    ) {
        let mut lines: Vec<Vec<DVec2>> =
            lines.iter().map(|l| l.iter().map(|&(x, y)| dvec2(x, y)).collect()).collect();
        // Parts of lines once more, rounded as files round them.
        for (index, t) in copies {
            let line = lines[index.index(lines.len())].clone();
            let middle = line[0].lerp(line[1], t);
            lines.push(vec![line[1], (middle * 1e3).round() / 1e3]);
        }
        let before = polylines(&lines);
        for effort in efforts() {
            let after = optimize_lines(&before, None, &OptimizeOptions { effort, ..OptimizeOptions::default() }).lines;
            prop_assert!(deviation(&before, &after) <= 0.001 + 1e-12);
            prop_assert!(deviation(&after, &before) <= 0.001 + 1e-12);
            let same = order(&before, effort).lines;
            prop_assert!(deviation(&before, &same) <= 1e-9 && deviation(&same, &before) <= 1e-9);
            prop_assert_eq!(same.len(), before.len());
        }
    }

    #[test]
    fn simplified_strokes_stay_within_the_stated_distance(
        line in prop::collection::vec((0.0..10.0f64, 0.0..10.0f64), 3..60), tolerance in 0.01..2.0f64,
    ) {
        let before = polylines(&[line.iter().map(|&(x, y)| dvec2(x, y)).collect()]);
        let options = OptimizeOptions { simplify_mm: tolerance, ..exact(Effort::None) };
        let after = optimize_lines(&before, None, &options).lines;
        prop_assert!(deviation(&before, &after) <= tolerance + 1e-9);
        prop_assert!(after.n_points() <= before.n_points());
    }

    #[test]
    fn the_order_of_the_input_does_not_matter(lines in lattice_lines(9, 20), turn in any::<bool>()) {
        let mut other = lines.clone();
        other.reverse();
        if turn {
            other.iter_mut().for_each(|line| line.reverse());
        }
        let [a, b] = [lines, other]
            .map(|lines| optimize_lines(&polylines(&lines), None, &OptimizeOptions::default()).lines);
        prop_assert_eq!(a, b);
    }
}

#[test]
fn the_best_order_of_a_few_strokes_is_found() {
    fn shortest(strokes: &[[DVec2; 2]], used: u32, here: Option<DVec2>, left: usize) -> f64 {
        if left == 0 {
            return 0.0;
        }
        let mut best = f64::INFINITY;
        for (i, stroke) in strokes.iter().enumerate().filter(|(i, _)| used & (1 << i) == 0) {
            for (a, b) in [(stroke[0], stroke[1]), (stroke[1], stroke[0])] {
                let way = here.map_or(0.0, |p| p.distance(a));
                best = best.min(way + shortest(strokes, used | (1 << i), Some(b), left - 1));
            }
        }
        best
    }
    let mut state = 7u64;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 40) as f64 / (1u64 << 24) as f64 * 100.0
    };
    for _ in 0..5 {
        let strokes: Vec<[DVec2; 2]> =
            (0..7).map(|_| [dvec2(random(), random()), dvec2(random(), random())]).collect();
        let lines = polylines(&strokes.iter().map(|s| s.to_vec()).collect::<Vec<_>>());
        let found = pen_up(&order(&lines, Effort::Best).lines);
        let optimum = shortest(&strokes, 0, None, strokes.len());
        assert!((found - optimum).abs() < 1e-6, "{found} instead of {optimum}");
    }
}

#[test]
fn closed_strokes_begin_where_the_pen_comes_by() {
    let square = |x: f64| {
        [(0.0, 0.0), (0.0, 10.0), (10.0, 10.0), (10.0, 0.0), (0.0, 0.0)]
            .map(|(dx, y)| dvec2(x + dx, y))
            .to_vec()
    };
    let lines = polylines(&[square(0.0), square(12.0), square(24.0)]);
    for effort in [Effort::Fast, Effort::Best] {
        let ordered = order(&lines, effort).lines;
        // A closed stroke is left where it was entered: 2 mm to the next, then past 10 and 2.
        assert!((pen_up(&ordered) - 14.0).abs() < 1e-9, "{}", pen_up(&ordered));
        assert!(ordered.iter().all(|line| line.len() == 5 && line[0] == line[4]));
    }
}

#[test]
fn closed_strokes_are_entered_anywhere_wherever_they_are_said_to_begin() {
    let square = |x: f64, first: usize| {
        let corners = [(0.0, 0.0), (0.0, 10.0), (10.0, 10.0), (10.0, 0.0)];
        (0..=4).map(|k| corners[(first + k) % 4]).map(|(dx, y)| dvec2(x + dx, y)).collect()
    };
    for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
        let lines = polylines(&[square(0.0, i), square(12.0, j), square(24.0, (i + j) % 4)]);
        for effort in [Effort::Fast, Effort::Best] {
            let ordered = order(&lines, effort).lines;
            assert!((pen_up(&ordered) - 14.0).abs() < 1e-9, "{i} {j}: {}", pen_up(&ordered));
        }
    }
}

#[test]
fn ink_farther_off_than_the_tolerance_is_kept_and_nearer_ink_is_not() {
    let mut n_checked = 0;
    for turn in 0..24 {
        let way = DVec2::from_angle(f64::from(turn) * 0.2617);
        let at = |x: f64, y: f64| dvec2(60.0, 60.0) + way * x + way.perp() * y;
        for (off, is_kept) in [(0.5, false), (0.9, false), (1.2, true), (2.0, true)] {
            let tolerance = 0.01;
            // A second line beside the middle of the first one, and others around.
            let mut lines = vec![vec![at(0.0, 0.0), at(40.0, 0.0)]];
            lines.push(vec![at(10.0, off * tolerance), at(30.0, off * tolerance)]);
            lines.extend((0..9).map(|k| {
                let x = 4.0 * f64::from(k);
                vec![at(x, 5.0 + x), at(x + 3.0, 9.0)]
            }));
            let graph = |tolerance: f64| {
                let mut graph = Graph::new(&polylines(&lines), Joints::Near(0.0));
                hiddenline::stages::optimize::remove_overlaps(&mut graph, tolerance);
                graph.length_mm()
            };
            let saved = graph(0.0) - graph(tolerance);
            let expected = if is_kept { 0.0 } else { 20.0 };
            assert!((saved - expected).abs() < 0.1, "{turn} {off}: {saved}");
            n_checked += 1;
        }
    }
    assert_eq!(n_checked, 96);
}

#[test]
fn ink_within_the_tolerance_is_found_on_both_sides_of_any_row_of_a_grid() {
    // Six points over a square of 100 mm: rows that hold about one each are this high.
    let row = (100.0f64 * 100.0 / 6.0).sqrt();
    for k in -40..=40 {
        let y = row + 0.0005 * f64::from(k);
        let line = vec![dvec2(20.0, y), dvec2(80.0, y)];
        let beside = vec![dvec2(30.0, y - 0.008), dvec2(70.0, y - 0.008)];
        let across = vec![dvec2(0.0, 0.0), dvec2(100.0, 100.0)];
        for turned in [false, true] {
            let lines = [line.clone(), beside.clone(), across.clone()]
                .map(|line| line.into_iter().map(|p| if turned { p.yx() } else { p }).collect());
            let mut graph = Graph::new(&polylines(&lines), Joints::Near(0.0));
            let before = graph.length_mm();
            hiddenline::stages::optimize::remove_overlaps(&mut graph, 0.01);
            let saved = before - graph.length_mm();
            assert!((saved - 40.0).abs() < 0.01, "{k} {turned}: {saved}");
        }
    }
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let lines = warped_net(25);
    let run = |n: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
        pool.install(|| optimize_lines(&lines, None, &OptimizeOptions::default()).lines)
    };
    assert_eq!(run(1), run(4));
}

#[test]
fn numbered_points_are_joints_wherever_they_are() {
    let lines = polylines(&[
        vec![dvec2(0.0, 0.0), dvec2(10.0, 0.0)],
        vec![dvec2(10.3, 0.1), dvec2(20.0, 0.0)],
    ]);
    let joined = optimize_lines(&lines, Some(&[0, 1, 1, 2]), &exact(Effort::Fast)).lines;
    assert_eq!(joined.len(), 1);
    let apart = optimize_lines(&lines, Some(&[0, 1, 3, 2]), &exact(Effort::Fast)).lines;
    assert_eq!(apart.len(), 2);
}

#[test]
fn chains_of_near_points_do_not_collapse() {
    let line: Vec<DVec2> = (0..=1000).map(|i| dvec2(f64::from(i) * 0.01, 0.0)).collect();
    let options = OptimizeOptions { join_tolerance_mm: Some(0.05), ..exact(Effort::None) };
    let joined = optimize_lines(&polylines(&[line]), None, &options).lines;
    let ends: Vec<&[DVec2]> = joined.iter().collect();
    assert_eq!(ends.len(), 1);
    assert!(ends[0][0].distance(ends[0][ends[0].len() - 1]) >= 9.9);
}

#[test]
fn dots_are_kept_unless_a_line_ends_there() {
    let (a, b, c) = (dvec2(1.0, 1.0), dvec2(2.0, 1.0), dvec2(5.0, 5.0));
    let lines = polylines(&[vec![a, b], vec![b, b], vec![c, c], vec![c, c, c]]);
    let joined = optimize_lines(&lines, None, &exact(Effort::Fast)).lines;
    let strokes: Vec<Vec<DVec2>> = joined.iter().map(<[DVec2]>::to_vec).collect();
    assert_eq!(strokes, [vec![a, b], vec![c, c]]);
}

#[test]
fn the_shortest_strokes_are_dropped_and_small_gaps_closed() {
    let ring = [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.05, 0.05)].map(|(x, y)| dvec2(x, y));
    let lines = polylines(&[ring.to_vec(), vec![dvec2(20.0, 0.0), dvec2(20.05, 0.0)]]);
    let options = OptimizeOptions { shortest_mm: 0.1, ..exact(Effort::None) };
    let joined = optimize_lines(&lines, None, &options).lines;
    let strokes: Vec<&[DVec2]> = joined.iter().collect();
    assert_eq!(strokes.len(), 1);
    assert_eq!(strokes[0].first(), strokes[0].last());
}

#[test]
fn numbers_that_are_none_do_not_stop_it() {
    let lines = polylines(&[
        vec![dvec2(f64::NAN, 0.0), dvec2(1.0, 0.0), dvec2(2.0, 0.0)],
        vec![dvec2(f64::INFINITY, 0.0), dvec2(1.0, f64::NEG_INFINITY)],
    ]);
    let joined = optimize_lines(&lines, None, &OptimizeOptions::default()).lines;
    assert_eq!(joined.iter().collect::<Vec<_>>(), [[dvec2(1.0, 0.0), dvec2(2.0, 0.0)]]);
}

/// A bent net of `n` by `n` meshes: its edges, and for each the grid numbers of its ends.
fn warped_net(n: i64) -> Polylines {
    let place = |(i, j): Lattice| {
        let (x, y) = (i as f64 * 3.0, j as f64 * 3.0);
        dvec2(100.0 + x + 5.0 * (y / 17.0).sin(), 50.0 + y + 4.0 * (x / 23.0).cos())
    };
    let mut edges = Vec::new();
    for i in 0..=n {
        for j in 0..=n {
            if i < n {
                edges.push(((i, j), (i + 1, j)));
            }
            if j < n {
                edges.push(((i, j), (i, j + 1)));
            }
        }
    }
    let lines: Vec<Vec<DVec2>> = edges.iter().map(|&(a, b)| vec![place(a), place(b)]).collect();
    polylines(&lines)
}

/// The same ink with edges paired at random at every vertex, so that as many strokes end there as must.
pub(crate) fn paired_by_chance(positions: &[DVec2], edges: &[[u32; 2]]) -> Polylines {
    let mut at: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (e, &[a, b]) in edges.iter().enumerate() {
        at.entry(a).or_default().push(2 * e);
        at.entry(b).or_default().push(2 * e + 1);
    }
    let mut mate = BTreeMap::new();
    let mut state = 1u64;
    for ends in at.values_mut() {
        for i in (1..ends.len()).rev() {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ends.swap(i, (state >> 33) as usize % (i + 1));
        }
        for pair in ends.chunks_exact(2) {
            mate.insert(pair[0], pair[1]);
            mate.insert(pair[1], pair[0]);
        }
    }
    let point = |end: usize| positions[edges[end / 2][end % 2] as usize];
    let mut used = vec![false; edges.len()];
    let mut arbitrary = Polylines::default();
    for start in (0..2 * edges.len()).filter(|h| !mate.contains_key(h)).chain(0..2 * edges.len()) {
        if used[start / 2] {
            continue;
        }
        let mut stroke = vec![point(start)];
        let mut h = start;
        loop {
            used[h / 2] = true;
            stroke.push(point(h ^ 1));
            match mate.get(&(h ^ 1)) {
                Some(&next) if !used[next / 2] => h = next,
                _ => break,
            }
        }
        arbitrary.push(stroke);
    }
    arbitrary
}

#[test]
fn straight_strokes_take_much_less_time_than_any() {
    let lines = warped_net(30);
    let graph = Graph::new(&lines, Joints::Near(0.0));
    let arbitrary = paired_by_chance(&graph.positions, &graph.edges);
    let ours = optimize_lines(&lines, None, &exact(Effort::Fast)).lines;
    assert!(ours.len() <= arbitrary.len());
    let seconds = |lines: &Polylines| estimate_lines(lines, &Motion::SAXI).seconds;
    let ratio = seconds(&ours) / seconds(&order(&arbitrary, Effort::Fast).lines);
    assert!(ratio < 0.65, "{ratio}");
}

#[test]
fn times_are_those_of_a_trapezoid() {
    // 50 mm/s after 6.25 mm in 0.25 s at 200 mm/s², the same to stop, 87.5 mm between.
    let line = polylines(&[vec![dvec2(0.0, 0.0), dvec2(100.0, 0.0)]]);
    let one = estimate_lines(&line, &Motion::SAXI);
    assert!((one.seconds - (0.12 + 0.25 + 1.75 + 0.25 + 0.12)).abs() < 1e-9, "{}", one.seconds);
    assert_eq!((one.strokes, one.lifts, one.down_mm, one.up_mm), (1, 1, 100.0, 0.0));
    // 4 mm never reach 50 mm/s: 2 mm each way at 200 mm/s² take √0.02 s.
    let short = polylines(&[vec![dvec2(0.0, 0.0), dvec2(4.0, 0.0)]]);
    let seconds = estimate_lines(&short, &Motion::SAXI).seconds;
    assert!((seconds - (0.24 + 2.0 * 0.02f64.sqrt())).abs() < 1e-9);
    // A point in the middle of a straight line costs nothing; a right angle costs a braking to
    // √(200 · 0.127 · s / (1 − s)) = 7.8307 mm/s with s = √½, and a turn back a full stop.
    let through = |x: f64, y: f64| {
        let bent = vec![dvec2(0.0, 0.0), dvec2(50.0, 0.0), dvec2(50.0 + x, y)];
        estimate_lines(&polylines(&[bent]), &Motion::SAXI).seconds - 0.24
    };
    assert!((through(50.0, 0.0) - 2.25).abs() < 1e-9);
    let v = (200.0 * 0.127 * 0.5f64.sqrt() / (1.0 - 0.5f64.sqrt())).sqrt();
    let leg = 0.25 + (50.0 - v) / 200.0 + (50.0 - 6.25 - (2500.0 - v * v) / 400.0) / 50.0;
    assert!((through(0.0, 50.0) - 2.0 * leg).abs() < 1e-9);
    assert!((through(-50.0, 0.0) - 2.0 * 1.25).abs() < 1e-9);
    // 400 mm/s² up to 200 mm/s: 50 mm to get there, 300 mm on, 50 mm to stop.
    let two = polylines(&[
        vec![dvec2(0.0, 0.0), dvec2(4.0, 0.0)],
        vec![dvec2(404.0, 0.0), dvec2(408.0, 0.0)],
    ]);
    let both = estimate_lines(&two, &Motion::SAXI);
    assert!((both.seconds - 2.0 * seconds - (0.5 + 1.5 + 0.5)).abs() < 1e-9);
    assert_eq!(both.up_mm, 400.0);
}

#[test]
fn layers_are_split_between_strokes() {
    let stroke = |y: f64| vec![dvec2(0.0, y), dvec2(100.0, y)];
    let pen = Pen { width_mm: 0.3, color: "#000000".to_owned() };
    let lines = polylines(&[stroke(0.0), stroke(1.0), stroke(2.0), stroke(3.0), stroke(4.0)]);
    let layer = Layer { number: 1, name: "visible".to_owned(), pen, lines, ..Layer::default() };
    let plot = Plot { width_mm: 200.0, height_mm: 10.0, layers: vec![layer], ..Plot::default() };
    let split = split_by_distance(&plot, 250.0, None);
    let parts: Vec<(u32, usize)> = split.layers.iter().map(|l| (l.number, l.lines.len())).collect();
    assert_eq!(parts, [(1, 2), (2, 2), (3, 1)]);
    assert_eq!(split_by_distance(&plot, 500.0, None), plot);
}

#[test]
fn parts_of_bent_strokes_overlap_by_the_length_asked_for() {
    // A stair of steps of 0.4 mm, so that overlaps and cuts fall inside steps.
    let stair: Vec<DVec2> =
        (0..200).map(|k| 0.4 * dvec2(f64::from((k + 1) / 2), f64::from(k / 2))).collect();
    let pen = Pen { width_mm: 0.3, color: "#000000".to_owned() };
    let layer = Layer { number: 1, pen, lines: polylines(&[stair]), ..Layer::default() };
    let plot = Plot { width_mm: 200.0, height_mm: 50.0, layers: vec![layer], ..Plot::default() };
    let whole = plot.layers[0].lines.length_mm();
    for overlap in [0.0, 0.1, 0.4, 1.0, 3.3] {
        let parts = split_by_distance(&plot, 10.0, Some(overlap)).layers;
        let n_cuts = parts.len() as f64 - 1.0;
        let drawn: f64 = parts.iter().map(|layer| layer.lines.length_mm()).sum();
        assert!(n_cuts > 6.0 && (drawn - whole - n_cuts * overlap).abs() < 1e-9, "{overlap}");
        for pair in parts.windows(2) {
            let [before, after] = [&pair[0].lines, &pair[1].lines]
                .map(|lines| lines.iter().next().expect("a stroke").to_vec());
            // The next part begins on the stair, so far before the end of the last.
            let along = |p: DVec2| p.x + p.y;
            let back = along(before[before.len() - 1]) - along(after[0]);
            assert!((back - overlap).abs() < 1e-9, "{overlap}: {back}");
        }
    }
}

#[test]
fn closed_trails_that_cross_are_one_stroke() {
    let square = |low: f64| {
        let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (0.0, 0.0)];
        let points: Vec<DVec2> = corners.map(|(x, y)| dvec2(low + x, low + y)).to_vec();
        let middle = |pair: &[DVec2]| [pair[0], pair[0].lerp(pair[1], 0.5)];
        let mut ring: Vec<DVec2> = points.windows(2).flat_map(middle).collect();
        ring.push(points[0]);
        ring
    };
    // They pass straight through each other at (1, 2) and (2, 1); a spur ends at (3, 4).
    let spur = vec![dvec2(3.0, 3.0), dvec2(3.0, 4.0)];
    for (lines, n) in
        [(vec![square(0.0), square(1.0)], 1), (vec![square(0.0), square(1.0), spur], 1)]
    {
        let joined = optimize_lines(&polylines(&lines), None, &exact(Effort::Fast)).lines;
        assert_eq!(joined.len(), n);
    }
}

#[test]
fn the_share_done_grows_from_nothing_to_all() {
    let square = |x: f64| vec![(x, 0.0), (x + 1.0, 0.0), (x + 1.0, 1.0), (x, 0.0)];
    for closed in [false, true] {
        let strokes: Vec<Vec<(f64, f64)>> =
            (0..3000)
                .map(|i| f64::from(i * 7919 % 3000))
                .map(|x| {
                    if closed {
                        square(2.0 * x)
                    } else {
                        vec![(2.0 * x, 0.0), (2.0 * x + 1.0, 5.0)]
                    }
                })
                .collect();
        let mut lines = Polylines::default();
        strokes.iter().for_each(|s| lines.push(s.iter().map(|&(x, y)| dvec2(x, y))));
        let layer = Layer { number: 1, lines, ..Layer::default() };
        let plot = Plot { layers: vec![layer.clone(), layer], ..Plot::default() };
        for effort in [Effort::None, Effort::Fast, Effort::Best] {
            let options = OptimizeOptions { effort, ..OptimizeOptions::default() };
            let mut shares = Vec::new();
            let watched = optimize_watched(&plot, &options, &mut |share| shares.push(share));
            assert_eq!(watched, optimize(&plot, &options), "watching changes nothing");
            assert_eq!(shares[0], 0.0);
            assert!(shares.is_sorted() && *shares.last().unwrap() <= 1.0, "{shares:?}");
            if effort != Effort::None {
                assert_eq!(*shares.last().unwrap(), 1.0);
                assert!(shares.windows(2).all(|pair| pair[1] - pair[0] < 0.4), "{shares:?}");
            }
        }
    }
}

#[test]
fn strokes_of_drawings_are_not_cut_for_hardly_any_ink() {
    // The second stroke runs along the first for a bit.
    let strokes = |shared: f64| {
        let mut lines = Polylines::default();
        lines.push([dvec2(0.0, 0.0), dvec2(100.0, 0.0)]);
        let (from, to) = (dvec2(40.0, 0.0), dvec2(40.0 + shared, 0.0));
        lines.push([from + dvec2(0.0, 50.0), from, to, to + dvec2(0.0, 50.0)]);
        lines
    };
    let options = OptimizeOptions { effort: Effort::None, ..OptimizeOptions::for_drawings() };
    let n = |shared: f64, options: &OptimizeOptions| {
        optimize_lines(&strokes(shared), None, options).lines.len()
    };
    assert_eq!(n(1.0, &options), 2);
    assert_eq!(n(1.0, &OptimizeOptions { keeps_fewer: false, ..options }), 3);
    assert_eq!(n(5.0, &options), 3);
}

#[test]
fn zeros_of_either_sign_are_one_joint() {
    let lines = polylines(&[
        vec![dvec2(-1.0, 0.0), dvec2(-0.0, 0.0)],
        vec![dvec2(0.0, -0.0), dvec2(1.0, 1.0)],
    ]);
    assert_eq!(optimize_lines(&lines, None, &exact(Effort::Fast)).lines.len(), 1);
}

#[test]
fn ends_join_within_the_tolerance() {
    let lines = polylines(&[
        vec![dvec2(0.0, 0.0), dvec2(10.0, 0.0)],
        vec![dvec2(10.4, 0.0), dvec2(20.0, 0.0)],
    ]);
    for (tolerance, n) in [(0.39, 2), (0.41, 1)] {
        let options = OptimizeOptions::default().join_tolerance_mm(tolerance);
        assert_eq!(optimize_lines(&lines, None, &options).lines.len(), n, "{tolerance}");
    }
}

#[test]
fn strokes_run_on_so_that_they_turn_least_in_all() {
    // Straight on from 0 to 180 degrees would leave a turn of 130 degrees.
    let ray = |degrees: f64| dvec2(degrees.to_radians().cos(), degrees.to_radians().sin());
    let rays = [0.0, 100.0, 150.0, 180.0].map(ray);
    let lines = polylines(&rays.map(|end| vec![DVec2::ZERO, end]));
    let joined = optimize_lines(&lines, None, &exact(Effort::Fast)).lines;
    let mut ends: Vec<[usize; 2]> = joined
        .iter()
        .map(|line| {
            let of = |p: DVec2| rays.iter().position(|ray| ray.distance(p) < 1e-6).unwrap();
            let [a, b] = [of(line[0]), of(line[line.len() - 1])];
            [a.min(b), a.max(b)]
        })
        .collect();
    ends.sort_unstable();
    assert_eq!(ends, [[0, 2], [1, 3]]);
}
