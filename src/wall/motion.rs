//! A motion in owned form, which walls share.

use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use super::laws::{Violation, check_finite};
use super::{Fixed, WallMotion};

/// A motion of any type.
///
/// A motion of the crate is known as such, and goes to files and back. A motion of your own cannot.
#[derive(Clone)]
pub(crate) struct Motion {
    motion: Arc<dyn WallMotion + Send + Sync>,
    #[cfg(feature = "serde")]
    known: Option<file::Known>,
}

impl Motion {
    /// Takes a motion, if it answers with finite numbers.
    pub(crate) fn new<M: WallMotion + Send + Sync + 'static>(motion: M) -> Result<Self, Violation> {
        check_finite(&motion)?;
        #[cfg(feature = "serde")]
        let known = file::Known::of(&motion);
        Ok(Self {
            motion: Arc::new(motion),
            #[cfg(feature = "serde")]
            known,
        })
    }

    /// Returns the motion of a wall that stays at its place.
    pub(crate) fn none() -> Self {
        Self {
            motion: Arc::new(Fixed),
            #[cfg(feature = "serde")]
            known: Some(file::Known::Fixed),
        }
    }

    /// Returns the phase at a time origin: the origin less whole periods.
    pub(crate) fn phase(&self, origin: f64) -> f64 {
        let (low, high) = self.reach();
        match self.period() {
            // A wall that never leaves its place is the same at all times. Phase 0 costs the times none of
            // their digits.
            _ if low == high => 0.0,
            // The remainder of two floats is exact, so the phase keeps all its digits however late the time
            // is.
            Some(period) => origin % period,
            None => origin,
        }
    }
}

impl Deref for Motion {
    type Target = dyn WallMotion + Send + Sync;

    #[inline]
    fn deref(&self) -> &Self::Target {
        &*self.motion
    }
}

impl fmt::Debug for Motion {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Motion").field("reach", &self.reach()).finish_non_exhaustive()
    }
}

/// Motions in files.
#[cfg(feature = "serde")]
mod file {
    use std::any::Any;

    use serde::ser::Error;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

    use super::Motion;
    use crate::wall::{BiParabolic, Fixed, Sawtooth, Sinusoidal, Triangular};

    /// The motions of the crate.
    #[derive(Debug, Clone, Copy, Serialize, Deserialize)]
    #[serde(rename = "Motion")]
    pub(super) enum Known {
        Fixed,
        BiParabolic(BiParabolic),
        Sinusoidal(Sinusoidal),
        Triangular(Triangular),
        Sawtooth(Sawtooth),
    }

    impl Known {
        pub(super) fn of(motion: &dyn Any) -> Option<Self> {
            let copy = |known: Option<&Fixed>| known.map(|_| Self::Fixed);
            copy(motion.downcast_ref())
                .or_else(|| motion.downcast_ref().copied().map(Self::BiParabolic))
                .or_else(|| motion.downcast_ref().copied().map(Self::Sinusoidal))
                .or_else(|| motion.downcast_ref().copied().map(Self::Triangular))
                .or_else(|| motion.downcast_ref().copied().map(Self::Sawtooth))
        }
    }

    impl Serialize for Motion {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            let own = "a wall motion that is not of granular-edmd cannot be serialized";
            self.known.ok_or_else(|| S::Error::custom(own))?.serialize(serializer)
        }
    }

    impl<'de> Deserialize<'de> for Motion {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let motion = match Known::deserialize(deserializer)? {
                Known::Fixed => Self::new(Fixed),
                Known::BiParabolic(motion) => Self::new(motion),
                Known::Sinusoidal(motion) => Self::new(motion),
                Known::Triangular(motion) => Self::new(motion),
                Known::Sawtooth(motion) => Self::new(motion),
            };
            motion.map_err(de::Error::custom)
        }
    }
}
