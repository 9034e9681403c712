//! Function surfaces: engines against brute force and closed forms.

mod axes;
mod base_levels;
mod brute;
mod damage;
mod drawing;
mod floating_horizon;
mod folds;
mod grid_folds;
mod height_files;
mod height_range;
mod heights;
mod labels;
mod legend;
mod level_lengths;
mod margins;
mod max_min;
mod meshed;
mod pen_path;
mod points;
mod rims;
mod scales;
mod tears;
mod tin;
mod walls;
