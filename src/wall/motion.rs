//! A motion in owned form, which several walls can share.

use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

#[cfg(feature = "serde")]
use super::known::Record;
use super::mirrored::Mirrored;
use super::{Fixed, Violation, WallMotion, check_finite};

/// A motion of any type.
///
/// A motion of the crate is recognized, so it can be written to files and read back. A motion of your own
/// cannot.
#[derive(Clone)]
pub(crate) struct Motion {
    motion: Arc<dyn WallMotion + Send + Sync>,
    #[cfg(feature = "serde")]
    known: Option<Record>,
}

impl Motion {
    /// Takes a motion, if it passes `check_finite`.
    pub(crate) fn new<M: WallMotion + Send + Sync + 'static>(motion: M) -> Result<Self, Violation> {
        check_finite(&motion)?;
        #[cfg(feature = "serde")]
        let known = Record::of(&motion);
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
            known: Some(Record::FIXED),
        }
    }

    /// Returns the same motion in the opposite direction.
    pub(crate) fn mirrored(&self) -> Self {
        Self {
            motion: Arc::new(Mirrored(Arc::clone(&self.motion))),
            #[cfg(feature = "serde")]
            known: self.known.map(Record::mirrored),
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

#[cfg(feature = "serde")]
impl serde::Serialize for Motion {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let own = "only the wall motions of granular-edmd can be serialized";
        self.known.ok_or_else(|| serde::ser::Error::custom(own))?.serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for Motion {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let record = Record::deserialize(deserializer)?;
        let motion = record.motion().map_err(serde::de::Error::custom)?;
        let motion: Arc<dyn WallMotion + Send + Sync> =
            if record.is_mirrored() { Arc::new(Mirrored(motion)) } else { motion };
        Ok(Self { motion, known: Some(record) })
    }
}
