//! Frames of extended XYZ, read one by one.

use std::fmt;
use std::io::BufRead;

use super::header::Header;
use crate::trajectory::entry::Entry;
use crate::trajectory::lines::Lines;
use crate::trajectory::{ReadError, State};

/// The frames of a file of extended XYZ, one after another, as [`State`]s.
///
/// A frame needs the columns `pos` and `radius`. The other columns of [`ExtendedXyz`](super::ExtendedXyz) are
/// read if they are there. Without them, a disk has the values that [`Disk::new`](crate::Disk::new) gives it.
/// Columns of other names are ignored. Disks come in the order of their `id`.
///
/// The iterator ends after an error.
///
/// ```
/// use granular_edmd::trajectory::XyzFrames;
/// let text = "1\nLattice=\"4 0 0 0 6 0 0 0 1\" Properties=pos:R:2:radius:R:1\n1 2 0.5\n";
/// let frames: Vec<_> = XyzFrames::new(text.repeat(2).as_bytes()).collect::<Result<_, _>>()?;
/// assert_eq!((frames.len(), frames[1].disks()[0].position().y), (2, 2.0));
///
/// let error = XyzFrames::new("1\nProperties=pos:R:2\n1 2\n".as_bytes()).next().unwrap().unwrap_err();
/// assert_eq!(error.to_string(), "line 2: the column `radius` is missing");
/// # Ok::<(), granular_edmd::trajectory::ReadError>(())
/// ```
pub struct XyzFrames<R> {
    /// The rest of the file; `None` after an error.
    lines: Option<Lines<R>>,
}

impl<R: BufRead> XyzFrames<R> {
    /// Creates a reader of the frames of an input, such as a file that was [opened](crate::trajectory::open).
    pub const fn new(input: R) -> Self {
        Self { lines: Some(Lines::new(input)) }
    }
}

impl<R: BufRead> Iterator for XyzFrames<R> {
    type Item = Result<State, ReadError>;

    fn next(&mut self) -> Option<Self::Item> {
        let frame = read_frame(self.lines.as_mut()?).transpose();
        if !matches!(frame, Some(Ok(_))) {
            self.lines = None;
        }
        frame
    }
}

impl<R> fmt::Debug for XyzFrames<R> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("XyzFrames").finish_non_exhaustive()
    }
}

impl State {
    /// Reads the last frame of a file of extended XYZ.
    ///
    /// # Errors
    /// If the input fails, there is no frame, a frame is cut short, or a frame is not a valid state: a part
    /// is missing or appears twice, disks overlap, or a disk is outside the box. The error names the line.
    pub fn from_xyz(input: impl BufRead) -> Result<Self, ReadError> {
        let missing = || ReadError::End { line: 0, what: "a frame".to_owned() };
        XyzFrames::new(input).try_fold(None, |_, state| state.map(Some))?.ok_or_else(missing)
    }
}

/// Reads a frame, if there is one more.
fn read_frame<R: BufRead>(lines: &mut Lines<R>) -> Result<Option<State>, ReadError> {
    let Some((text, line)) = lines.next_filled()? else { return Ok(None) };
    let count: usize = text.trim().parse().map_err(|_| {
        ReadError::unexpected(line, "the first line of a frame", "the number of its disks", text)
    })?;
    let (keys, line) = lines.need("the keys of a frame")?;
    let header = Header::parse(keys, line)?;
    let mut entries = Vec::new();
    for number in 0..count {
        let (text, line) = lines.need(&format!("disk {} of {count}", number + 1))?;
        entries.push(header.columns.entry(text.split_whitespace(), line)?);
    }
    let disks = Entry::checked(entries, header.domain.as_ref())?;
    Ok(Some(State { disks, domain: header.domain, time: header.time, gravity: header.gravity }))
}
