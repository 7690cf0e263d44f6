//! Files: contents under a seal that shows damage, writes that leave a file whole or as it was, and locks.

mod locked;
#[cfg(feature = "serde")]
mod seal;
#[cfg(feature = "serde")]
mod whole;

pub(crate) use locked::Locked;
#[cfg(feature = "serde")]
pub(crate) use seal::{Broken, Seal};
#[cfg(feature = "serde")]
pub(crate) use whole::{Draft, is_temporary, unique_name, write_unsynced, write_whole};
