//! Files: contents with a seal that tells damage, and writing that leaves a file whole or as it was.

mod seal;
mod whole;

pub(crate) use seal::{Broken, Seal};
pub(crate) use whole::{is_temporary, unique_name, write_whole};
