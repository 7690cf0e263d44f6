//! The names of the states.

use std::fmt;

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
