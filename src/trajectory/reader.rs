//! The reader of files of disks.

use std::collections::VecDeque;
use std::fmt;
use std::fs::File;
use std::io::BufRead;
use std::path::Path;

use super::found::{Found, Frames};
use super::settings::Settings;
use super::{ReadError, State, disks, source};
use crate::ParameterError;
use crate::disk::scale;
use crate::quantity::non_negative;

/// Reads disks from files: extended XYZ, dumps and data files of LAMMPS, GSD, and tables.
#[derive(Debug, Clone, PartialEq)]
pub struct Reader {
    frame: Choice,
    settings: Settings,
}

/// The frame that is read.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Choice {
    /// Counted from 0, or from the end if negative.
    Number(isize),
    Step(u64),
}

impl Default for Reader {
    fn default() -> Self {
        Self::new()
    }
}

impl Reader {
    /// Creates a reader of the last frame of a file.
    pub const fn new() -> Self {
        let settings = Settings { tolerance: None, shrinks: false, density: None, radius: None };
        Self { frame: Choice::Number(-1), settings }
    }

    /// Returns the same reader for the frame of this number, counted from 0, or from the end if negative: −1 is
    /// the last frame.
    #[must_use]
    pub const fn with_frame(self, number: isize) -> Self {
        Self { frame: Choice::Number(number), ..self }
    }

    /// Returns the same reader for the frame of this step, as dumps of LAMMPS and GSD number their frames.
    #[must_use]
    pub const fn with_step(self, step: u64) -> Self {
        Self { frame: Choice::Step(step), ..self }
    }

    /// Returns the same reader, which accepts overlaps up to this depth, relative to the sum of the radii.
    ///
    /// # Errors
    /// If it is negative, infinite or NaN.
    pub fn with_tolerance(mut self, tolerance: f64) -> Result<Self, ParameterError> {
        self.settings.tolerance = Some(non_negative("tolerance", tolerance)?);
        Ok(self)
    }

    /// Returns the same reader, which shrinks all radii in proportion until no disks overlap.
    #[must_use]
    pub const fn with_shrunk_radii(mut self) -> Self {
        self.settings.shrinks = true;
        self
    }

    /// Returns the same reader, with this mass per area for the disks of a file without masses.
    ///
    /// # Errors
    /// If it is not in `[1e-30, 1e30]`.
    pub fn with_density(mut self, density: f64) -> Result<Self, ParameterError> {
        self.settings.density = Some(scale("density", density)?);
        Ok(self)
    }

    /// Returns the same reader, with this radius for the disks of a file without radii.
    ///
    /// # Errors
    /// If it is not in `[1e-30, 1e30]`.
    pub fn with_radius(mut self, radius: f64) -> Result<Self, ParameterError> {
        self.settings.radius = Some(scale("radius", radius)?);
        Ok(self)
    }

    /// Reads a frame of a file.
    ///
    /// # Errors
    /// As for [`read_from`](Self::read_from), and if the file cannot be opened. The error names the file.
    pub fn read(&self, path: impl AsRef<Path>) -> Result<State, ReadError> {
        let path = path.as_ref();
        let file = File::open(path).map_err(|source| ReadError::Open { path: path.to_owned(), source })?;
        let failed = |source| ReadError::File { path: path.to_owned(), source: Box::new(source) };
        source::frames_of_file(file).and_then(|frames| self.state(frames)).map_err(failed)
    }

    /// Reads a frame of an input.
    ///
    /// # Errors
    /// If the input fails, is of no known format or has no such frame, or if the frame is no valid state.
    pub fn read_from(&self, input: impl BufRead) -> Result<State, ReadError> {
        self.state(source::frames(input)?)
    }

    fn state(&self, frames: Frames<'_>) -> Result<State, ReadError> {
        disks::state((self.frame.find(frames)?.read)()?, &self.settings)
    }

    /// Returns the states of all frames of an input, one after another. The iterator ends after an error.
    ///
    /// # Errors
    /// If the input fails at its start, or is of no known format.
    pub fn frames<'a>(&self, input: impl BufRead + 'a) -> Result<States<'a>, ReadError> {
        Ok(States { frames: Some(source::frames(input)?), settings: self.settings.clone() })
    }
}

impl Choice {
    /// Finds the frame.
    fn find(self, mut frames: Frames<'_>) -> Result<Found<'_>, ReadError> {
        // The last frames, as many as the choice needs.
        let mut last = VecDeque::new();
        let kept = match self {
            Self::Number(number) if number < 0 => number.unsigned_abs(),
            _ => 1,
        };
        let mut count = 0;
        while let Some(found) = frames.next().transpose()? {
            let is_it = match self {
                Self::Number(number) => usize::try_from(number).is_ok_and(|number| number == count),
                Self::Step(step) => found.step == Some(step),
            };
            if is_it {
                return Ok(found);
            }
            if last.len() == kept {
                last.pop_front();
            }
            last.push_back(found);
            count += 1;
        }
        let is_there = matches!(self, Self::Number(number) if number < 0) && last.len() == kept;
        let first = last.pop_front().filter(|_| is_there);
        first.ok_or_else(|| match self {
            _ if count == 0 => ReadError::End { line: 0, what: "a frame".to_owned() },
            Self::Number(number) => ReadError::NoFrame { wanted: format!("number {number}"), count },
            Self::Step(step) => ReadError::NoFrame { wanted: format!("step {step}"), count },
        })
    }
}

/// The states of the frames of a file, from [`Reader::frames`].
pub struct States<'a> {
    /// The frames that are left; `None` after an error.
    frames: Option<Frames<'a>>,
    settings: Settings,
}

impl Iterator for States<'_> {
    type Item = Result<State, ReadError>;

    fn next(&mut self) -> Option<Self::Item> {
        let found = self.frames.as_mut()?.next()?;
        let state = found.and_then(|found| disks::state((found.read)()?, &self.settings));
        if state.is_err() {
            self.frames = None;
        }
        Some(state)
    }
}

impl fmt::Debug for States<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("States").finish_non_exhaustive()
    }
}
