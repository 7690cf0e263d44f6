//! The motions that can be written to files: one list. A new motion is entered here and nowhere else.

use std::any::Any;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::{BiParabolic, Fixed, Sawtooth, Sinusoidal, StartingAt, Triangular, WallMotion, check_finite};

type Shared = Arc<dyn WallMotion + Send + Sync>;

/// A motion as it stands in a file.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Motion")]
pub(super) struct Record {
    motion: Known,
    /// Time from which the phase counts.
    #[serde(default)]
    start: f64,
    #[serde(default)]
    is_mirrored: bool,
}

impl Record {
    /// The record of a wall at rest, which has no numbers.
    pub(super) const FIXED: Self = Self { motion: Known::Fixed, start: 0.0, is_mirrored: false };

    pub(super) fn of(motion: &dyn Any) -> Option<Self> {
        let (motion, start) = Known::of(motion)?;
        Some(Self { motion, start, is_mirrored: false })
    }

    pub(super) fn mirrored(self) -> Self {
        Self { is_mirrored: !self.is_mirrored, ..self }
    }

    pub(super) const fn is_mirrored(&self) -> bool {
        self.is_mirrored
    }

    /// Returns the motion, not mirrored yet, or the reason why the record is none.
    pub(super) fn motion(&self) -> Result<Shared, String> {
        self.motion.starting_at(self.start)
    }
}

/// Lists the motions with numbers. Each is recognized alone, and within [`StartingAt`].
macro_rules! known {
    ($($motion:ident),*) => {
        #[derive(Debug, Clone, Copy, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case", rename = "KnownMotion")]
        enum Known {
            Fixed,
            $($motion($motion),)*
        }

        impl Known {
            /// Recognizes a motion, and returns it with the time from which its phase counts.
            fn of(motion: &dyn Any) -> Option<(Self, f64)> {
                $(
                    if let Some(known) = motion.downcast_ref::<$motion>() {
                        return Some((Self::$motion(*known), 0.0));
                    }
                    if let Some(late) = motion.downcast_ref::<StartingAt<$motion>>() {
                        return Some((Self::$motion(*late.motion()), late.start()));
                    }
                )*
                let late = motion.downcast_ref().map(StartingAt::<Fixed>::start);
                let start = late.or_else(|| motion.is::<Fixed>().then_some(0.0))?;
                Some((Self::Fixed, start))
            }

            fn starting_at(self, start: f64) -> Result<Shared, String> {
                match self {
                    Self::Fixed => starting_at(Fixed, start),
                    $(Self::$motion(motion) => starting_at(motion, start),)*
                }
            }
        }
    };
}

known!(BiParabolic, Sinusoidal, Triangular, Sawtooth);

/// Builds a motion from the data of a file, or returns the reason why it cannot.
fn starting_at<M: WallMotion + Send + Sync + 'static>(motion: M, start: f64) -> Result<Shared, String> {
    if start == 0.0 {
        return checked(motion);
    }
    checked(StartingAt::new(motion, start).map_err(|error| error.to_string())?)
}

fn checked<M: WallMotion + Send + Sync + 'static>(motion: M) -> Result<Shared, String> {
    check_finite(&motion).map_err(|violation| violation.to_string())?;
    Ok(Arc::new(motion))
}
