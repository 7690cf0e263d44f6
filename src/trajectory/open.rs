//! Names of files.

use std::path::Path;

/// Returns whether a recorder compresses a file, by its name.
pub(super) fn is_gzip(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "gz")
}
