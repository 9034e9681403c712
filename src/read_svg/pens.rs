//! Pens: what each draws, and which number it has.

use std::collections::BTreeSet;

use crate::plot::{Layer, Pen, Polylines};

/// What one pen draws, before it has a number.
pub(super) struct PenLines {
    pub(super) label: String,
    pub(super) pen: Pen,
    pub(super) lines: Polylines,
}

/// Gives each pen the number its label begins with, or the next one that is free.
pub(super) fn numbered(pens: Vec<PenLines>) -> Vec<Layer> {
    let own_number = |label: &str| {
        let digits: String = label
            .trim_start_matches(['%', '!', ' '])
            .chars()
            .take_while(char::is_ascii_digit)
            .collect();
        digits.parse::<u32>().ok().filter(|&number| number > 0)
    };
    let mut taken: BTreeSet<u32> = BTreeSet::new();
    let numbers: Vec<Option<u32>> = pens
        .iter()
        .map(|pen| own_number(&pen.label).filter(|&number| taken.insert(number)))
        .collect();
    let mut next = 1;
    let mut layers = Vec::new();
    for (pen, number) in pens.into_iter().zip(numbers) {
        let number = number.unwrap_or_else(|| {
            while !taken.insert(next) {
                next += 1;
            }
            next
        });
        let named = own_number(&pen.label).is_some();
        let start: &[char] = &['%', '!', ' ', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9'];
        let label = if named { pen.label.trim_start_matches(start) } else { &pen.label };
        let word = |c: char| if c.is_alphanumeric() || c == '_' || c == '-' { c } else { '-' };
        let name: String = label.trim().chars().map(word).collect();
        let name = if name.is_empty() { "lines".to_owned() } else { name };
        layers.push(Layer { number, name, pen: pen.pen, lines: pen.lines, ..Layer::default() });
    }
    layers
}
