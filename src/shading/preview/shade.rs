//! The color of a triangle at a pixel.
//!
//! The tone is that of [`crate::shading::light`]. The normal is flat, that of the triangle, or smooth: the
//! mean of the normals around each corner, interpolated over the triangle (Phong 1975).

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::shadow::ShadowGrid;
use super::{PreviewOptions, Show};
use crate::camera::{Camera, Frame, Projection};
use crate::engines::image::{NOTHING, PixelMap, Raster};
use crate::model::scene::Scene;
use crate::shading::light::{AMBIENT, FARTHEST, Light, LightError, number_color, parts};
use crate::shading::normals::{area_vector, corners, smooth_normals};

pub(super) struct Shader<'a> {
    scene: &'a Scene,
    raster: &'a Raster,
    camera: Camera,
    frame: Frame,
    map: PixelMap,
    show: Show,
    light: Light,
    /// Where the light does not reach; `None` where shadows are not shown.
    shadows: Option<ShadowGrid<'a>>,
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
    ) -> Result<Self, LightError> {
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
        let light = Light::new(options.light, camera);
        let shadows = match scene.mesh().bounds() {
            Some(bounds) if options.show == Show::Tone => {
                Some(ShadowGrid::new(scene, light.camera(bounds)?))
            }
            _ => None,
        };
        Ok(Self {
            scene,
            raster,
            camera: *camera,
            frame,
            map: *map,
            show: options.show,
            light,
            shadows,
            color: parts(options.color),
            background: parts(options.background.unwrap_or(options.show.background())),
            normals,
            distances,
        })
    }

    /// The color where no face is seen.
    pub(super) fn background(&self) -> DVec3 {
        self.background
    }

    /// Whether all of a triangle has one color.
    pub(super) fn is_even(&self) -> bool {
        let is_lamp = matches!(self.light, Light::Lamp(_));
        self.normals.is_empty() && !is_lamp && self.shadows.is_none() && self.show != Show::Depth
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
        let normal = self.normal(triangle, pixel);
        let at = self.place(triangle, pixel);
        match &self.shadows {
            Some(shadows) if normal.dot(self.light.towards(at)) > 0.0 => {
                if shadows.hides(at, triangle) { AMBIENT } else { self.light.tone(normal, at) }
            }
            _ => self.light.tone(normal, at),
        }
    }

    /// Where the sight line through a point of the picture meets a triangle's plane.
    fn place(&self, triangle: u32, pixel: DVec2) -> DVec3 {
        let corners = corners(self.scene, triangle);
        let flat = area_vector(corners);
        let (from, along) = self.ray(pixel);
        from + along * (flat.dot(corners[0] - from) / flat.dot(along))
    }

    /// The unit normal used for shading, on the side of the viewer.
    fn normal(&self, triangle: u32, pixel: DVec2) -> DVec3 {
        let corners = corners(self.scene, triangle);
        let flat = area_vector(corners);
        let from = self.camera.eye();
        let ray = self.ray(pixel);
        let is_back = match self.camera.projection() {
            Projection::Perspective { .. } => flat.dot(corners[0] - from) > 0.0,
            Projection::Orthographic => flat.dot(ray.1) > 0.0,
        };
        let normal = match self.normals.get(triangle as usize) {
            Some(normals) => {
                let x = self.place(triangle, pixel);
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
