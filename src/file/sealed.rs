//! Files that are complete or absent, and seals that show damage.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Name and version of a format. A sealed file holds these first, then a checksum of the contents, then the
/// contents.
#[derive(Debug, Clone, Copy)]
pub struct Seal {
    magic: [u8; 8],
    version: u32,
}

/// A fault that a seal reveals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Damage {
    /// The contents are of another format.
    Foreign,
    /// The contents are of another version of the format.
    Version(u32),
    /// The contents are cut short.
    Cut,
    /// The checksum does not match the contents.
    Changed,
}

/// Number of bytes of name, version and checksum.
const HEADER: usize = 8 + 4 + blake3::OUT_LEN;

impl Seal {
    /// Creates the seal of a format with these first bytes, in this version.
    pub const fn new(magic: [u8; 8], version: u32) -> Self {
        Self { magic, version }
    }

    /// Returns the version of the format.
    pub const fn version(self) -> u32 {
        self.version
    }

    /// Returns the bytes with which a file of the format begins: the magic bytes and the version.
    fn start(self) -> [u8; 12] {
        let mut start = [0; 12];
        start[..8].copy_from_slice(&self.magic);
        start[8..].copy_from_slice(&self.version.to_le_bytes());
        start
    }

    /// Returns the contents with this seal before them.
    pub fn seal(self, contents: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(HEADER + contents.len());
        bytes.extend_from_slice(&self.start());
        bytes.extend_from_slice(blake3::hash(contents).as_bytes());
        bytes.extend_from_slice(contents);
        bytes
    }

    /// Checks the seal of these bytes, and returns the contents after it.
    ///
    /// # Errors
    /// If the bytes are of another format or version, or were truncated or altered.
    pub fn open(self, bytes: &[u8]) -> Result<&[u8], Damage> {
        let rest = bytes.strip_prefix(&self.magic).ok_or(Damage::Foreign)?;
        let (version, rest) = rest.split_first_chunk::<4>().ok_or(Damage::Cut)?;
        let version = u32::from_le_bytes(*version);
        if version != self.version {
            return Err(Damage::Version(version));
        }
        let (checksum, contents) = rest.split_first_chunk::<32>().ok_or(Damage::Cut)?;
        if blake3::hash(contents) != blake3::Hash::from_bytes(*checksum) {
            return Err(Damage::Changed);
        }
        Ok(contents)
    }
}

/// Beginning and ending of the names of files that are being written.
const TEMPORARY: (&str, &str) = ("granular-edmd-", ".tmp");

/// Writes a file completely or not at all. A reader never sees half of it, and if the write fails, an older
/// file of that name stays.
///
/// The bytes go to a temporary file in the same folder, which then takes the name of the file. Any number of
/// threads, processes and hosts may write the same file at the same time: each has its own temporary file,
/// and the last one to rename it wins.
///
/// # Errors
/// If the system cannot write the file.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut draft = Draft::of(path)?;
    draft.write_all(bytes)?;
    draft.finish()
}

/// A file that is written piece by piece, and gets its name when it is complete. A draft that is dropped
/// leaves nothing behind.
#[derive(Debug)]
pub struct Draft {
    path: PathBuf,
    temporary: PathBuf,
    file: BufWriter<File>,
}

impl Draft {
    /// Begins a file under a temporary name in the same folder.
    ///
    /// # Errors
    /// If the path names no file, or the system cannot create one beside it.
    pub fn of(path: &Path) -> io::Result<Self> {
        if path.file_name().is_none() {
            let reason = "the path does not end in the name of a file";
            return Err(io::Error::new(io::ErrorKind::InvalidInput, reason));
        }
        // The file is new: an existing one is never touched.
        let temporary = path.with_file_name(unique_name());
        let file = File::create_new(&temporary)?;
        Ok(Self { path: path.to_owned(), temporary, file: BufWriter::new(file) })
    }

    /// Adds bytes to the file.
    ///
    /// # Errors
    /// If the system cannot write them.
    pub fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.file.write_all(bytes)
    }

    /// Renames the finished file to its final name, so that it survives a loss of power.
    ///
    /// # Errors
    /// If the system cannot write the file. An older file of that name then stays unchanged.
    pub fn finish(mut self) -> io::Result<()> {
        self.file.flush()?;
        self.file.get_ref().sync_all()?;
        fs::rename(&self.temporary, &self.path)?;
        // After the renaming, there is no temporary file to remove.
        self.temporary.clear();
        sync_folder(&self.path);
        Ok(())
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        // The temporary file is no longer needed. A failure to remove it is ignored, since the first error is
        // the one to report.
        if !self.temporary.as_os_str().is_empty() {
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

/// Returns whether a name is the name of a temporary file of [`write_whole`]. Every part of it must match.
pub fn is_temporary(name: &OsStr) -> bool {
    let unique = name.to_str().and_then(|name| name.strip_prefix(TEMPORARY.0)?.strip_suffix(TEMPORARY.1));
    let Some(unique) = unique else { return false };
    let is_decimal = |part: &str| !part.is_empty() && part.bytes().all(|digit| digit.is_ascii_digit());
    let is_hexadecimal = |part: &str| part.len() == 16 && part.bytes().all(|digit| digit.is_ascii_hexdigit());
    let parts: Vec<&str> = unique.split('-').collect();
    matches!(parts[..], [process, count, random]
        if is_decimal(process) && is_decimal(count) && is_hexadecimal(random))
}

/// Returns a name that no other writer uses.
///
/// The process number distinguishes programs on this host, the count distinguishes writers in this process,
/// and the random number distinguishes hosts that share a disk. The file's own name is left out, so that the
/// result cannot become too long.
pub fn unique_name() -> String {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    // The standard library seeds its hash tables from the system: a random number that needs no dependency.
    let random = RandomState::new().build_hasher().finish();
    format!("{}{}-{count}-{random:016x}{}", TEMPORARY.0, std::process::id(), TEMPORARY.1)
}

/// Asks the system to keep the new name through a loss of power, too.
///
/// A failure is ignored: the file is in its place already, and some file systems cannot open or sync folders.
fn sync_folder(path: &Path) {
    if cfg!(unix) {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        let _ = File::open(folder.unwrap_or(Path::new("."))).and_then(|folder| folder.sync_all());
    }
}
