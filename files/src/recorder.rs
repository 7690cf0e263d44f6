//! The formats of recordings, and the observer that records a run.

use std::fmt;
use std::ops::ControlFlow;
use std::path::Path;

use granular_edmd::observable::{Observer, ObserverError, SampleTimes, Snapshot, Verdict};

use super::recording::{Recording, Start};
use super::{ExtendedXyz, Frame, FrameFormat, LammpsDump, RecordError, gsd, one_file, vtk};

/// The format of a recording.
///
/// | value | file | opened by |
/// |---|---|---|
/// | a [`FrameFormat`] ([`ExtendedXyz`], [`LammpsDump`]) | one file, frame after frame | most programs |
/// | [`Gsd`] | one binary file with an index | freud, OVITO, `gsd` |
/// | [`Vtk`] | two files for each frame, and one for the times | ParaView, VTK |
/// | [`ByEnding`] | one of these, by the name of the file | |
///
/// Custom formats implement [`FrameFormat`].
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a format of trajectories",
    label = "a `Format` is expected here",
    note = "take `ByEnding`, `ExtendedXyz`, `LammpsDump`, `Gsd`, `Vtk`, or implement `FrameFormat` for a custom format"
)]
pub trait Format {
    /// Begins a file, or continues it after its last complete frame. Only a recorder calls it.
    ///
    /// # Errors
    /// The errors of [`Recorder::create`](super::Recorder::create) and
    /// [`Recorder::append`](super::Recorder::append).
    fn open(self, path: &Path, start: Start) -> Result<Recording, RecordError>;
}

impl<F: FrameFormat + Send + Sync + 'static> Format for F {
    fn open(self, path: &Path, start: Start) -> Result<Recording, RecordError> {
        one_file::open(path, self, start)
    }
}

impl Format for Gsd {
    fn open(self, path: &Path, start: Start) -> Result<Recording, RecordError> {
        gsd::open(path, start)
    }
}

impl Format for Vtk {
    fn open(self, path: &Path, start: Start) -> Result<Recording, RecordError> {
        vtk::open(path, start)
    }
}

impl Format for ByEnding {
    fn open(self, path: &Path, start: Start) -> Result<Recording, RecordError> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        match name.trim_end_matches(".gz").rsplit_once('.').map(|(_, ending)| ending) {
            Some("xyz" | "extxyz") => ExtendedXyz.open(path, start),
            Some("dump" | "lammpstrj") => LammpsDump.open(path, start),
            Some("gsd") => Gsd.open(path, start),
            Some("pvd") => Vtk.open(path, start),
            _ => {
                let reason =
                    "no format is known for this ending; take .xyz, .extxyz, .dump, .lammpstrj, .gsd or .pvd";
                Err(RecordError::unusable(path, reason))
            }
        }
    }
}

/// GSD, the binary format of HOOMD-blue.
///
/// Readers can go directly to any frame. A frame takes half as many bytes as in [`ExtendedXyz`]. Its numbers
/// are in single precision, so it is meant for analysis: a run that starts from it does not continue with the
/// same bits. Numbers above 3.4e38 become infinite, and angular momenta below 1.2e-38 lose their digits or
/// vanish. The name of the file must not end in `.gz`.
///
/// | chunk | |
/// |---|---|
/// | `particles/typeid`, `types` | number of the [`Kind`](granular_edmd::Kind); its name is the number |
/// | `particles/position` | from the center of the box; in an open box, from the middle of its bottom |
/// | `particles/velocity`, `mass`, `image` | as in [`Disk`](granular_edmd::Disk) |
/// | `particles/diameter` | twice the radius |
/// | `particles/orientation`, `angmom`, `moment_inertia` | rotation about the third axis |
/// | `configuration/step`, `box` | number of the frame; width, height and depth |
/// | `log/particles/id` | id of the disk in the run |
/// | `log/time`, `gravity` (x, y), `center` (x, y) | double precision; positions relative to the center |
/// | `log/domain` | left, right, bottom and top, which may be infinite |
/// | `log/periodic` | 1 for each direction that is periodic, else 0 |
/// | `log/walls/index`, `x`, `y`, `phase` | [moving walls][moving] |
///
/// [moving]: granular_edmd::observable::Snapshot::moving_walls
///
/// The format knows only boxes that are periodic in both directions, and so do its readers. Use
/// `log/periodic` to take walls into account; [`recipes`](crate::guide::recipes) has the lines for freud.
///
/// `gsd.hoomd.read_log` reads all of `log` if the number of disks is constant, and with `scalar_only=True`
/// in any case.
///
/// ```
/// use granular_edmd::prelude::*;
/// use granular_edmd_files::{Gsd, Recorder};
///
/// # let folder = std::env::temp_dir().join(format!("granular-edmd-gsd-{}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// # let path = folder.join("run.gsd");
/// let grain = Disk::new(DVec2::new(2.0, 1.0), 0.5)?.with_velocity(DVec2::X)?;
/// let mut run = Simulation::builder(Elastic, Container::closed(4.0, 4.0)?).disks([grain]).build()?;
///
/// // Let `path` be "run.gsd".
/// let mut recorder = Recorder::create(&path, Gsd, SampleTimes::every(1.0)?)?;
/// run.run_until(3.0, &mut recorder)?;
/// assert_eq!(recorder.times(), [1.0, 2.0, 3.0]);
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
pub struct Gsd;

/// A series of VTK's files, for ParaView.
///
/// A file such as `run.pvd` holds the times. A new folder beside it, here `run`, holds two files for each
/// frame. The first has the disks, as [`State::write_vtk`](super::State::write_vtk) writes them. The second
/// has the edges of the box and the walls in it, such as the parts of a vessel, at their present positions.
/// The name given to the recorder must end in `.pvd`.
///
/// ```
/// use granular_edmd::prelude::*;
/// use granular_edmd_files::{Recorder, Vtk};
///
/// # let folder = std::env::temp_dir().join(format!("granular-edmd-walls-{}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// # let path = folder.join("run.pvd");
/// let drum = Part::drum(DVec2::splat(4.0), 4.0)?.with_rotation(DVec2::splat(4.0), 1.0)?;
/// let vessel = Container::around([("drum", drum)])?;
/// let disks = initial::scattered(&vessel, 10, 0.5, 8.0, 1)?;
/// let mut run = Simulation::builder(Elastic, vessel).disks(disks).build()?;
///
/// // Let `path` be "run.pvd".
/// let mut recorder = Recorder::create(&path, Vtk, SampleTimes::every(1.0)?)?;
/// run.run_until(3.0, &mut recorder)?;
/// assert_eq!(recorder.times(), [1.0, 2.0, 3.0]);
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
pub struct Vtk;

/// The format that the ending of the file's name determines, in upper or lower case.
///
/// | ending | format |
/// |---|---|
/// | `.xyz`, `.extxyz` | [`ExtendedXyz`] |
/// | `.dump`, `.lammpstrj` | [`LammpsDump`] |
/// | `.gsd` | [`Gsd`] |
/// | `.pvd` | [`Vtk`] |
///
/// With the feature `gzip`, `.gz` may follow the ending of a text file.
///
/// ```
/// use granular_edmd::observable::SampleTimes;
/// use granular_edmd_files::{ByEnding, Recorder};
/// let error = Recorder::create("run.png", ByEnding, SampleTimes::every(1.0)?).unwrap_err();
/// let cause = std::error::Error::source(&error).unwrap().to_string();
/// assert!(cause.starts_with("no format is known for this ending; take .xyz, .extxyz, .dump,"));
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
pub struct ByEnding;

/// An observer that writes a frame to a file at set times.
///
/// Each frame is collected completely in memory, and then written. If the writing fails, for example because
/// the file system is full, the run ends with the error ([`verdict`](Observer::verdict)), and the file ends
/// with its last whole frame. The next run with the same recorder records the missed frame.
///
/// [`OfKind`](granular_edmd::observable::OfKind) around a recorder records only the disks of one kind. Files
/// hold the box and the moving walls ([`Snapshot::moving_walls`]). Files for ParaView also hold the other
/// walls ([`Snapshot::wall_lines`]).
///
/// # Continuing a file
/// If the process was killed, resume the run from its checkpoint, and [`append`](Self::append) to its file.
/// The run makes the frames after the checkpoint again, with the same bits. The recorder compares them with
/// the frames in the file and does not write them twice. If they differ, the file belongs to another run, and
/// the error says so. If the process died in the middle of a frame, the next frame overwrites the incomplete
/// one.
///
/// The recorder continues with the first sampling time after the last frame of the file. If the run begins
/// later than that, for example because its checkpoint is newer than the file, the run ends with an error,
/// since frames would be missing. To accept the gap, give `times` a first time after the gap
/// ([`SampleTimes::starting_at`]).
///
/// The times of the frames increase. On Unix, no two recorders write to one file at a time.
///
/// ```
/// use granular_edmd::prelude::*;
/// use granular_edmd_files::{LammpsDump, Recorder};
///
/// # let folder = std::env::temp_dir().join(format!("granular-edmd-recorder-{}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// # let path = folder.join("run.dump");
/// let disk = Disk::new(DVec2::new(2.0, 1.0), 0.5)?.with_velocity(DVec2::X)?;
/// let mut run = Simulation::builder(Elastic, Container::open(4.0)?).disks([disk]).build()?;
/// let times = SampleTimes::every(1.0)?;
/// let mut recorder = Recorder::create(&path, LammpsDump, times)?;
/// run.run_until(3.0, &mut recorder)?;
/// assert!(Recorder::create(&path, LammpsDump, times).is_err(), "nothing is overwritten");
///
/// drop(recorder);
/// let mut recorder = Recorder::append(&path, LammpsDump, times)?;
/// run.run_until(5.0, &mut recorder)?;
/// assert_eq!(recorder.times(), [1.0, 2.0, 3.0, 4.0, 5.0]);
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Recorder {
    clock: SampleTimes,
    recording: Recording,
    /// Bytes of the present frame.
    bytes: Vec<u8>,
    failure: Option<RecordError>,
    /// The clock that the next run restores in order to retry the failed frame.
    before_failure: Option<SampleTimes>,
    /// True for a recorder that continues a file, until a run has followed the last frame of the file without
    /// a gap.
    must_follow: bool,
}

/// Constructors.
impl Recorder {
    /// Creates a recorder that begins a new file.
    ///
    /// With the feature `gzip`, a file of text is compressed if its name ends in `.gz`.
    ///
    /// # Errors
    /// If a file of this name exists, the file cannot be created, its name does not suit the format, or it
    /// ends in `.gz` without the feature `gzip`.
    pub fn create(
        path: impl AsRef<Path>,
        format: impl Format,
        times: SampleTimes,
    ) -> Result<Self, RecordError> {
        Ok(Self::new(format.open(path.as_ref(), Start::New)?, times))
    }

    /// Creates a recorder that continues a file that [`create`](Self::create) began.
    ///
    /// The whole file is read once. For [`Gsd`](super::Gsd) and [`Vtk`](super::Vtk), only the index is read.
    ///
    /// # Errors
    /// If the file cannot be opened, if another recorder writes to it, if it is not of this format, if an
    /// older version wrote it with other columns, or if it has no whole frame. The file then stays unchanged.
    pub fn append(
        path: impl AsRef<Path>,
        format: impl Format,
        times: SampleTimes,
    ) -> Result<Self, RecordError> {
        Ok(Self::new(format.open(path.as_ref(), Start::Old)?, times))
    }

    /// Creates a recorder that continues a file, or begins it if it is absent or empty.
    ///
    /// It suits a run that is restarted automatically after it was killed, perhaps before the first frame.
    ///
    /// # Errors
    /// The errors of [`create`](Self::create) and [`append`](Self::append).
    pub fn create_or_append(
        path: impl AsRef<Path>,
        format: impl Format,
        times: SampleTimes,
    ) -> Result<Self, RecordError> {
        Ok(Self::new(format.open(path.as_ref(), Start::Either)?, times))
    }

    /// Creates the recorder of a file.
    ///
    /// Its clock is in the state after the last frame of the file. A clock that begins anew would mistake a
    /// sampling time just after the start of the run for one at the start, and leave it out. A run in pieces
    /// that was killed between two pieces would then lack a frame.
    fn new(recording: Recording, mut clock: SampleTimes) -> Self {
        if let Some(&last) = recording.times.last() {
            clock.start_at(last);
            clock.advance_past(last);
        }
        let must_follow = !recording.times.is_empty();
        Self { clock, recording, bytes: Vec::new(), failure: None, before_failure: None, must_follow }
    }
}

/// Frames.
impl Recorder {
    /// Returns the times of the frames in the file.
    pub fn times(&self) -> &[f64] {
        &self.recording.times
    }

    /// Records a frame now, for example of the state before a run.
    ///
    /// A run records its first frame after one interval.
    ///
    /// # Errors
    /// If the frame cannot be written, or if the file already reaches this time without having this frame.
    pub fn record(&mut self, snapshot: &Snapshot<'_>) -> Result<(), RecordError> {
        let Recording { file, times, layout } = &mut self.recording;
        let time = snapshot.time();
        let last = times.last().copied().unwrap_or(f64::NEG_INFINITY);
        let is_new = time > last && time.is_finite();
        let there = times.binary_search_by(|other| other.total_cmp(&time));
        let another = |is_there| RecordError::AnotherRun { path: file.path.clone(), time, last, is_there };
        if !is_new && there.is_err() {
            return Err(another(false));
        }
        let (Ok(number) | Err(number)) = there;
        let frame = Frame::new(number, snapshot);
        self.bytes.clear();
        let made = layout.make(&frame, &mut self.bytes);
        made.map_err(RecordError::io("make a frame of", &file.path))?;
        if is_new {
            layout.push(file, &frame, &self.bytes)?;
            times.push(time);
        } else if !layout.has(file, number, &self.bytes)? {
            return Err(another(true));
        }
        Ok(())
    }
}

impl Observer for Recorder {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.clock = self.before_failure.take().unwrap_or(self.clock);
        let (time, missed) = (start.time(), self.clock.upcoming());
        let mut clock = self.clock;
        clock.start_at(time);
        if self.must_follow && missed < clock.upcoming().min(time) {
            let last = self.times().last().copied().unwrap_or(f64::NAN);
            let path = self.recording.file.path.clone();
            return Err(RecordError::Gap { path, last, missed, time }.into());
        }
        (self.clock, self.must_follow) = (clock, false);
        Ok(())
    }

    fn next_sample(&self) -> f64 {
        self.clock.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        if let Err(error) = self.record(snapshot) {
            self.failure = Some(error);
            self.before_failure = Some(self.clock);
        }
        self.clock.advance_past(snapshot.time());
    }

    fn on_end(&mut self, _: &Snapshot<'_>) {
        if self.failure.is_none() {
            // Waits until the system has stored everything.
            let file = &self.recording.file;
            self.failure = file.file.sync_all().map_err(RecordError::io("write to", &file.path)).err();
        }
    }

    #[inline]
    fn verdict(&mut self) -> Verdict {
        self.failure.take().map_or(Ok(ControlFlow::Continue(())), |error| Err(error.into()))
    }
}

impl fmt::Debug for Recorder {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut debug = formatter.debug_struct("Recorder");
        debug
            .field("path", &self.recording.file.path)
            .field("frames", &self.times().len())
            .finish_non_exhaustive()
    }
}
