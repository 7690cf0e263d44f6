//! The runs that are kept with the repository, as one archive.

use std::fs;
use std::path::{Path, PathBuf};

/// Returns the folder of the kept runs of this name, wherever a program is started.
pub fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("docs").join("reproduction/runs").join(name)
}

/// Returns what is in a folder of runs, in the order of names.
///
/// # Errors
///
/// If there is no such folder. The message says how to get it.
pub fn entries(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let failed = |error: std::io::Error| {
        let path = folder.display();
        format!(
            "{path}: {error}; `docs/reproduction/draw runs` in the repository unpacks the runs that are kept"
        )
    };
    let entries = fs::read_dir(folder).map_err(failed)?.map(|entry| entry.map(|entry| entry.path()));
    let mut entries = entries.collect::<Result<Vec<_>, _>>().map_err(failed)?;
    entries.sort();
    Ok(entries)
}
