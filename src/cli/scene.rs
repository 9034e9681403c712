//! From input to a scene and its camera.

use std::error::Error;

use hiddenline::stages::camera::Camera;
use hiddenline::stages::classify::LineSelection;
use hiddenline::stages::model::mesh::Mesh;
use hiddenline::stages::model::scene::Scene;
use hiddenline::stages::strokes::StrokeKind;
use hiddenline::stages::timing::timed;

use super::camera::ViewSource;
use super::paper::Notes;
use super::progress::Progress;
use super::smooth::Smoothing;
use super::stats::Stats;

/// What is drawn: a scene, the camera, and what reading had to report.
pub(super) struct Subject {
    pub(super) scene: Scene,
    pub(super) camera: Camera,
    pub(super) notes: Notes,
}

impl Subject {
    /// Reads a mesh and finds its edges; also where faces cross if `lines` include intersections, and where
    /// bent faces fold and edges are flush if `finds_bends`. Curved parts are refined first.
    pub(super) fn read(
        mesh: impl FnOnce(&Progress) -> Result<(Mesh, Notes), Box<dyn Error>>,
        view: &ViewSource,
        lines: Option<LineSelection>,
        finds_bends: bool,
        smoothing: Option<&Smoothing>,
        progress: &Progress,
        stats: &mut Stats,
    ) -> Result<Self, Box<dyn Error>> {
        progress.stage("reading");
        let (mesh, mut notes) = timed(&mut stats.seconds.read, || mesh(progress))?;
        let camera = view.camera(mesh.bounds().unwrap_or_default())?;
        let mesh = match smoothing {
            Some(smoothing) => {
                progress.stage("smoothing");
                timed(&mut stats.seconds.topology, || smoothing.refine(mesh, &camera, &mut notes))?
            }
            None => mesh,
        };
        progress.stage("finding edges");
        let needs = Needs::new(lines, finds_bends);
        let scene = timed(&mut stats.seconds.topology, || needs.scene(mesh, progress));
        Ok(Self { scene, camera, notes })
    }
}

/// What a scene must know for its lines to be drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Needs {
    finds_bends: bool,
    crosses: bool,
}

impl Needs {
    pub(super) fn new(lines: Option<LineSelection>, finds_bends: bool) -> Self {
        let crosses = lines.is_some_and(|lines| lines.contains(StrokeKind::Intersection));
        Self { finds_bends, crosses }
    }

    pub(super) fn scene(self, mesh: Mesh, progress: &Progress) -> Scene {
        let steps = 1 + 2 * usize::from(self.finds_bends) + 2 * usize::from(self.crosses);
        let done = |n: usize| progress.share(n as f64 / steps as f64);
        let mut scene = Scene::new(mesh);
        done(1);
        if self.finds_bends {
            scene = scene.with_bends();
            done(2);
            scene = scene.with_flush_edges();
            done(3);
        }
        if self.crosses {
            progress.stage("finding intersections");
            scene = scene.with_intersections();
        }
        scene
    }
}
