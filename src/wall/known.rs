//! The list of the motions that can be written to files. A new motion is entered here, and exported in
//! `wall.rs`.

#[cfg(feature = "serde")]
use serde::{Deserialize, Deserializer, Serialize, Serializer, de, ser};

#[cfg(feature = "serde")]
use super::Stroke;
use super::{
    AccelerationBounds, BiParabolic, Combined, Fixed, Motion, Sawtooth, Sinusoidal, Tabulated, Triangular,
    WallMotion, WallState,
};
use crate::Fingerprint;

/// Any motion of this crate, as a value that files can hold.
///
/// It represents motions of different types as one type. With the feature `serde`, it is written as the name
/// of the motion in `snake_case` with its numbers. Copies share the motion.
///
/// ```
/// use granular_edmd::wall::{BiParabolic, KnownMotion, Sinusoidal, WallMotion};
/// let bases: [KnownMotion; 2] = [BiParabolic::new(0.1, 10.0)?.into(), Sinusoidal::new(0.1, 10.0)?.into()];
/// assert_eq!(bases[0].period(), bases[1].period());
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct KnownMotion(Motion);

impl WallMotion for KnownMotion {
    fn state(&self, phase: f64) -> WallState {
        self.0.state(phase)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        self.0.acceleration(phase)
    }

    fn reach(&self) -> (f64, f64) {
        self.0.reach()
    }

    fn period(&self) -> Option<f64> {
        self.0.period()
    }

    fn jumps(&self) -> bool {
        self.0.jumps()
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        self.0.fingerprint()
    }
}

impl Motion {
    /// Returns the motion that a [`KnownMotion`] holds, or this one.
    pub(super) fn held(&self) -> &Self {
        self.as_any().downcast_ref().map_or(self, |KnownMotion(motion)| motion)
    }
}

#[cfg(feature = "serde")]
impl Serialize for Motion {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let own = "only the wall motions of granular-edmd can be serialized";
        Known::of(self.held()).ok_or_else(|| ser::Error::custom(own))?.serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl<'de> Deserialize<'de> for Motion {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let motion = motion_or_piston(deserializer)?;
        // Inside another motion, or in a part, a piston would not react.
        let reacts = motion.stroke().is_some();
        if reacts { Err(de::Error::custom("only a wall of a container can be a piston")) } else { Ok(motion) }
    }
}

/// Reads a motion, which may be a piston's.
#[cfg(feature = "serde")]
pub(crate) fn motion_or_piston<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Motion, D::Error> {
    Known::deserialize(deserializer)?.motion().map_err(de::Error::custom)
}

/// Defines the list of motions that files can hold.
macro_rules! known {
    ($($motion:ident),*) => {
        #[cfg(feature = "serde")]
        #[derive(Serialize, Deserialize)]
        #[serde(rename_all = "snake_case", rename = "Motion")]
        enum Known {
            Fixed,
            Stroke(Stroke),
            $($motion($motion),)*
        }

        #[cfg(feature = "serde")]
        impl Known {
            fn of(motion: &Motion) -> Option<Self> {
                let any = motion.as_any();
                any.is::<Fixed>().then_some(Self::Fixed)
                    .or_else(|| motion.stroke().cloned().map(Self::Stroke))
                    $(.or_else(|| any.downcast_ref::<$motion>().cloned().map(Self::$motion)))*
            }

            fn motion(self) -> Result<Motion, crate::Violation> {
                match self {
                    Self::Fixed => Ok(Motion::none()),
                    Self::Stroke(stroke) => Motion::new(stroke),
                    $(Self::$motion(motion) => Motion::new(motion),)*
                }
            }
        }

        $(impl From<$motion> for KnownMotion {
            fn from(motion: $motion) -> Self {
                Self(Motion::of(motion))
            }
        })*
    };
}

known!(BiParabolic, Sinusoidal, Triangular, Sawtooth, Tabulated, Combined);

impl From<Fixed> for KnownMotion {
    fn from(fixed: Fixed) -> Self {
        Self(Motion::of(fixed))
    }
}
