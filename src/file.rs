//! Files: contents under a seal that shows damage, and writes that leave a file whole or as it was.

#[cfg(feature = "serde")]
mod seal;
mod whole;

#[cfg(feature = "serde")]
pub(crate) use seal::{Broken, Seal};
pub(crate) use whole::write_whole;
#[cfg(feature = "serde")]
pub(crate) use whole::{is_temporary, unique_name};
