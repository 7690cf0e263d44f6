//! A motion in owned form, which several walls can share.

use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

use super::laws::{Violation, check_finite};
use super::mirrored::Mirrored;
use super::{Fixed, WallMotion};

/// A motion of any type.
///
/// A motion of the crate is recognized, so it can be written to files and read back. A motion of your own
/// cannot.
#[derive(Clone)]
pub(crate) struct Motion {
    motion: Arc<dyn WallMotion + Send + Sync>,
    #[cfg(feature = "serde")]
    known: Option<file::Record>,
}

impl Motion {
    /// Takes a motion, if it passes `check_finite`.
    pub(crate) fn new<M: WallMotion + Send + Sync + 'static>(motion: M) -> Result<Self, Violation> {
        check_finite(&motion)?;
        #[cfg(feature = "serde")]
        let known = file::Record::of(&motion);
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
            known: file::Record::of(&Fixed),
        }
    }

    /// Returns the same motion in the opposite direction.
    pub(crate) fn mirrored(&self) -> Self {
        Self {
            motion: Arc::new(Mirrored(Arc::clone(&self.motion))),
            #[cfg(feature = "serde")]
            known: self.known.map(file::Record::mirrored),
        }
    }

    /// Tells whether the motion jumps at the end of a piece. The function looks at the first period, or at
    /// the first thousand pieces if they are over earlier.
    pub(crate) fn jumps(&self) -> bool {
        const PIECES: usize = 1000;
        let (low, high) = self.reach();
        let end = self.period().unwrap_or(f64::INFINITY);
        let mut phase = 0.0;
        for _ in 0..PIECES {
            let until = self.acceleration(phase).until;
            if !(until.is_finite() && until > phase) {
                return false;
            }
            let (before, after) = (self.state(until.next_down()), self.state(until));
            if (after.displacement - before.displacement).abs() > 1e-6 * (high - low) {
                return true;
            }
            if until >= end {
                return false;
            }
            phase = until;
        }
        false
    }

    /// Returns the phase at a time origin: the origin less whole periods.
    pub(crate) fn phase(&self, origin: f64) -> f64 {
        let (low, high) = self.reach();
        match self.period() {
            // A wall that never moves is the same at all times. At phase 0, times lose none of their digits.
            _ if low == high => 0.0,
            // The remainder of two floats is exact, so the phase keeps all its digits, however late the time.
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
    use crate::ParameterError;
    use crate::wall::laws::Violation;
    use crate::wall::{BiParabolic, Fixed, Sawtooth, Sinusoidal, StartingAt, Triangular, WallMotion};

    /// The motions of the crate.
    #[derive(Debug, Clone, Copy, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case", rename = "KnownMotion")]
    pub(super) enum Known {
        Fixed,
        BiParabolic(BiParabolic),
        Sinusoidal(Sinusoidal),
        Triangular(Triangular),
        Sawtooth(Sawtooth),
    }

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
        pub(super) fn of(motion: &dyn Any) -> Option<Self> {
            let plain = Known::of(motion).map(|motion| (motion, 0.0));
            let known = plain
                .or_else(|| starting_at(motion, Known::BiParabolic))
                .or_else(|| starting_at(motion, Known::Sinusoidal))
                .or_else(|| starting_at(motion, Known::Triangular))
                .or_else(|| starting_at(motion, Known::Sawtooth));
            known.map(|(motion, start)| Self { motion, start, is_mirrored: false })
        }

        pub(super) fn mirrored(self) -> Self {
            Self { is_mirrored: !self.is_mirrored, ..self }
        }
    }

    /// Recognizes a motion of type `M` that starts at a time, and returns it with that time.
    fn starting_at<M: WallMotion + Copy + 'static>(
        motion: &dyn Any,
        known: fn(M) -> Known,
    ) -> Option<(Known, f64)> {
        let starting_at = motion.downcast_ref::<StartingAt<M>>()?;
        Some((known(*starting_at.motion()), starting_at.start()))
    }

    /// Builds a motion from the data of a file, or returns the reason why it cannot.
    fn owned<M: WallMotion + Send + Sync + 'static>(motion: M, start: f64) -> Result<Motion, String> {
        let told = |violation: Violation| violation.to_string();
        if start == 0.0 {
            return Motion::new(motion).map_err(told);
        }
        let starting_at =
            StartingAt::new(motion, start).map_err(|error: ParameterError| error.to_string())?;
        Motion::new(starting_at).map_err(told)
    }

    impl Known {
        fn of(motion: &dyn Any) -> Option<Self> {
            let fixed = motion.downcast_ref().map(|Fixed| Self::Fixed);
            fixed
                .or_else(|| motion.downcast_ref().copied().map(Self::BiParabolic))
                .or_else(|| motion.downcast_ref().copied().map(Self::Sinusoidal))
                .or_else(|| motion.downcast_ref().copied().map(Self::Triangular))
                .or_else(|| motion.downcast_ref().copied().map(Self::Sawtooth))
        }
    }

    impl Serialize for Motion {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            let own = "only the wall motions of granular-edmd can be serialized";
            self.known.ok_or_else(|| S::Error::custom(own))?.serialize(serializer)
        }
    }

    impl<'de> Deserialize<'de> for Motion {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let Record { motion, start, is_mirrored } = Record::deserialize(deserializer)?;
            let motion = match motion {
                Known::Fixed => owned(Fixed, start),
                Known::BiParabolic(motion) => owned(motion, start),
                Known::Sinusoidal(motion) => owned(motion, start),
                Known::Triangular(motion) => owned(motion, start),
                Known::Sawtooth(motion) => owned(motion, start),
            };
            let motion = motion.map_err(de::Error::custom)?;
            Ok(if is_mirrored { motion.mirrored() } else { motion })
        }
    }
}
