//! The triangles of sampled surfaces, with their lines and folds.

use glam::DVec2;

use super::axis_scale::AxisScale;
use super::fold_cuts::SheetFolds;
use super::folds::{FoldFunction, FoldView};
use super::formula::Axis;
use super::grid::Holes;
use super::grid_cuts::{CutGrid, GridCuts};
use super::grid_folds::grid_folds;
use super::height_function::HeightFunction;
use super::lined_mesh::{LatticeLines, LinedMesh};
use super::sampled::{SampledSurface, Samples};
use super::sheet_jets::SheetJets;

impl SampledSurface {
    /// Its triangles with these lines, split for level curves at `levels` (see
    /// [`LinedMesh::for_levels`]). Scattered points have no grid lines: they have lines along all edges
    /// if triangles are to have them.
    ///
    /// Where formulas were sampled, triangles are cut along the folds of this view, if it is given.
    pub fn lined(
        &self,
        lines: &LatticeLines,
        levels: &[f64],
        view: Option<&FoldView>,
    ) -> LinedMesh {
        let mut mesh = LinedMesh::for_levels(levels);
        let places = self.places.as_ref();
        let is_traced = !levels.is_empty() && !lines.triangles;
        let formulas = if is_traced { &self.formulas[..] } else { &[] };
        let function = |sheet: usize| {
            let formula = formulas.get(sheet)?;
            Some(HeightFunction::scaled(formula.clone(), self.scales))
        };
        match &self.sheets {
            Samples::Grids(grids) => {
                for (sheet, grid) in grids.iter().enumerate() {
                    mesh.begin_sheet(function(sheet));
                    mesh.push_grid_at(grid, lines, places, &|_, _| false);
                }
            }
            Samples::Trimmed { grids, .. } => {
                for (sheet, grid) in grids.iter().enumerate() {
                    mesh.begin_sheet(function(sheet));
                    mesh.push_trimmed_at(grid, lines, places);
                }
            }
            Samples::Triangles { points, triangles } => {
                mesh.push_triangles(points, triangles, lines.triangles);
            }
            Samples::Lattice { n_columns, points } => {
                mesh.push_lattice_at(*n_columns, points, lines, places, &|_, _| false);
            }
        }
        if let Some(view) = view.filter(|_| !lines.triangles) {
            let folds = self.folds(view, !levels.is_empty());
            if let ([grid], [_]) = (self.grids(), &folds[..])
                && grid.holes() == Holes::None
                && levels.is_empty()
            {
                let cuts = grid_folds(grid, &folds, view);
                mesh.cut_cells(&CutGrid { grid, cuts: &cuts });
            } else if !folds.is_empty() {
                mesh.add_folds(&folds, view);
            }
        }
        if let Some(cut) = &self.cut {
            mesh.cut_off(cut);
        }
        mesh
    }

    /// Whether its folds are known by formulas.
    pub(crate) fn has_fold_functions(&self) -> bool {
        !self.formulas.is_empty() || self.in_space.is_some()
    }

    /// The cells along the folds of this view in smaller triangles, if this is one grid without holes;
    /// otherwise, and where formulas are not known, none. O(samples).
    pub(crate) fn fold_cuts(&self, view: &FoldView) -> GridCuts {
        let folds = self.folds(view, false);
        match (self.grids(), &folds[..]) {
            ([grid], [_]) if grid.holes() == Holes::None => grid_folds(grid, &folds, view),
            _ => GridCuts::NONE,
        }
    }

    /// The functions of the sheets by which they fold; none where they are not known.
    fn folds(&self, view: &FoldView, is_split: bool) -> Vec<SheetFolds> {
        let eye = view.eye();
        if let (Some(formulas), Some(places), false) = (&self.in_space, &self.places, is_split) {
            let data = AxisScale::DATA;
            let of = |k: usize| formulas[k].jets().scaled([data, data, self.scales[k]]);
            let jets = SheetJets::Space([of(0), of(1), of(2)]);
            let [us, vs] = [Axis::First, Axis::Second].map(|axis| places.along(axis));
            let parameters = vs.iter().flat_map(|&v| us.iter().map(move |&u| DVec2::new(u, v)));
            let function = FoldFunction::new(jets, eye);
            let is_turned = (us[0] > us[us.len() - 1]) != (vs[0] > vs[vs.len() - 1]);
            return vec![SheetFolds { function, parameters: parameters.collect(), is_turned }];
        }
        let jets = self.formulas.iter().map(|formula| formula.jets().scaled(self.scales));
        let function = |jets| FoldFunction::new(SheetJets::Height(jets), eye);
        let of_sheet = |jets| SheetFolds {
            function: function(jets),
            parameters: Vec::new(),
            is_turned: false,
        };
        jets.map(of_sheet).collect()
    }
}
