//! Seals of files: a name, a version and a checksum before the contents.

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
