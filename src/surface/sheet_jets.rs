//! The formulas of a sheet as enclosures are found for them.

use super::formula::JetGraph;

/// The formulas of a sheet, ready to be enclosed.
#[derive(Debug, Clone)]
pub enum SheetJets {
    /// z as a function of x and y.
    Height(JetGraph),
    /// x, y and z as functions of u and v.
    Space([JetGraph; 3]),
}
