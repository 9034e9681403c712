//! Layers split after a given drawing distance: to dip a brush again, or to sharpen a pencil.

use glam::DVec2;

use crate::plot::{Layer, Plot, Polylines};

/// Splits every layer so that no part draws more than `distance_mm`.
///
/// Without an overlap only whole strokes are moved to the next part, and a stroke longer than the
/// distance is a separate part. With one, strokes are cut where the distance is drawn, and the next
/// part begins `overlap_mm` before the cut, so that no gap shows; an overlap is at most half of the
/// distance.
///
/// Layers are numbered from 1 in drawing order, and the parts of one that was split are named
/// `visible-part-1`, `visible-part-2` and so on. A distance that is not positive splits nothing.
/// O(points + parts).
pub fn split_by_distance(plot: &Plot, distance_mm: f64, overlap_mm: Option<f64>) -> Plot {
    if distance_mm.is_nan() || distance_mm <= 0.0 {
        return plot.clone();
    }
    let mut layers: Vec<Layer> = Vec::new();
    for layer in &plot.layers {
        if !layer.is_plotted() {
            layers.push(layer.clone());
            continue;
        }
        let parts = match overlap_mm {
            Some(overlap) => cut(&layer.lines, distance_mm, overlap.clamp(0.0, distance_mm / 2.0)),
            None => whole_strokes(&layer.lines, distance_mm),
        };
        let n_parts = parts.len();
        for (i, lines) in parts.into_iter().enumerate() {
            let (name, label) = match n_parts {
                1 => (layer.name.clone(), layer.label.clone()),
                _ => (format!("{}-part-{}", layer.name, i + 1), None),
            };
            let fills = if i == 0 { layer.fills.clone() } else { Default::default() };
            layers.push(Layer { name, label, fills, ..layer.with_lines(lines) });
        }
    }
    // Only a split changes the numbers, so that whole drawings keep the pens they were given.
    if layers.len() != plot.layers.len() {
        for (layer, number) in layers.iter_mut().zip(1..) {
            layer.number = number;
        }
    }
    plot.with_layers(layers)
}

fn whole_strokes(lines: &Polylines, distance_mm: f64) -> Vec<Polylines> {
    let mut parts = vec![Polylines::default()];
    let mut drawn = 0.0;
    for line in lines.iter() {
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
    parts
}

fn cut(lines: &Polylines, distance_mm: f64, overlap_mm: f64) -> Vec<Polylines> {
    let mut parts = Vec::new();
    let mut part = Polylines::default();
    let mut drawn = 0.0;
    for line in lines.iter() {
        let mut piece: Vec<DVec2> = line.first().copied().into_iter().collect();
        for pair in line.windows(2) {
            let (mut from, to) = (pair[0], pair[1]);
            while drawn + from.distance(to) > distance_mm {
                let here = from.lerp(to, ((distance_mm - drawn) / from.distance(to)).max(0.0));
                piece.push(here);
                let next = tail(&piece, overlap_mm);
                part.push(piece);
                parts.push(std::mem::take(&mut part));
                drawn = next.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
                (piece, from) = (next, here);
            }
            drawn += from.distance(to);
            piece.push(to);
        }
        part.push(piece);
    }
    if !part.is_empty() || parts.is_empty() {
        parts.push(part);
    }
    parts
}

/// The end of a line that is this long, or all of it.
fn tail(line: &[DVec2], length_mm: f64) -> Vec<DVec2> {
    let mut left = length_mm;
    let mut reversed: Vec<DVec2> = line.last().copied().into_iter().collect();
    for pair in line.windows(2).rev() {
        let (from, to) = (pair[0], pair[1]);
        let length = from.distance(to);
        if length >= left {
            if left > 0.0 {
                reversed.push(to.lerp(from, left / length));
            }
            break;
        }
        left -= length;
        reversed.push(from);
    }
    reversed.reverse();
    reversed
}
