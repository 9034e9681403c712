//! Choices of the library on the command line: one parser for every enum with `ALL` and names.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use hiddenline::stages::axes::{BoxFront, ZAxis};
use hiddenline::stages::camera::framing::{NamedView, ProjectionKind};
use hiddenline::stages::draw::surface::SurfaceEngine;
use hiddenline::stages::engines::edge::LineEngine;
use hiddenline::stages::engines::face::FaceEngine;
use hiddenline::stages::engines::face::warnock::Subdivision;
use hiddenline::stages::engines::surface::CellOrder;
use hiddenline::stages::model::arrange::UpAxis;
use hiddenline::stages::page::Crop;
use hiddenline::stages::read::ModelFormat;
use hiddenline::stages::shading::fill::Coloring;
use hiddenline::stages::shading::preview::Show;
use hiddenline::stages::strokes::HiddenLines;
use hiddenline::stages::surface::{Duplicates, Outside};
use hiddenline::stages::write::Format;
use hiddenline::stages::write::dxf::DxfUnit;
use hiddenline::stages::write::svg::StrokeElement;

/// A value of an enum that the command line names as the library does.
pub(super) trait Choice: Copy + Send + Sync + 'static {
    /// Every value, in the order of the documentation.
    const ALL: &'static [Self];

    /// The name as it is typed.
    fn name(self) -> &'static str;

    /// What `--help` says about it.
    fn help(self) -> &'static str;
}

/// Implements [`Choice`] by the `ALL` and `name` of the types.
macro_rules! choices {
    ($($choice:ident { $($value:ident $help:literal)* })*) => {
        $(impl Choice for $choice {
            const ALL: &'static [Self] = &<$choice>::ALL;

            fn name(self) -> &'static str {
                self.name()
            }

            fn help(self) -> &'static str {
                match self {
                    $(Self::$value => $help,)*
                }
            }
        })*
    };
}

choices! {
    BoxFront {
        Dashed "Dashes of 1 mm with gaps of 1 mm"
        Solid "Solid"
        None "Left out"
    }
    CellOrder {
        Rows "Row by row, away from the eye"
        Diagonals "Diagonal by diagonal, as Cantor counts pairs"
    }
    Coloring {
        Shaded "By the light"
        Order "By paint order: blue first, then green, red last"
        Depth "By distance: nearer is lighter"
        Splits "A color for each fragment"
    }
    Crop {
        Page "At the edges of the page"
        Margin "At the margins"
        None "Nowhere"
    }
    Duplicates {
        Error "None; different heights at one point are an error"
        First "The first one in the file"
        Mean "One point at their mean height"
        Max "The highest one"
    }
    DxfUnit {
        Millimeter "Millimeters"
        Centimeter "Centimeters"
        Meter "Meters"
        Inch "Inches"
    }
    FaceEngine {
        Auto "Chosen by the size of the model"
        DepthSort "Far to near, few splits; for one view of faces that hardly cross"
        Bsp "Far to near, by a tree of planes; for large models, and many views of one"
        Octree "Far to near, by a tree of boxes; for large models of small faces"
        Warnock "Windows of the image, divided until one face fills each; for few, large faces"
        WeilerAtherton "Exact regions side by side, for cutters, engravers, inks; up to 10,000 faces"
    }
    Format {
        Svg "Scalable Vector Graphics, for print and plotters"
        Hpgl "HPGL, for pen plotters"
        Gcode "G-code, for GRBL, Marlin and other machines"
        Pdf "PDF, for print"
        Dxf "DXF, for CAD and CAM programs"
        Png "A picture of the page"
        Json "The strokes in image coordinates, for scripts"
    }
    HiddenLines {
        None "Left out"
        Dashed "Dashed, on their own layer"
        Solid "Solid, on their own layer"
    }
    LineEngine {
        Auto "Chosen by the size of the scene"
        Roberts "Roberts (1963): each edge against the faces near its image"
        Appel "Appel (1967): quantitative invisibility, carried along edges; fast with many edges"
        AllPairs "Each edge against each face"
    }
    ModelFormat {
        Obj "Wavefront OBJ"
        Stl "STL, text or binary"
        Ply "Stanford PLY, text or binary"
        Off "Object File Format"
        Gltf "glTF 2.0, as .gltf or .glb"
        ThreeMf "3D Manufacturing Format"
    }
    NamedView {
        Front "Looking along +y"
        Right "Looking along -x"
        Back "Looking along -y"
        Left "Looking along +x"
        Top "Looking down, +y up on the page"
        Bottom "Looking up, -y up on the page"
        Isometric "From the upper front right, all axes foreshortened alike"
        Dimetric "x and z foreshortened alike, y half as long"
        Trimetric "Azimuth 30, elevation 25: each axis foreshortened differently"
    }
    ProjectionKind {
        Perspective "Lines of sight meet at the eye"
        Orthographic "Lines of sight are parallel"
    }
    Show {
        Shaded "Faces in the light"
        Tone "The tone of each point as gray; the background is white"
        Depth "Nearer is lighter"
        Faces "A color for each face"
        Normals "Red is right, green is up, blue is toward the viewer"
    }
    Outside {
        Cut "Cut the surface off"
        Clamp "Clamp heights to the range, which makes plateaus"
    }
    StrokeElement {
        Path "<path>, one for each stroke"
        Polyline "<polyline>, one for each stroke"
    }
    Subdivision {
        Regular "Into quarters"
        Vertices "At a vertex near the center"
    }
    SurfaceEngine {
        Auto "Max-min where it applies, otherwise roberts or appel"
        MaxMin "One surface z = f(x, y) without holes, or two that meet at their border"
        FloatingHorizon "One family of lines, hidden by its own nearer lines"
        Roberts "Any surface; few lines"
        Appel "Any surface; many lines"
    }
    UpAxis {
        Y "+y points up"
        Z "+z points up"
        NegativeY "-y points up"
        NegativeZ "-z points up"
    }
    ZAxis {
        Left "Left of the surface"
        Right "Right of the surface"
    }
}

/// Takes the names of all values; help describes them, and messages suggest them.
pub(super) fn one_of<T: Choice>() -> impl TypedValueParser<Value = T> {
    one_of_these(T::ALL)
}

/// Takes the names of some values.
pub(super) fn one_of_these<T: Choice>(choices: &'static [T]) -> impl TypedValueParser<Value = T> {
    let values = choices.iter().map(|choice| {
        let value = PossibleValue::new(choice.name()).help(choice.help());
        match alias(choice.name()) {
            Some(alias) => value.alias(alias),
            None => value,
        }
    });
    PossibleValuesParser::new(values).try_map(|name| {
        let is_named = |choice: &&T| {
            choice.name() == name || alias(choice.name()).is_some_and(|alias| alias == name)
        };
        choices.iter().find(is_named).copied().ok_or("unknown name")
    })
}

/// What a name may be typed as, too: the two extensions of glTF are one format.
fn alias(name: &str) -> Option<&'static str> {
    (name == "gltf").then_some("glb")
}

#[cfg(test)]
mod tests {
    use std::ffi::OsStr;
    use std::fmt::Debug;

    use clap::Command;

    use super::*;

    /// Each name stands for its value and for no other, and help says something about each.
    fn is_named<T: Choice + PartialEq + Debug>() {
        let parse = |name: &str| {
            one_of::<T>().parse_ref(&Command::new("draw"), None, OsStr::new(name)).ok()
        };
        for &choice in T::ALL {
            assert_eq!(parse(choice.name()), Some(choice));
            assert!(!choice.help().is_empty() && !choice.help().ends_with('.'), "{choice:?}");
        }
        assert_eq!(parse("nothing of the kind"), None);
    }

    #[test]
    fn every_choice_is_parsed_by_its_name() {
        is_named::<BoxFront>();
        is_named::<CellOrder>();
        is_named::<Coloring>();
        is_named::<Crop>();
        is_named::<Duplicates>();
        is_named::<DxfUnit>();
        is_named::<FaceEngine>();
        is_named::<Format>();
        is_named::<HiddenLines>();
        is_named::<LineEngine>();
        is_named::<ModelFormat>();
        is_named::<NamedView>();
        is_named::<ProjectionKind>();
        is_named::<Show>();
        is_named::<StrokeElement>();
        is_named::<Subdivision>();
        is_named::<SurfaceEngine>();
        is_named::<UpAxis>();
        is_named::<ZAxis>();
    }

    #[test]
    fn the_two_extensions_of_gltf_are_one_format() {
        let parse = one_of::<ModelFormat>();
        let glb = parse.parse_ref(&Command::new("draw"), None, OsStr::new("glb"));
        assert_eq!(glb.ok(), Some(ModelFormat::Gltf));
    }
}
