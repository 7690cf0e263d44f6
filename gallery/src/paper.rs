//! Numbers of the paper.

use granular_edmd_study::analysis::TransitionLine;
use granular_edmd_study::analysis::TransitionLine::{OneTwoBeginning, OneTwoEnd, TwoCollapse, ZeroOne};

/// A row of the paper's Table I, as printed.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    pub gravity: f64,
    pub line: TransitionLine,
    /// Mean energy change per collision, and its standard deviation along the line.
    pub change: (f64, f64),
    /// Effective inelasticity, and its error.
    pub effective: (f64, f64),
}

const fn row(gravity: f64, line: TransitionLine, change: (f64, f64), effective: (f64, f64)) -> Row {
    Row { gravity, line, change, effective }
}

/// The paper's Table I.
pub const TABLE_1: [Row; 8] = [
    row(0.002_025, ZeroOne, (-0.090, 0.017), (0.023, 0.004)),
    row(0.002_025, OneTwoBeginning, (-0.351, 0.042), (0.097, 0.013)),
    row(0.002_025, OneTwoEnd, (-0.377, 0.046), (0.105, 0.014)),
    row(0.002_025, TwoCollapse, (-0.614, 0.036), (0.190, 0.014)),
    row(0.015_625, ZeroOne, (-0.047, 0.009), (0.012, 0.002)),
    row(0.015_625, OneTwoBeginning, (-0.137, 0.022), (0.035, 0.006)),
    row(0.015_625, OneTwoEnd, (-0.147, 0.025), (0.038, 0.007)),
    row(0.015_625, TwoCollapse, (-0.290, 0.037), (0.079, 0.011)),
];
