//! The reader of files of disks, which recognizes a format by the contents.

use std::collections::VecDeque;
use std::fmt;
use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Read, Seek};
use std::path::Path;

use granular_edmd::ParameterError;
use granular_edmd::quantity::{accept, non_negative, positive};

use super::lines::Input;
use super::table::{Found, Frames, Settings};
use super::{ReadError, State, csv, disks, extended_xyz, gsd, lammps_data, lammps_dump};

/// Number of bytes by which the format is recognized.
const HEAD: u64 = 1 << 14;

/// Returns the frames of a file. A GSD file is not read completely.
fn frames_of_file<'a>(mut file: File) -> Result<Frames<'a>, ReadError> {
    let failed = |cause| ReadError::Io { line: 1, cause };
    let mut head = Vec::new();
    file.by_ref().take(8).read_to_end(&mut head).map_err(failed)?;
    file.rewind().map_err(failed)?;
    if gsd::is_gsd(&head) { gsd::frames(file) } else { frames(BufReader::new(file)) }
}

/// Returns the frames of an input, which may be compressed.
fn frames<'a>(input: impl BufRead + 'a) -> Result<Frames<'a>, ReadError> {
    let (head, input) = with_head(Box::new(input))?;
    if !head.starts_with(&[0x1f, 0x8b]) {
        return of_format(&head, input);
    }
    let (head, input) = with_head(inflated(input)?)?;
    of_format(&head, input)
}

type Boxed<'a> = Box<dyn BufRead + 'a>;

/// Returns the first bytes of an input, and the input from its start.
fn with_head(mut input: Boxed<'_>) -> Result<(Vec<u8>, Boxed<'_>), ReadError> {
    let mut head = Vec::new();
    let read = input.by_ref().take(HEAD).read_to_end(&mut head);
    read.map_err(|cause| ReadError::Io { line: 1, cause })?;
    Ok((head.clone(), Box::new(Cursor::new(head).chain(input))))
}

#[cfg(feature = "gzip")]
#[expect(clippy::unnecessary_wraps, reason = "without the feature, it is an error")]
fn inflated(input: Boxed<'_>) -> Result<Boxed<'_>, ReadError> {
    Ok(Box::new(BufReader::new(flate2::bufread::MultiGzDecoder::new(input))))
}

#[cfg(not(feature = "gzip"))]
fn inflated(_: Boxed<'_>) -> Result<Boxed<'_>, ReadError> {
    let cause =
        std::io::Error::other("it is compressed, which needs the feature `gzip` of granular-edmd-files");
    Err(ReadError::Io { line: 1, cause })
}

/// Returns the frames of an input that begins with these bytes.
fn of_format<'a>(head: &[u8], mut input: Boxed<'a>) -> Result<Frames<'a>, ReadError> {
    if gsd::is_gsd(head) {
        // The index may be anywhere.
        let mut bytes = Vec::new();
        input.read_to_end(&mut bytes).map_err(|error| ReadError::gsd(error.to_string()))?;
        return gsd::frames(Cursor::new(bytes));
    }
    let head = String::from_utf8_lossy(head);
    let mut lines = head.trim_start_matches('\u{feff}').trim_start().lines();
    let [first, second] = [(); 2].map(|()| lines.next().unwrap_or_default().trim());
    let is_count = !first.is_empty() && first.bytes().all(|letter| letter.is_ascii_digit());
    let mut input = Input::new(input);
    if first.starts_with("ITEM:") {
        return Ok(Box::new(std::iter::from_fn(move || lammps_dump::next(&mut input).transpose())));
    }
    if is_count || second.contains("Properties") {
        return Ok(Box::new(std::iter::from_fn(move || extended_xyz::next(&mut input).transpose())));
    }
    let text = input.rest()?;
    if lammps_data::is_data(&head) {
        return Ok(Box::new(std::iter::once(Ok(Found::in_text(text, None, lammps_data::table)))));
    }
    Ok(Box::new(csv::frames(&text)?.into_iter().map(Ok)))
}

/// Reads disks from files of this crate and of other programs.
///
/// The contents determine the format: extended XYZ, a dump of LAMMPS or LIGGGHTS, a data file of LAMMPS, GSD,
/// or a table whose first line names its columns, separated by commas, semicolons, tabs or spaces. With the
/// feature `gzip`, the file may be compressed.
///
/// Columns are recognized by their names, in any order and case. A position and a radius are needed; without
/// the other columns, a disk has the defaults of [`Disk::new`](granular_edmd::Disk::new).
///
/// | property | names |
/// |---|---|
/// | position | `pos`, `position`; `x y`; `xs ys` as shares of the box; `unwrapped`, `xu yu` |
/// | radius | `radius`, `radii`, `r`; `diameter`, `d` |
/// | velocity | `velo`, `vel`, `velocity`, `v`, `vx vy`; `momenta`, if there are masses |
/// | mass | `mass`, `masses`, `m`; `density`, as mass per area, or of a sphere in files of LAMMPS |
/// | angle | `angle`; `orientation`, as an angle or a quaternion x, y, z, w |
/// | angular velocity | `angular_velocity`, `omega`, `omegaz`, `wz`; of three components the third |
/// | id | `id`, `identifier`; without these `particle`, `track_id` |
/// | kind | `kind`; `type`, from 1 in LAMMPS; `species`, `element`, `name`: numbers, or names in order |
/// | periods passed | `image`, `ix iy` |
/// | factor of the moment of inertia | `inertia_factor` |
///
/// A table has frames if a column is named `frame`, `step`, `slice`, `time` or `t`.
///
/// The letter or number of a component may follow the name of the property, as in `vel_x`, `Position.X` or
/// `velocity:0`. Two columns of the same quantity must agree. Disks keep the order of the file. They must lie
/// in one plane; the coordinate z is ignored. [`State::notes`] lists everything that the reader ignores or
/// changes.
///
/// # Examples
/// The example turns a state of soft disks, whose contacts overlap, into a start for hard disks:
/// ```
/// use granular_edmd::prelude::*;
/// use granular_edmd_files::Reader;
///
/// let dump = "ITEM: TIMESTEP\n5000\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff pp\n0 9\n0 9\n-1 1\n\
///             ITEM: ATOMS id type x y vx vy diameter fx\n1 1 1 2 3 0 1 7\n2 1 1.9375 2 0 0 1 -7\n";
/// let error = Reader::new().read_from(dump.as_bytes()).unwrap_err();
/// assert!(error.to_string().starts_with("line 11: the disk overlaps the disk of line 10 by 0.0625"));
///
/// let state = Reader::new().with_shrunk_radii().read_from(dump.as_bytes())?;
/// let shrunk = "all radii are shrunk by the deepest overlap, a share of 0.0625";
/// assert_eq!(state.notes(), ["ignored: fx", shrunk]);
/// let run = Simulation::builder(Elastic, Container::closed(9.0, 9.0)?).disks(state.into_disks()).build()?;
/// assert_eq!((run.disks()[0].velocity().x, run.disks()[0].radius()), (3.0, 0.46875));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
/// The next example reads a table of positions alone, for example from a picture:
/// ```
/// # use granular_edmd_files::Reader;
/// let state = Reader::new().with_radius(0.5)?.with_density(2.0)?.read_from("x;y\n1;2\n3;4\n".as_bytes())?;
/// assert_eq!(state.disks()[1].mass(), std::f64::consts::FRAC_PI_2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
/// The last example reads the first frame of a trajectory, and then all frames:
/// ```
/// # use granular_edmd_files::Reader;
/// let frame = "1\nProperties=pos:R:2:radius:R:1 Time=0\n1 2 0.5\n";
/// let frames = frame.to_owned() + &frame.replace("Time=0", "t=1").replace("2 0.5", "3 0.5");
/// assert_eq!(Reader::new().with_frame(0).read_from(frames.as_bytes())?.time(), Some(0.0));
/// let states: Vec<_> = Reader::new().frames(frames.as_bytes())?.collect::<Result<_, _>>()?;
/// assert_eq!((states.len(), states[1].disks()[0].position().y), (2, 3.0));
/// # Ok::<(), granular_edmd_files::ReadError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Reader {
    frame: Choice,
    settings: Settings,
}

/// The choice of the frame to read.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Choice {
    /// The number of the frame, counted from 0, or from the end if negative.
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
        let settings = Settings { tolerance: None, shrinks: false, density: None, radius: None, scale: 1.0 };
        Self { frame: Choice::Number(-1), settings }
    }

    /// Returns the same reader for the frame with this number, counted from 0, or from the end if it is
    /// negative: −1 is the last frame. Other frames are not checked.
    #[must_use]
    pub const fn with_frame(self, number: isize) -> Self {
        Self { frame: Choice::Number(number), ..self }
    }

    /// Returns the same reader for the frame with this step number, as in dumps of LAMMPS and GSD files.
    #[must_use]
    pub const fn with_step(self, step: u64) -> Self {
        Self { frame: Choice::Step(step), ..self }
    }

    /// Returns the same reader with this tolerance for overlaps, relative to the sum of the radii, and for
    /// disks outside the box, relative to the radius.
    ///
    /// A simulation needs disks that do not overlap: see [`with_shrunk_radii`](Self::with_shrunk_radii).
    ///
    /// # Errors
    /// If the tolerance is negative, infinite or NaN.
    pub fn with_tolerance(mut self, tolerance: f64) -> Result<Self, ParameterError> {
        self.settings.tolerance = Some(non_negative("tolerance", tolerance)?);
        Ok(self)
    }

    /// Returns the same reader with all radii shrunk in proportion until no disks overlap.
    ///
    /// This method turns states of soft disks, and files with few digits, into initial states for hard disks.
    /// [`State::shrunk`] says by how much. With a [tolerance](Self::with_tolerance), deeper overlaps remain
    /// an error. Overlaps of more than half the sum of the radii are always an error. Masses do not change.
    #[must_use]
    pub const fn with_shrunk_radii(mut self) -> Self {
        self.settings.shrinks = true;
        self
    }

    /// Returns the same reader, with this mass per area for the disks of a file without masses.
    ///
    /// A GSD file leaves out masses that are all 1; [`State::notes`] says whether the density was used.
    ///
    /// # Errors
    /// If the density is not in `[1e-30, 1e30]`.
    pub fn with_density(mut self, density: f64) -> Result<Self, ParameterError> {
        self.settings.density = Some(scale("density", density)?);
        Ok(self)
    }

    /// Returns the same reader, with this radius for the disks of a file without radii.
    ///
    /// # Errors
    /// If the radius is not in `[1e-30, 1e30]`.
    pub fn with_radius(mut self, radius: f64) -> Result<Self, ParameterError> {
        self.settings.radius = Some(scale("radius", radius)?);
        Ok(self)
    }

    /// Returns the same reader, which multiplies all lengths of the file by this factor: positions, radii,
    /// velocities, gravity and the box. Masses and times stay; a density is a mass per area of the file.
    ///
    /// # Errors
    /// If the factor is not in `[1e-30, 1e30]`.
    pub fn with_scale(mut self, factor: f64) -> Result<Self, ParameterError> {
        self.settings.scale = scale("scale", factor)?;
        Ok(self)
    }

    /// Reads a frame of a file.
    ///
    /// # Errors
    /// The errors of [`read_from`](Self::read_from), and an error if the file cannot be opened. Each error
    /// names the file.
    pub fn read(&self, path: impl AsRef<Path>) -> Result<State, ReadError> {
        let path = path.as_ref();
        let file = File::open(path).map_err(|source| ReadError::Open { path: path.to_owned(), source })?;
        let failed = |source| ReadError::File { path: path.to_owned(), source: Box::new(source) };
        frames_of_file(file).and_then(|frames| self.state(frames)).map_err(failed)
    }

    /// Reads a frame of an input.
    ///
    /// # Errors
    /// If the input cannot be read, is compressed and the feature is missing, is of no known format, or does
    /// not have the frame. Also if a needed part is missing, a number cannot be read or is out of range,
    /// columns contradict each other, or an id appears twice. Also if disks overlap, are outside the box, or
    /// do not lie in a plane. The error names the line.
    pub fn read_from(&self, input: impl BufRead) -> Result<State, ReadError> {
        self.state(frames(input)?)
    }

    fn state(&self, frames: Frames<'_>) -> Result<State, ReadError> {
        disks::state((self.frame.find(frames)?.read)(&self.settings)?, &self.settings)
    }

    /// Returns the states of all frames of an input, one after another. The iterator ends after an error.
    ///
    /// For a file, pass `BufReader::new(File::open(path)?)`.
    ///
    /// # Errors
    /// If the input fails at its start, or is of no known format.
    pub fn frames<'a>(&self, input: impl BufRead + 'a) -> Result<States<'a>, ReadError> {
        Ok(States { frames: Some(frames(input)?), settings: self.settings.clone() })
    }
}

impl Choice {
    /// Finds the frame.
    fn find(self, mut frames: Frames<'_>) -> Result<Found<'_>, ReadError> {
        // The last frames, up to the number that the choice needs.
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
    /// The remaining frames; `None` after an error.
    frames: Option<Frames<'a>>,
    settings: Settings,
}

impl Iterator for States<'_> {
    type Item = Result<State, ReadError>;

    fn next(&mut self) -> Option<Self::Item> {
        let found = self.frames.as_mut()?.next()?;
        let state = found.and_then(|found| disks::state((found.read)(&self.settings)?, &self.settings));
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

/// Returns a radius or a density in the range that a [`Disk`](granular_edmd::Disk) accepts.
fn scale(name: &'static str, value: f64) -> Result<f64, ParameterError> {
    accept((1e-30..=1e30).contains(&positive(name, value)?), name, "in [1e-30, 1e30]", value)
}
