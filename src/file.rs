//! Files that are complete or absent, and locks. Checkpoints and studies consist of such files, and other
//! packages can use them for their stores.
//!
//! ```
//! # #[cfg(feature = "serde")] {
//! use granular_edmd::file::{Damage, Seal, write_whole};
//!
//! const SEAL: Seal = Seal::new(*b"MY STORE", 1);
//! # let path = std::env::temp_dir().join(format!("granular-edmd-file-{}", std::process::id()));
//! // A reader never sees half of the file, even if this process is killed.
//! write_whole(&path, &SEAL.seal(b"contents"))?;
//! let mut bytes = std::fs::read(&path)?;
//! assert_eq!(SEAL.open(&bytes), Ok(b"contents".as_slice()));
//! // A byte that a broken disk has changed does not go unnoticed.
//! bytes[50] ^= 1;
//! assert_eq!(SEAL.open(&bytes), Err(Damage::Changed));
//! # std::fs::remove_file(&path)?;
//! # }
//! # Ok::<(), std::io::Error>(())
//! ```

mod locked;
#[cfg(feature = "serde")]
mod seal;
#[cfg(feature = "serde")]
mod whole;

pub use locked::Locked;
#[cfg(feature = "serde")]
pub use seal::{Damage, Seal};
#[cfg(feature = "serde")]
pub use whole::{Draft, is_temporary, unique_name, write_whole};
