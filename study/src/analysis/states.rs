//! The names of states, and their changes along a ramp.

use std::fmt;

use granular_edmd::ParameterError;
use granular_edmd::quantity::finite;

/// The motion of the disks in one cluster of the plane of Ψ₁ and Ψ₂ (paper, section III).
///
/// ```
/// use granular_edmd_study::analysis::ConvectiveState;
/// assert_eq!(ConvectiveState::ClockwiseRoll.rolls(), Some(1));
/// assert_eq!(ConvectiveState::Collapsed.to_string(), "collapsed");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub enum ConvectiveState {
    /// A state without flow, in which heat is conducted.
    #[serde(alias = "Conductive")]
    NoRoll,
    /// A single roll that rises on the left: Ψ₁ > 0.
    ClockwiseRoll,
    /// A single roll that rises on the right: Ψ₁ < 0.
    CounterclockwiseRoll,
    /// Two rolls that rise in the middle: Ψ₂ > 0.
    TwoRollsUp,
    /// Two rolls that sink in the middle: Ψ₂ < 0.
    TwoRollsDown,
    /// A compact layer of disks that floats on a gas.
    Collapsed,
}

impl ConvectiveState {
    /// Returns the number of rolls, or `None` for the collapsed state.
    pub const fn rolls(self) -> Option<usize> {
        match self {
            Self::NoRoll => Some(0),
            Self::ClockwiseRoll | Self::CounterclockwiseRoll => Some(1),
            Self::TwoRollsUp | Self::TwoRollsDown => Some(2),
            Self::Collapsed => None,
        }
    }
}

impl fmt::Display for ConvectiveState {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::NoRoll => "no roll",
            Self::ClockwiseRoll => "one roll, clockwise",
            Self::CounterclockwiseRoll => "one roll, counterclockwise",
            Self::TwoRollsUp => "two rolls, up in the middle",
            Self::TwoRollsDown => "two rolls, down in the middle",
            Self::Collapsed => "collapsed",
        })
    }
}

/// The regions of the paper's Fig. 5, in the order of growing energy loss.
///
/// ```
/// use granular_edmd_study::analysis::ConvectiveRegime;
/// assert!(ConvectiveRegime::OneRoll < ConvectiveRegime::Coexistence);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub enum ConvectiveRegime {
    /// Region "0": no rolls.
    #[serde(alias = "Conductive")]
    NoRoll,
    /// Region "1": one roll of either sense.
    OneRoll,
    /// The region between the lines 1–2 (a) and (b), where one roll and two rolls alternate.
    Coexistence,
    /// Region "2": two rolls.
    TwoRolls,
    /// Region "Collapse".
    Collapsed,
}

impl ConvectiveRegime {
    /// All regimes, in the order of growing energy loss.
    pub const ALL: &'static [Self] =
        &[Self::NoRoll, Self::OneRoll, Self::Coexistence, Self::TwoRolls, Self::Collapsed];
}

impl fmt::Display for ConvectiveRegime {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::NoRoll => "no roll",
            Self::OneRoll => "one roll",
            Self::Coexistence => "coexistence of one roll and two",
            Self::TwoRolls => "two rolls",
            Self::Collapsed => "collapsed",
        })
    }
}

/// The lines of the paper's Fig. 5 and the rows of its Table I.
///
/// ```
/// use granular_edmd_study::analysis::TransitionLine;
/// assert_eq!(TransitionLine::ALL.map(|line| line.to_string()), ["0-1", "1-2(a)", "1-2(b)", "2-collapse"]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
pub enum TransitionLine {
    /// Line "0-1": the first roll appears.
    ZeroOne,
    /// Line "1-2(a)": the coexistence of one roll and two rolls begins.
    OneTwoBeginning,
    /// Line "1-2(b)": the coexistence ends.
    OneTwoEnd,
    /// Line "2-collapse".
    TwoCollapse,
}

impl TransitionLine {
    /// All lines, in the order of growing energy loss.
    pub const ALL: [Self; 4] = [Self::ZeroOne, Self::OneTwoBeginning, Self::OneTwoEnd, Self::TwoCollapse];

    /// Returns the first regime beyond the line.
    const fn beyond(self) -> ConvectiveRegime {
        match self {
            Self::ZeroOne => ConvectiveRegime::OneRoll,
            Self::OneTwoBeginning => ConvectiveRegime::Coexistence,
            Self::OneTwoEnd => ConvectiveRegime::TwoRolls,
            Self::TwoCollapse => ConvectiveRegime::Collapsed,
        }
    }

    /// Returns whether a control value, at which the given regimes were seen, lies beyond the line. If the
    /// regimes lie on both sides, the value is beyond line 1–2 (a) and before line 1–2 (b); for the other
    /// lines the result is `None`.
    fn side(self, seen: Seen) -> Option<bool> {
        let (least, most) = (seen.least >= self.beyond(), seen.most >= self.beyond());
        match self {
            Self::OneTwoBeginning => Some(most),
            Self::OneTwoEnd => Some(least),
            Self::ZeroOne | Self::TwoCollapse => (least == most).then_some(least),
        }
    }
}

impl fmt::Display for TransitionLine {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::ZeroOne => "0-1",
            Self::OneTwoBeginning => "1-2(a)",
            Self::OneTwoEnd => "1-2(b)",
            Self::TwoCollapse => "2-collapse",
        })
    }
}

/// A point of a transition line; made by [`transitions`].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Transition {
    /// The transition line to which the point belongs.
    pub line: TransitionLine,
    /// Midpoint of the neighboring control values on the two sides of the line.
    pub value: f64,
    /// Half the difference of these control values. The transition lies between `value - error` and
    /// `value + error`.
    pub error: f64,
    /// True if increasing the control value leads to the regime with the larger energy loss. It is false
    /// where the paper finds re-entrance.
    pub rising: bool,
}

/// The regimes seen at one control value.
#[derive(Debug, Clone, Copy)]
struct Seen {
    value: f64,
    least: ConvectiveRegime,
    most: ConvectiveRegime,
}

/// Finds the transitions along one control parameter.
///
/// The observations are the regimes seen at all values of the parameter, in any order: from ramps up, ramps
/// down, and runs with other seeds. The result is in ascending order of the values, and at equal values in
/// the order of the lines.
///
/// There is hysteresis if runs at the same control value end in different regimes. Coexistence begins (a) at
/// the first value where a run shows two rolls, or both numbers of rolls alternately, and ends (b) at the
/// last value where a run shows anything but two rolls. The other two lines have no hysteresis in the paper.
/// If runs disagree about such a line, the transition lies somewhere between the values at which the runs
/// agree, and the error of the transition covers this range. The observations of a single ramp give the
/// transitions of this ramp.
///
/// # Errors
/// If a control value is not finite.
///
/// ```
/// use granular_edmd_study::analysis::ConvectiveRegime::{OneRoll, TwoRolls};
/// use granular_edmd_study::analysis::{TransitionLine, transitions};
/// let up = [(0.050, OneRoll), (0.055, OneRoll), (0.060, OneRoll), (0.065, TwoRolls)];
/// let down = [(0.065, TwoRolls), (0.060, TwoRolls), (0.055, TwoRolls), (0.050, OneRoll)];
/// let found = transitions(up.into_iter().chain(down))?;
/// assert_eq!(found.len(), 2);
/// assert_eq!(found[0].line, TransitionLine::OneTwoBeginning);
/// assert!((found[0].value - 0.0525).abs() < 1e-12 && (found[1].value - 0.0625).abs() < 1e-12);
/// assert!((found[0].error - 0.0025).abs() < 1e-12);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn transitions(
    observations: impl IntoIterator<Item = (f64, ConvectiveRegime)>,
) -> Result<Vec<Transition>, ParameterError> {
    let seen = merge(observations)?;
    let mut found: Vec<Transition> =
        TransitionLine::ALL.into_iter().flat_map(|line| crossings(line, &seen)).collect();
    found.sort_by(|a, b| a.value.total_cmp(&b.value).then(a.line.cmp(&b.line)));
    Ok(found)
}

/// Merges the observations into one entry for each control value, in ascending order.
fn merge(
    observations: impl IntoIterator<Item = (f64, ConvectiveRegime)>,
) -> Result<Vec<Seen>, ParameterError> {
    let check =
        |(value, regime)| Ok(Seen { value: finite("control value", value)?, least: regime, most: regime });
    let mut all = observations.into_iter().map(check).collect::<Result<Vec<_>, ParameterError>>()?;
    all.sort_by(|a, b| a.value.total_cmp(&b.value));
    // Because of hysteresis, runs at one value may end in different regimes. The value's entry keeps the
    // lowest and the highest regime.
    all.dedup_by(|next, kept| {
        let same = next.value == kept.value;
        if same {
            kept.least = kept.least.min(next.least);
            kept.most = kept.most.max(next.most);
        }
        same
    });
    Ok(all)
}

/// Returns the crossings of a line. A crossing lies between neighbors on different sides of the line, among
/// the values whose side is certain.
fn crossings(line: TransitionLine, seen: &[Seen]) -> Vec<Transition> {
    let certain: Vec<(f64, bool)> =
        seen.iter().filter_map(|&seen| Some((seen.value, line.side(seen)?))).collect();
    let across = certain.windows(2).filter(|pair| pair[0].1 != pair[1].1);
    across
        .map(|pair| Transition {
            line,
            // The values are halved before they are added, since the sum of two large values may overflow.
            value: 0.5 * pair[0].0 + 0.5 * pair[1].0,
            error: 0.5 * pair[1].0 - 0.5 * pair[0].0,
            rising: pair[1].1,
        })
        .collect()
}
