//! The list of the motions that can be written to files. A new motion is entered here, and exported in
//! `wall.rs`.

use std::any::Any;

use serde::de::Error as _;
use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{
    BiParabolic, Delayed, Fixed, Motion, Sawtooth, Scaled, Sinusoidal, StartingAt, Stroke, Summed, Tabulated,
    Triangular,
};
use crate::Violation;

impl Serialize for Motion {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let own = "only the wall motions of granular-edmd can be serialized";
        Known::of(self.as_any()).ok_or_else(|| S::Error::custom(own))?.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Motion {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let motion = motion_or_piston(deserializer)?;
        // Inside another motion, or in a part, a piston would not react.
        let reacts = motion.stroke().is_some();
        if reacts { Err(D::Error::custom("only a wall of a container can be a piston")) } else { Ok(motion) }
    }
}

/// Reads a motion, which may be a piston's.
pub(crate) fn motion_or_piston<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Motion, D::Error> {
    Known::deserialize(deserializer)?.motion().map_err(D::Error::custom)
}

/// Defines the list of motions that files can hold.
macro_rules! known {
    ($($motion:ident),*) => {
        #[derive(Serialize, Deserialize)]
        #[serde(rename_all = "snake_case", rename = "Motion")]
        enum Known {
            Fixed,
            $($motion($motion),)*
        }

        impl Known {
            fn of(motion: &dyn Any) -> Option<Self> {
                let fixed = motion.is::<Fixed>().then_some(Self::Fixed);
                fixed$(.or_else(|| motion.downcast_ref::<$motion>().cloned().map(Self::$motion)))*
            }

            fn motion(self) -> Result<Motion, Violation> {
                match self {
                    Self::Fixed => Ok(Motion::none()),
                    $(Self::$motion(motion) => Motion::new(motion),)*
                }
            }
        }
    };
}

known!(Stroke, BiParabolic, Sinusoidal, Triangular, Sawtooth, Tabulated, StartingAt, Delayed, Scaled, Summed);
