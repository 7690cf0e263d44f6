//! Files to read from, by their paths.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::ReadError;

/// Opens a file for the readers of this module. [`read`] also names the file in their errors.
///
/// With the feature `gzip`, a file whose name ends in `.gz` is decompressed.
///
/// ```
/// use granular_edmd::trajectory::open;
/// let error = open("there/is/no.xyz").err().unwrap();
/// assert_eq!(error.to_string(), "cannot open there/is/no.xyz");
/// ```
///
/// # Errors
/// If the file cannot be opened, or is compressed and this program lacks the feature.
pub fn open(path: impl AsRef<Path>) -> Result<Box<dyn BufRead + Send>, ReadError> {
    let path = path.as_ref();
    let failed = |source| ReadError::Open { path: path.to_owned(), source };
    let file = BufReader::new(File::open(path).map_err(failed)?);
    if !is_gzip(path) {
        return Ok(Box::new(file));
    }
    #[cfg(feature = "gzip")]
    return Ok(Box::new(BufReader::new(flate2::bufread::MultiGzDecoder::new(file))));
    #[cfg(not(feature = "gzip"))]
    return Err(failed(std::io::Error::other("it is compressed, which needs the feature `gzip`")));
}

/// Reads a file with one of the readers of this module. Its errors name the file, and the line in it.
///
/// ```
/// use granular_edmd::trajectory::{State, read};
/// # let path = std::env::temp_dir().join(format!("granular-edmd-read-{}.csv", std::process::id()));
/// // Let `path` be "disks.csv".
/// std::fs::write(&path, "x,y,radius\n1,1,0.5\n3,1,0.5\n")?;
/// assert_eq!(read(&path, State::from_csv)?.disks().len(), 2);
///
/// std::fs::write(&path, "x,y,radius\n1,1,0.5\n3,1,half\n")?;
/// let error = read(&path, State::from_csv).unwrap_err();
/// assert_eq!(error.to_string(), format!("cannot use {}", path.display()));
/// # let cause = std::error::Error::source(&error).unwrap().to_string();
/// assert_eq!(cause, "line 3: radius must be a number, but is \"half\"");
/// # std::fs::remove_file(&path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the file cannot be [opened](open), and the errors of the reader.
pub fn read<T>(
    path: impl AsRef<Path>,
    reader: impl FnOnce(Box<dyn BufRead + Send>) -> Result<T, ReadError>,
) -> Result<T, ReadError> {
    let path = path.as_ref();
    let failed = |source| ReadError::File { path: path.to_owned(), source: Box::new(source) };
    reader(open(path)?).map_err(failed)
}

/// Returns true if a file is compressed, by its name.
pub(super) fn is_gzip(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "gz")
}
