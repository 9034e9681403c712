//! Axes with ticks, numbers and titles around a surface.
//!
//! ```text
//!      ╱▔▔▔╲            Each axis runs along an edge of the bounding box between a front face and
//!  2 ─┤     ╲           a back face, that is, along the outline of the box. Nothing in the box can
//!     │      ▏          hide such an edge or anything drawn outside it. Lines on the faces behind
//!  0 ─╲     ╱           the surface are wires: it may hide them, and they hide nothing.
//!    ┼ ╲┼┼┼╱
//! ```

mod axis;
mod bounding_box;
mod font;
mod glyphs;
mod layout;
mod legend;
mod letters;
mod options;
mod script;
mod text_block;
mod ticks;
mod walls;

pub use self::font::{missing, text};
pub use self::layout::{AxesBox, AxesLayout, AxesSize, Economy, base_height, is_straight_down};
pub use self::legend::{LegendEntry, LegendPlace, legend};
pub use self::options::{Axes, AxesStyle, BoxFront, Titles, ZAxis};
pub use self::ticks::TickRule;
pub use self::walls::Wire;

#[cfg(test)]
mod tests;
