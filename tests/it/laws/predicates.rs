//! Signs of nearly degenerate points with full mantissas, at all scales, against exact integers.

use crate::oracle::exact::{
    Int, Plane as Form, Point, Ratio, common_exponent, cross, decomposed, dot, minus,
    plane_through, scaled, sign, value,
};
use crate::scenes::Rng;
use glam::{DVec3, dvec3};
use hiddenline::stages::camera::{Camera, DEFAULT_NEAR, Projection};
use hiddenline::stages::predicates::{
    Corner, CornerPlace, CutPlane, Estimate, FreePlane, PiercePoint, PlaneName, Planes, Sight,
    Sign, Solid,
};

/// A number from −1 to 1 with all its bits in use.
fn number(rng: &mut Rng) -> f64 {
    2.0 * ((rng.next() >> 11) as f64 / (1u64 << 53) as f64) - 1.0
}

fn point(rng: &mut Rng) -> DVec3 {
    dvec3(number(rng), number(rng), number(rng))
}

/// The points as integers, all by one factor.
fn exact(points: &[DVec3]) -> Vec<Point> {
    let k = common_exponent(points.iter().flat_map(|p| p.to_array()));
    let of = |p: &DVec3| {
        let [x, y, z] = p.to_array().map(|x| scaled(x, k));
        [x, y, z, Int::ONE]
    };
    points.iter().map(of).collect()
}

fn as_number(sign: Sign) -> i32 {
    match sign {
        Sign::Negative => -1,
        Sign::Zero => 0,
        Sign::Positive => 1,
    }
}

/// Where the line through two points meets a plane that they lie on both sides of.
fn crossing(p: &Point, q: &Point, plane: &Form) -> Point {
    let (of_p, of_q) = (value(plane, p), value(plane, q));
    let turn = Int::from(sign(&(&of_p - &of_q)));
    std::array::from_fn(|i| (&q[i] * &of_p - &p[i] * &of_q) * &turn)
}

/// A triangle whose plane passes through a point, or by it within a few roundings.
fn triangle_at(rng: &mut Rng, p: DVec3) -> [DVec3; 3] {
    let (u, v) = (point(rng), point(rng));
    [p + u, p + v, p - u - v]
}

const SCALES: [i32; 3] = [0, 400, -400];

#[test]
fn a_nearly_coplanar_vertex_lies_on_the_side_that_integers_say() {
    let (mut rng, mut n_sides) = (Rng(1), [0; 3]);
    for i in 0..3000 {
        let scale = 2f64.powi(SCALES[i % 3]);
        let [p, q, r] = [0; 3].map(|_| point(&mut rng));
        let x = p + number(&mut rng) * (q - p) + number(&mut rng) * (r - p);
        let positions = [p, q, r, x].map(|p| p * scale);
        let triangles = [[0, 1, 2]];
        let planes = Planes::new(&positions, &triangles);
        let plane = planes.plane(PlaneName::Triangle(0));
        let found = as_number(planes.side(&plane, &planes.vertex(3)).1);
        let [a, b, c, x] = <[Point; 4]>::try_from(exact(&positions)).unwrap();
        assert_eq!(found, -sign(&value(&plane_through(&a, &b, &c), &x)), "{positions:?}");
        n_sides[(found + 1) as usize] += 1;
        let solid = Solid::new(&positions);
        assert_eq!(as_number(solid.side_of([0, 1, 2], 3)), -found, "{positions:?}");
        // Floating point says nothing, or the truth.
        let quick = solid.quick_plane(positions[0], positions[1], positions[2]);
        let certain = solid.certain_side(&quick, positions[3]);
        assert!(certain == 0 || certain == found, "{certain}: {positions:?}");

        let eye = positions[3];
        let near = Projection::Perspective { fov_deg: 40.0, near: DEFAULT_NEAR };
        let camera = Camera::new(eye, eye + scale * dvec3(1.0, 2.0, 0.5), DVec3::Z, near).unwrap();
        let planes = Planes::new(&positions, &triangles).seen_by(&camera);
        assert_eq!(as_number(planes.side_of_eye(PlaneName::Triangle(0))), found, "{positions:?}");
    }
    assert!(n_sides[0] > 500 && n_sides[2] > 500, "{n_sides:?}");
}

#[test]
fn a_plane_seen_nearly_along_itself_faces_as_integers_say() {
    let (mut rng, mut n_sides) = (Rng(10), [0; 3]);
    for i in 0..3000 {
        let scale = 2f64.powi(SCALES[i % 3]);
        let [p, q, r] = [0; 3].map(|_| point(&mut rng));
        let along = number(&mut rng) * (q - p) + number(&mut rng) * (r - p);
        let (eye, target) = (p * scale, (p + along) * scale);
        let camera = Camera::new(eye, target, DVec3::Z, Projection::Orthographic).unwrap();
        let positions = [p, q, r].map(|p| p * scale);
        let planes = Planes::new(&positions, &[[0, 1, 2]]).seen_by(&camera);
        let found = as_number(planes.side_of_eye(PlaneName::Triangle(0)));
        // The eye is as far as can be, against the direction of view.
        let all = [positions.as_slice(), &[camera.forward()]].concat();
        let k = common_exponent(all.iter().flat_map(|p| p.to_array()));
        let [p, q, r, forward] = <[DVec3; 4]>::try_from(all.as_slice())
            .unwrap()
            .map(|p| p.to_array().map(|x| scaled(x, k)));
        let normal = cross(&minus(&q, &p), &minus(&r, &p));
        assert_eq!(found, -sign(&dot(&normal, &forward)), "{positions:?}");
        n_sides[(found + 1) as usize] += 1;
    }
    assert!(n_sides[0] > 500 && n_sides[2] > 500, "{n_sides:?}");
}

#[test]
fn a_cut_edge_ends_on_the_side_that_integers_say() {
    let (mut rng, mut n_checked) = (Rng(2), 0);
    for i in 0..3000 {
        let scale = 2f64.powi(SCALES[i % 3]);
        let [p, q] = [0; 2].map(|_| point(&mut rng));
        let middle = p + 0.5 * (1.0 + number(&mut rng)) * (q - p);
        let [mut a, mut b, c] = triangle_at(&mut rng, middle);
        if i % 2 == 0 {
            // At a flat angle the cut is less certain.
            a = middle + 0.7 * (q - p) + 0.01 * point(&mut rng);
            b = middle - 0.7 * (q - p) + 0.01 * point(&mut rng);
        }
        let positions = [p, q, a, b, c].map(|p| p * scale);
        let triangles = [[2, 3, 4], [5, 6, 7]];
        let planes = Planes::new(&positions, &triangles[..1]);
        let name = PlaneName::Triangle(0);
        let ends = [0, 1].map(|v| planes.vertex(v));
        let at = [0, 1].map(|k| planes.side(&planes.plane(name), &ends[k]));
        if at[0].1.times(at[1].1) != Sign::Negative {
            continue;
        }
        let at: [Estimate; 2] = at.map(|(estimate, _)| estimate);
        let place = CornerPlace::OnEdge([0, 1], name);
        let cut: Corner = planes.corner_between([&ends[0], &ends[1]], at, place);
        // As far off as the cut is uncertain.
        let off = if i % 2 == 0 { 1e-14 * number(&mut rng) } else { 0.0 };
        let near = cut.point / scale + off * (q - p);
        let other = triangle_at(&mut rng, near).map(|p| p * scale);
        let positions = [positions.as_slice(), &other].concat();
        let planes = Planes::new(&positions, &triangles);
        let found = planes.side(&planes.plane(PlaneName::Triangle(1)), &cut).1;
        let corners = [5, 6, 7].map(|vertex| planes.vertex(vertex));
        let volume = planes.volume([&corners[0], &corners[1], &corners[2], &cut]);
        assert_eq!(volume, found, "{positions:?}");
        let exact = exact(&positions);
        let form = |[a, b, c]: [usize; 3]| plane_through(&exact[a], &exact[b], &exact[c]);
        let truth = crossing(&exact[0], &exact[1], &form([2, 3, 4]));
        assert_eq!(as_number(found), -sign(&value(&form([5, 6, 7]), &truth)), "{positions:?}");
        n_checked += 1;

        let pierced = [PiercePoint::new(&positions, [0, 1], [2, 3, 4], None)];
        let points = [positions.as_slice(), &[pierced[0].rounded()]].concat();
        let camera = camera(scale * dvec3(9.0, 8.0, 7.0), -scale * DVec3::ONE, DEFAULT_NEAR);
        let sight = Sight::with_pierced(&points, &pierced, &camera);
        // Depth is negative on the side to which the normal points.
        assert_eq!(sight.depth([5, 6, 7], 8), found.flipped(), "{positions:?}");
    }
    assert!(n_checked > 1000, "{n_checked}");
}

/// A fraction `a / b` next to `c / d`, so that `a d − b c` is one; `b` is smaller than `d`.
fn next_fraction(c: i64, d: i64) -> Option<(i64, i64)> {
    let (mut r, mut s) = ((c, d), (1i64, 0i64));
    while r.0 != 0 {
        let quotient = r.1 / r.0;
        r = (r.1 - quotient * r.0, r.0);
        s = (s.1 - quotient * s.0, s.0);
    }
    // The gcd is r.1 and s.1 · c = r.1 modulo d.
    let b = (-s.1).rem_euclid(d);
    let a = (i128::from(b) * i128::from(c) + 1) / i128::from(d);
    (r.1 == 1 && b > 0 && a < i128::from(b)).then_some((a as i64, b))
}

#[test]
fn points_that_differ_by_less_than_two_mantissas_tell_are_in_their_true_order() {
    let (mut rng, mut n_checked) = (Rng(3), 0);
    for _ in 0..2000 {
        let d = (1i64 << 50) + (rng.next() >> 14) as i64;
        let c = 1 + (rng.next() % (d as u64 - 1)) as i64;
        let Some((a, b)) = next_fraction(c, d) else { continue };
        // Lines from below the x axis to above it that meet it at `start` plus a fraction.
        let start = (1i64 << 40) as f64 + rng.integer(0, 1000);
        let line = |part: i64, whole: i64| {
            let low = dvec3(start, -(part as f64), 0.0);
            let high = dvec3(start + 1.0, (whole - part) as f64, 0.0);
            [low, high, low + DVec3::Z]
        };
        // A length that is no power of two, so that quotients are rounded more than once.
        let length = (1i64 << 42) as f64 + 2.0 * rng.integer(0, 1 << 20) + 1.0;
        let axis = [DVec3::ZERO, dvec3(length, 0.0, 0.0)];
        let positions = [&axis[..], &line(a, b), &line(c, d)].concat();
        let points = [[2, 3, 4], [5, 6, 7]]
            .map(|triangle| PiercePoint::new(&positions, [0, 1], triangle, None));
        let exact = exact(&positions);
        let [first, last] = [[2, 3, 4], [5, 6, 7]].map(|[p, q, r]: [usize; 3]| {
            let plane = plane_through(&exact[p], &exact[q], &exact[r]);
            let [x, _, _, w] = crossing(&exact[0], &exact[1], &plane);
            Ratio::new(x, w)
        });
        assert_eq!(points[0].order(&points[1]), first.cmp(&last), "{a}/{b} and {c}/{d}");
        assert_eq!(points[1].order(&points[0]), last.cmp(&first), "{a}/{b} and {c}/{d}");
        n_checked += usize::from(first != last);
    }
    assert!(n_checked > 500, "{n_checked}");
}

fn camera(eye: DVec3, forward: DVec3, near: f64) -> Camera {
    let projection = Projection::Perspective { fov_deg: 40.0, near };
    Camera::new(eye, eye + forward, DVec3::Z, projection).unwrap()
}

#[test]
fn a_face_seen_nearly_edge_on_faces_as_integers_say() {
    let mut rng = Rng(4);
    for i in 0..2000 {
        let scale = 2f64.powi(SCALES[i % 3]);
        let [p, q, r] = [0; 3].map(|_| point(&mut rng));
        let mut in_plane = || p + number(&mut rng) * (q - p) + number(&mut rng) * (r - p);
        let (last, eye) = (in_plane(), in_plane());
        let points = [p, q, r, last, eye].map(|p| p * scale);
        let camera = camera(points[4], scale * dvec3(1.0, 2.0, 0.5), DEFAULT_NEAR);
        let found = Sight::new(&points[..4], &camera).facing(&[0, 1, 2, 3]);
        let [p, q, r, last, eye] = <[Point; 5]>::try_from(exact(&points)).unwrap();
        // Newell's normal is the sum over a fan.
        let sum =
            value(&plane_through(&p, &q, &r), &eye) + value(&plane_through(&p, &r, &last), &eye);
        assert_eq!(as_number(found), -sign(&sum), "{points:?}");
    }
}

#[test]
fn a_vertex_next_to_the_near_plane_is_kept_when_integers_say_so() {
    let (mut rng, mut n_kept) = (Rng(5), 0);
    for i in 0..2000 {
        let scale = 2f64.powi(SCALES[i % 3]);
        let (eye, forward, near) = (point(&mut rng), point(&mut rng), 0.3 + 0.1 * number(&mut rng));
        let camera = camera(eye * scale, forward * scale, near);
        let x = (eye + near * forward + 4.0 * forward.cross(point(&mut rng))) * scale;
        let found = Sight::new(&[x], &camera).near_distance(0).1;
        let forward = camera.forward();
        let k = common_exponent([x, camera.eye(), forward].iter().flat_map(|p| p.to_array()));
        let [x, eye, forward] =
            [x, camera.eye(), forward].map(|p| p.to_array().map(|x| scaled(x, k)));
        let (mantissa, exponent) = decomposed(near);
        let distance = dot(&minus(&x, &eye), &forward) << (-exponent) as usize;
        let truth = sign(&(distance - Int::from(mantissa) * dot(&forward, &forward)));
        assert_eq!(as_number(found), truth, "{i}");
        n_kept += usize::from(truth >= 0);
    }
    assert!(n_kept > 500 && n_kept < 1500, "{n_kept}");
}

#[test]
fn a_segment_nearly_at_the_contact_tolerance_touches_when_integers_say_so() {
    let (mut rng, mut n_touching) = (Rng(6), 0);
    for i in 0..2000 {
        let scale = 2f64.powi(SCALES[i % 3]);
        let [p, q, r] = [0; 3].map(|_| point(&mut rng));
        let distance = 0.1 + 0.05 * number(&mut rng);
        let up = distance * (q - p).cross(r - p).normalize();
        let in_plane = p + number(&mut rng) * (q - p) + number(&mut rng) * (r - p);
        let positions = [p, q, r, in_plane, in_plane + up].map(|p| p * scale);
        let camera = camera(scale * dvec3(9.0, 8.0, 7.0), -scale * DVec3::ONE, DEFAULT_NEAR);
        let distance = distance * scale;
        let found = Sight::new(&positions, &camera).in_contact([0, 1, 2], [3, 4], distance);
        let numbers = positions.iter().flat_map(|p| p.to_array());
        let k = common_exponent(numbers.chain([distance]));
        let [p, q, r, _, x] = positions.map(|p| p.to_array().map(|x| scaled(x, k)));
        let normal = cross(&minus(&q, &p), &minus(&r, &p));
        let (height, distance) = (dot(&normal, &minus(&x, &p)), scaled(distance, k));
        let truth = &height * &height <= &distance * &distance * dot(&normal, &normal);
        assert_eq!(found, truth, "{positions:?}");
        n_touching += usize::from(truth);
    }
    assert!(n_touching > 500 && n_touching < 1500, "{n_touching}");
}

#[test]
fn a_cut_edge_ends_in_the_plane_that_cuts_it() {
    let (mut rng, mut n_checked) = (Rng(7), 0);
    for i in 0..6000 {
        let scale = 2f64.powi(SCALES[i % 3]);
        let [p, q, c] = [0; 3].map(|_| point(&mut rng));
        let middle = p + 0.5 * (1.0 + number(&mut rng)) * (q - p);
        // At a flat angle, so that the cut is as uncertain as it may be.
        let [a, b] = [1.0, -1.0].map(|side| middle + side * (q - p) + 0.003 * point(&mut rng));
        let positions = [p, q, a, b, c].map(|p| p * scale);
        let planes = Planes::new(&positions, &[[2, 3, 4]]);
        let name = PlaneName::Triangle(0);
        let ends = [0, 1].map(|v| planes.vertex(v));
        let at = [0, 1].map(|k| planes.side(&planes.plane(name), &ends[k]));
        if at[0].1.times(at[1].1) != Sign::Negative {
            continue;
        }
        let at = at.map(|(estimate, _)| estimate);
        let place = CornerPlace::OnEdge([0, 1], name);
        let cut = planes.corner_between([&ends[0], &ends[1]], at, place);
        let of_plane = [2, 3, 4].map(|v| planes.vertex(v));
        let mut four = [&of_plane[0], &of_plane[1], &of_plane[2], &cut];
        for _ in 0..4 {
            four.rotate_left(1);
            assert_eq!(planes.volume(four), Sign::Zero, "{positions:?}");
        }
        // With the eye in the plane, everything in it has its image on one line.
        let camera = camera(positions[2], scale * (q - p), DEFAULT_NEAR);
        let planes = planes.seen_by(&camera);
        let mut three = [&of_plane[1], &of_plane[2], &cut];
        for _ in 0..3 {
            three.rotate_left(1);
            assert_eq!(planes.turn(three[0], three[1], three[2]), Sign::Zero, "{positions:?}");
        }
        n_checked += 1;
    }
    assert!(n_checked > 1000, "{n_checked}");
}

#[test]
fn a_cut_between_wide_estimates_is_computed_anew() {
    let height = 1e-12;
    let above = dvec3(0.25, 0.25, height);
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, above, above - 2.0 * height * DVec3::Z];
    let sight = Sight::new(&points, &camera(dvec3(9.0, 8.0, 7.0), -DVec3::ONE, DEFAULT_NEAR));
    // The first end's value is known to lie between nothing and two, the last end's exactly.
    let wide = Estimate { value: 1.0, error: 1.0 };
    let sharp = Estimate { value: -height, error: 0.0 };
    for at in [[wide, sharp], [-wide, -sharp]] {
        let cut = sight.cut([3, 4], CutPlane::Triangle([0, 1, 2]), at);
        assert!((cut.t - 0.5).abs() <= 1e-9, "{cut:?}");
    }
}

#[test]
fn points_on_one_sight_line_have_one_image_even_where_products_vanish() {
    // Both points lie on a line through the eye. Differences are rounded, and at the smallest scale
    // one of two equal products is rounded down, and the other one up.
    let big = 2f64.powi(53);
    let (eye, near, far) = (2.0 - big, dvec3(3.0, 1.0, 0.0), dvec3(5.0 * big + 8.0, 6.0, 0.0));
    for exponent in [0, -400, -564, 400] {
        let scale = 2f64.powi(exponent);
        let points = [near * scale, far * scale];
        let eye = dvec3(eye * scale, 0.0, 0.0);
        let sight = Sight::new(&points, &camera(eye, scale * DVec3::X, DEFAULT_NEAR));
        assert!(sight.same_image(0, 1), "2^{exponent}");
    }
}

#[test]
fn places_where_planes_cut_an_edge_are_in_their_true_order() {
    let (mut rng, mut n_checked) = (Rng(9), 0);
    for _ in 0..3000 {
        let ends = [point(&mut rng), point(&mut rng)];
        let middle = ends[0] + 0.5 * (1.0 + number(&mut rng)) * (ends[1] - ends[0]);
        // Both through one point, but for rounding.
        let planes = [0; 2].map(|_| {
            let normal = point(&mut rng);
            FreePlane { normal, offset: normal.dot(middle) }
        });
        let is_cut =
            |plane: &FreePlane| plane.side(ends[0]).times(plane.side(ends[1])) == Sign::Negative;
        if !planes.iter().all(is_cut) {
            continue;
        }
        let k = common_exponent(ends.iter().flat_map(|p| p.to_array()));
        let whole = |p: DVec3, k: i32| p.to_array().map(|x| scaled(x, k));
        let parts = planes.map(|FreePlane { normal, offset }| {
            let of_normal = common_exponent(normal.to_array());
            let [of_p, of_q] = ends.map(|end| {
                dot(&whole(normal, of_normal), &whole(end, k)) - scaled(offset, of_normal + k)
            });
            Ratio::new(of_p.clone(), of_p - of_q)
        });
        let found = planes.map(|plane| PiercePoint::on_plane(&ends, [0, 1], plane));
        let expected = parts[0].cmp(&parts[1]);
        let is_rising = ends[0].x < ends[1].x;
        let expected = if is_rising { expected } else { expected.reverse() };
        assert_eq!(found[0].order(&found[1]), expected, "{ends:?}, {planes:?}");
        n_checked += 1;
    }
    assert!(n_checked > 1000, "{n_checked}");
}
