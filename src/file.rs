//! Files: contents under a seal that shows damage, and writes that leave a file whole or as it was.

mod seal;
mod whole;

pub(crate) use seal::{Broken, Seal};
pub(crate) use whole::{is_temporary, unique_name, write_whole};
