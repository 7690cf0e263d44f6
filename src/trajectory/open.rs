//! Files to read from.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::errors::ReadError;

/// Opens a file for the readers of this module.
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

/// Returns true if the name of a file says that it is compressed.
pub(super) fn is_gzip(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "gz")
}
