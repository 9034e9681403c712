//! Layers cut where a pen has drawn far enough: to dip a brush again, or to sharpen a pencil.

use crate::plot::{Layer, Plot, Polylines};

/// Splits every layer so that none draws more than `distance_mm`, whole strokes only: a stroke
/// longer than that is a layer of its own.
///
/// Layers are numbered from 1 in drawing order, and the parts of one that was split are named
/// `visible-part-1`, `visible-part-2` and so on. A distance that is not positive splits nothing.
pub fn split_by_distance(plot: &Plot, distance_mm: f64) -> Plot {
    if distance_mm.is_nan() || distance_mm <= 0.0 {
        return plot.clone();
    }
    let mut layers: Vec<Layer> = Vec::new();
    for layer in &plot.layers {
        let mut parts = vec![Polylines::default()];
        let mut drawn = 0.0;
        for line in layer.lines.iter() {
            let length: f64 = line.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            if drawn > 0.0 && drawn + length > distance_mm {
                parts.push(Polylines::default());
                drawn = 0.0;
            }
            drawn += length;
            if let Some(part) = parts.last_mut() {
                part.push(line.iter().copied());
            }
        }
        let n_parts = parts.len();
        for (i, lines) in parts.into_iter().enumerate() {
            let name = match n_parts {
                1 => layer.name.clone(),
                _ => format!("{}-part-{}", layer.name, i + 1),
            };
            let fills = if i == 0 { layer.fills.clone() } else { Default::default() };
            layers.push(Layer { name, lines, fills, ..layer.clone() });
        }
    }
    // Only a split moves the numbers, so that whole drawings keep the pens they were given.
    let renumber = layers.len() != plot.layers.len();
    for (i, layer) in layers.iter_mut().enumerate() {
        layer.number = if renumber { i as u32 + 1 } else { plot.layers[i].number };
    }
    Plot { layers, ..plot.clone() }
}
