//! The color of a triangle at a pixel.
//!
//! The tone is that of [`crate::shading::light`]. The normal is flat, that of the triangle, or smooth: the
//! mean of the normals around each corner, interpolated over the triangle (Phong 1975).

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::{PreviewOptions, Show};
use crate::camera::{Camera, Frame, Projection};
use crate::engines::image::{NOTHING, PixelMap, Raster};
use crate::model::scene::Scene;
use crate::shading::light::{FARTHEST, Light, number_color, parts};

pub(super) struct Shader<'a> {
    scene: &'a Scene,
    raster: &'a Raster,
    camera: Camera,
    frame: Frame,
    map: PixelMap,
    show: Show,
    light: Light,
    color: DVec3,
    background: DVec3,
    /// For each corner of each triangle; empty for flat shading.
    normals: Vec<[DVec3; 3]>,
    /// Least and greatest distance.
    distances: (f64, f64),
}

impl<'a> Shader<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        camera: &Camera,
        map: &PixelMap,
        raster: &'a Raster,
        options: &PreviewOptions,
    ) -> Self {
        let frame = camera.frame();
        let normals = match options.smooth_deg {
            Some(angle) if matches!(options.show, Show::Shaded | Show::Tone | Show::Normals) => {
                smooth_normals(scene, angle)
            }
            _ => Vec::new(),
        };
        let mut distances = (0.0, 0.0);
        if options.show == Show::Depth {
            let range = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
            let all = (0..raster.len() as u32).into_par_iter().flat_map_iter(|item| {
                let triangle = raster.triangle(item);
                let nearness = triangle.corners.map(|corner| triangle.plane.nearness_at(corner));
                nearness.map(|nearness| raster.distance(nearness))
            });
            distances = all
                .map(|distance| (distance, distance))
                .reduce(|| (f64::INFINITY, f64::NEG_INFINITY), range);
        }
        Self {
            scene,
            raster,
            camera: *camera,
            frame,
            map: *map,
            show: options.show,
            light: Light::new(options.light, camera),
            color: parts(options.color),
            background: parts(options.background.unwrap_or(options.show.background())),
            normals,
            distances,
        }
    }

    /// The color where no face is seen.
    pub(super) fn background(&self) -> DVec3 {
        self.background
    }

    /// Whether all of a triangle has one color.
    pub(super) fn is_even(&self) -> bool {
        self.normals.is_empty() && self.show != Show::Depth
    }

    /// The color of an item at a point of the picture, components from 0 to 1.
    pub(super) fn color(&self, item: u32, pixel: DVec2) -> DVec3 {
        if item == NOTHING {
            return self.background;
        }
        let number = self.raster.number(item);
        match self.show {
            Show::Shaded => self.color * self.tone(number, pixel),
            Show::Tone => DVec3::splat(self.tone(number, pixel)),
            Show::Faces => number_color(self.scene.triangle_faces()[number as usize]),
            Show::Normals => {
                let n = self.normal(number, pixel);
                let Frame { right, upward, forward } = self.frame;
                DVec3::new(n.dot(right), n.dot(upward), -n.dot(forward)) / 2.0 + 0.5
            }
            Show::Depth => {
                let distance =
                    self.raster.distance(self.raster.triangle(item).plane.nearness_at(pixel));
                let (nearest, farthest) = self.distances;
                let part = ((distance - nearest) / (farthest - nearest)).clamp(0.0, 1.0);
                let part = if part.is_nan() { 0.0 } else { part };
                DVec3::splat(1.0 - part * (1.0 - FARTHEST))
            }
        }
    }

    fn tone(&self, triangle: u32, pixel: DVec2) -> f64 {
        self.light.tone(self.normal(triangle, pixel))
    }

    /// The unit normal used for shading, on the side of the viewer.
    fn normal(&self, triangle: u32, pixel: DVec2) -> DVec3 {
        let corners = positions(self.scene, triangle);
        let flat = area_vector(corners);
        let from = self.camera.eye();
        let ray = self.ray(pixel);
        let is_back = match self.camera.projection() {
            Projection::Perspective { .. } => flat.dot(corners[0] - from) > 0.0,
            Projection::Orthographic => flat.dot(ray.1) > 0.0,
        };
        let normal = match self.normals.get(triangle as usize) {
            Some(normals) => {
                // Where the sight line meets the triangle's plane.
                let t = flat.dot(corners[0] - ray.0) / flat.dot(ray.1);
                let x = ray.0 + ray.1 * t;
                let [a, b, c] = corners;
                let parts =
                    [[x, b, c], [a, x, c], [a, b, x]].map(|part| area_vector(part).dot(flat));
                let mixed: DVec3 =
                    normals.iter().zip(parts).map(|(&normal, part)| normal * part.max(0.0)).sum();
                if mixed.is_finite() && mixed != DVec3::ZERO { mixed } else { flat }
            }
            None => flat,
        };
        let normal = normal.normalize_or_zero();
        if is_back { -normal } else { normal }
    }

    /// The sight line through a point of the picture: a point and a direction.
    fn ray(&self, pixel: DVec2) -> (DVec3, DVec3) {
        let image = (pixel - self.map.origin) / self.map.scale;
        let aside = self.frame.right * image.x - self.frame.upward * image.y;
        match self.camera.projection() {
            Projection::Perspective { .. } => (self.camera.eye(), self.frame.forward + aside),
            Projection::Orthographic => (self.camera.eye() + aside, self.frame.forward),
        }
    }
}

fn positions(scene: &Scene, triangle: u32) -> [DVec3; 3] {
    scene.triangles()[triangle as usize].map(|vertex| scene.mesh().positions()[vertex as usize])
}

/// The normal of a triangle; its length is twice the area.
fn area_vector([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// At vertices with more triangles than this, the mean is that of all: the tip of such a fine fan is not a
/// corner, and comparing each pair would take too long.
const MOST_COMPARED: usize = 256;

/// For each corner of each triangle the mean normal, by area, of the triangles at that vertex that
/// meet it at `angle_deg` or less; see [`MOST_COMPARED`]. O(triangles), in parallel.
fn smooth_normals(scene: &Scene, angle_deg: f64) -> Vec<[DVec3; 3]> {
    let triangles = scene.triangles();
    let cosine = libm::cos(angle_deg.clamp(0.0, 180.0).to_radians());
    let flat: Vec<DVec3> = (0..triangles.len() as u32)
        .into_par_iter()
        .map(|triangle| area_vector(positions(scene, triangle)))
        .collect();
    let mut starts = vec![0; scene.mesh().positions().len() + 1];
    for vertex in triangles.iter().flatten() {
        starts[*vertex as usize + 1] += 1;
    }
    for k in 1..starts.len() {
        starts[k] += starts[k - 1];
    }
    let mut next = starts.clone();
    let mut around = vec![0u32; triangles.len() * 3];
    for (number, triangle) in (0..).zip(triangles) {
        for &vertex in triangle {
            around[next[vertex as usize]] = number;
            next[vertex as usize] += 1;
        }
    }
    let range = |vertex: u32| starts[vertex as usize]..starts[vertex as usize + 1];
    let of_all = |vertex: u32| -> DVec3 {
        around[range(vertex)].iter().map(|&triangle| flat[triangle as usize]).sum()
    };
    let is_crowded = |vertex: &u32| range(*vertex).len() > MOST_COMPARED;
    let crowded: FxHashMap<u32, DVec3> = (0..scene.mesh().positions().len() as u32)
        .filter(is_crowded)
        .map(|vertex| (vertex, of_all(vertex).normalize_or_zero()))
        .collect();
    let mean = |own: DVec3, vertex: u32| {
        if let Some(&mean) = crowded.get(&vertex) {
            return mean;
        }
        let range = range(vertex);
        let near = around[range].iter().map(|&other| flat[other as usize]);
        let near = near.filter(|other| own.dot(*other) >= cosine * own.length() * other.length());
        near.sum::<DVec3>().normalize_or_zero()
    };
    triangles
        .par_iter()
        .zip(&flat)
        .map(|(triangle, &own)| triangle.map(|vertex| mean(own, vertex)))
        .collect()
}
