//! The motions that can be written to files: one list. A new motion is entered here, and exported in
//! `wall.rs`.

use std::any::Any;

use serde::de::Error as _;
use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{
    BiParabolic, Delayed, Fixed, Motion, Sawtooth, Scaled, Sinusoidal, StartingAt, Summed, Tabulated,
    Triangular, WallMotion,
};

/// A motion as it stands in a file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Motion")]
struct Record {
    motion: Known,
    /// Time from which the phase counts.
    #[serde(default)]
    start: f64,
    #[serde(default)]
    is_mirrored: bool,
}

impl Record {
    fn of(motion: &Motion) -> Option<Self> {
        let mirrored = motion.as_any().downcast_ref().and_then(Scaled::mirrored);
        if let Some(record) = mirrored.and_then(Self::of).filter(|record| !record.is_mirrored) {
            return Some(Self { is_mirrored: true, ..record });
        }
        let (motion, start) = Known::of(motion.as_any())?;
        Some(Self { motion, start, is_mirrored: false })
    }

    /// Returns the motion, or the reason why the record is none.
    fn motion(self) -> Result<Motion, String> {
        let motion = self.motion.starting_at(self.start)?;
        if !self.is_mirrored {
            return Ok(motion);
        }
        checked(Scaled::of(motion, -1.0).map_err(|error| error.to_string())?)
    }
}

impl Serialize for Motion {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let own = "only the wall motions of granular-edmd can be serialized";
        Record::of(self).ok_or_else(|| S::Error::custom(own))?.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Motion {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Record::deserialize(deserializer)?.motion().map_err(D::Error::custom)
    }
}

/// Lists the motions with numbers. Each is recognized alone, and within [`StartingAt`].
macro_rules! known {
    ($($motion:ident),*) => {
        #[derive(Serialize, Deserialize)]
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
                        return Some((Self::$motion(Clone::clone(known)), 0.0));
                    }
                    if let Some(late) = motion.downcast_ref::<StartingAt<$motion>>() {
                        return Some((Self::$motion(Clone::clone(late.motion())), late.start()));
                    }
                )*
                let late = motion.downcast_ref().map(StartingAt::<Fixed>::start);
                let start = late.or_else(|| motion.is::<Fixed>().then_some(0.0))?;
                Some((Self::Fixed, start))
            }

            fn starting_at(self, start: f64) -> Result<Motion, String> {
                match self {
                    Self::Fixed => starting_at(Fixed, start),
                    $(Self::$motion(motion) => starting_at(motion, start),)*
                }
            }
        }
    };
}

known!(BiParabolic, Sinusoidal, Triangular, Sawtooth, Tabulated, Delayed, Scaled, Summed);

/// Builds a motion from the data of a file, or returns the reason why it cannot.
fn starting_at<M: WallMotion + Send + Sync + 'static>(motion: M, start: f64) -> Result<Motion, String> {
    if start == 0.0 {
        return checked(motion);
    }
    checked(StartingAt::new(motion, start).map_err(|error| error.to_string())?)
}

fn checked<M: WallMotion + Send + Sync + 'static>(motion: M) -> Result<Motion, String> {
    Motion::new(motion).map_err(|violation| violation.to_string())
}
