//! Bytes with a name, a version and a checksum, and files that are whole or not there.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

/// What comes before the contents: the name of the format, its version, a checksum of the contents.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seal {
    pub(crate) magic: [u8; 8],
    pub(crate) version: u32,
}

/// Why contents are not to be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Broken {
    /// They are of another format.
    Foreign,
    /// They are of another version of the format.
    Version(u32),
    /// They were cut.
    Cut,
    /// Their checksum does not match.
    Changed,
}

impl Seal {
    /// The contents behind this seal.
    pub(crate) fn seal(self, contents: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(44 + contents.len());
        bytes.extend_from_slice(&self.magic);
        bytes.extend_from_slice(&self.version.to_le_bytes());
        bytes.extend_from_slice(blake3::hash(contents).as_bytes());
        bytes.extend_from_slice(contents);
        bytes
    }

    /// The contents, if the seal is whole.
    pub(crate) fn open(self, bytes: &[u8]) -> Result<&[u8], Broken> {
        let rest = bytes.strip_prefix(&self.magic).ok_or(Broken::Foreign)?;
        let (version, rest) = rest.split_first_chunk::<4>().ok_or(Broken::Cut)?;
        let version = u32::from_le_bytes(*version);
        if version != self.version {
            return Err(Broken::Version(version));
        }
        let (checksum, contents) = rest.split_first_chunk::<32>().ok_or(Broken::Cut)?;
        if blake3::hash(contents) != blake3::Hash::from_bytes(*checksum) {
            return Err(Broken::Changed);
        }
        Ok(contents)
    }
}

/// Ending of files that are being written.
pub(crate) const TEMPORARY: &str = "tmp";

/// Writes a file, whole or not at all: a reader never sees half of it, and a file of that name stays if this fails.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.{TEMPORARY}", std::process::id()));
    let temporary = path.with_file_name(name);
    let written = write_synced(&temporary, bytes).and_then(|()| fs::rename(&temporary, path));
    if written.is_err() {
        // What is left of the attempt helps nobody; the first error is the one to tell.
        let _ = fs::remove_file(&temporary);
    }
    written
}

fn write_synced(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}
