//! How organic the creases of a scene are. The measurement is in
//! [`creases`](crate::model::creases).

/// Models with a smaller share of loose creases are constructed.
const CONSTRUCTED: f64 = 0.08;

/// Models with a larger share of loose creases are organic.
const GROWN: f64 = 0.30;

/// How much the creases of a scene are those of an organic model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Looseness {
    /// For each model of the scene, the share of the creases' length that belongs to no closed figure.
    pub(super) shares: Vec<f64>,
    /// The share of the whole scene.
    pub(super) whole: f64,
    /// Edges above the angle that belong to closed figures, in order.
    pub(super) closed: Vec<u32>,
}

impl Looseness {
    /// How organic each model is, from 0 (constructed) to 1.
    pub fn of_models(&self) -> impl Iterator<Item = f64> {
        self.shares.iter().map(|&share| grown(share))
    }

    /// The same for the whole scene.
    pub fn of_scene(&self) -> f64 {
        grown(self.whole)
    }

    /// Whether every model of the scene is constructed.
    pub fn is_constructed(&self) -> bool {
        self.shares.iter().all(|&share| grown(share) == 0.0)
    }

    /// Whether an edge is bent and belongs to a closed figure. O(log edges).
    pub fn is_closed(&self, edge: u32) -> bool {
        self.closed.binary_search(&edge).is_ok()
    }
}

fn grown(share: f64) -> f64 {
    ((share - CONSTRUCTED) / (GROWN - CONSTRUCTED)).clamp(0.0, 1.0)
}
