//! The observer that records a run.

use std::fmt;
use std::path::Path;

use super::gsd::{HoomdSchema, Indexed};
use super::media;
use super::one_file::OneFile;
use super::store::Store;
use super::vtk::{PolyData, Series};
use super::{Format, Frame, RecordError};
use crate::observable::{Observer, SampleTimes, Snapshot, Verdict, verdict};

/// An observer that writes a frame to a file at set times.
///
/// Each frame is made whole in memory, then written. If that fails, for example because the file system is
/// full, the run ends with the error ([`verdict`](Observer::verdict)), and the file ends with its last whole
/// frame. The next run with the same recorder takes the frame that was missed.
///
/// [`OfKind`](crate::observable::OfKind) around a recorder records only the disks of one kind. Files hold the
/// box. Files for ParaView also hold the walls of the run's boundary as they are at each frame
/// ([`Snapshot::wall_lines`]).
///
/// # Going on in a file
/// After a kill, resume the run from its checkpoint, and [`append`](Self::append) to its file. The run makes
/// the frames after the checkpoint again, with the same bits. The recorder compares them with those in the
/// file and does not write them twice. If they differ, the file is of another run, and the error says so. If
/// the process died in the middle of a frame, the next frame overwrites the torn one.
///
/// The recorder continues with the first beat after the last frame of the file. If the run is later than that
/// beat, as from a checkpoint that is newer than the file, the run ends with an error, since frames would be
/// missing. If you want the gap, give `times` a first time after it ([`SampleTimes::starting_at`]).
///
/// The times of the frames increase. On Unix, no two recorders write to one file at a time.
///
/// ```
/// use granular_edmd::prelude::*;
/// use granular_edmd::trajectory::{LammpsDump, Recorder};
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
    format: Box<dyn Format + Send + Sync>,
    store: Box<dyn Store + Send + Sync>,
    /// Bytes of the present frame.
    bytes: Vec<u8>,
    failure: Option<RecordError>,
    /// Clock to restore so that the next run retries the failed frame.
    before_failure: Option<SampleTimes>,
    /// True for a recorder that continues a file, until a run continues it without a gap.
    must_follow: bool,
}

/// Constructors.
impl Recorder {
    /// Creates a recorder that begins a new file.
    ///
    /// With the feature `gzip`, the file is compressed if its name ends in `.gz`.
    ///
    /// # Errors
    /// If a file of this name exists, the file cannot be created, or its name ends in `.gz` without the
    /// feature `gzip`.
    pub fn create(
        path: impl AsRef<Path>,
        format: impl Format + Send + Sync + 'static,
        times: SampleTimes,
    ) -> Result<Self, RecordError> {
        Ok(Self::new(format, OneFile::create(path.as_ref())?, times))
    }

    /// Creates a recorder that continues a file that [`create`](Self::create) began.
    ///
    /// It reads the whole file once.
    ///
    /// # Errors
    /// If the file cannot be opened, another recorder writes to it, it is not of this format, or it has no
    /// whole frame. The file is then left as it is.
    pub fn append(
        path: impl AsRef<Path>,
        format: impl Format + Send + Sync + 'static,
        times: SampleTimes,
    ) -> Result<Self, RecordError> {
        let store = OneFile::reopen(path.as_ref(), &format)?;
        Ok(Self::new(format, store, times).going_on())
    }

    /// Creates a recorder that continues a file, or begins one that is absent or empty.
    ///
    /// It suits a run that starts itself again after a kill, which may have come before the first frame.
    ///
    /// # Errors
    /// The same as for [`create`](Self::create) and [`append`](Self::append).
    pub fn create_or_append(
        path: impl AsRef<Path>,
        format: impl Format + Send + Sync + 'static,
        times: SampleTimes,
    ) -> Result<Self, RecordError> {
        let path = path.as_ref();
        match path.metadata() {
            Ok(file) if file.len() > 0 => Self::append(path, format, times),
            Ok(_) => Ok(Self::new(format, OneFile::begin_in(path)?, times)),
            Err(_) => Self::create(path, format, times),
        }
    }

    /// Creates a recorder that begins a binary file of GSD, with the schema of HOOMD-blue.
    ///
    /// Readers go to any frame at once. A frame has half of the bytes of [`ExtendedXyz`](super::ExtendedXyz),
    /// with numbers in single precision, so it is for analysis: a run cannot start from it as if it had not
    /// stopped.
    ///
    /// | chunk | |
    /// |---|---|
    /// | `particles/typeid`, `types` | number of the [`Kind`](crate::Kind); its name is the number |
    /// | `particles/position` | from the center of the box; of an open box, from the middle of its bottom |
    /// | `particles/velocity`, `mass`, `image` | as in [`Disk`](crate::Disk) |
    /// | `particles/diameter` | twice the radius |
    /// | `particles/orientation`, `angmom`, `moment_inertia` | rotation about the third axis |
    /// | `configuration/step`, `box` | number of the frame; width, height and depth |
    /// | `log/time`, `gravity`, `center` | in double precision; where positions count from |
    ///
    /// # Errors
    /// If a file of this name exists, the file cannot be created, or its name ends in `.gz`.
    pub fn create_gsd(path: impl AsRef<Path>, times: SampleTimes) -> Result<Self, RecordError> {
        Ok(Self::new(HoomdSchema, Indexed::create(path.as_ref())?, times))
    }

    /// Creates a recorder that continues a file that [`create_gsd`](Self::create_gsd) began.
    ///
    /// # Errors
    /// If the file cannot be opened, another recorder writes to it, it is not of this kind, or it has no
    /// whole frame. The file is then left as it is.
    pub fn append_gsd(path: impl AsRef<Path>, times: SampleTimes) -> Result<Self, RecordError> {
        Ok(Self::new(HoomdSchema, Indexed::reopen(path.as_ref())?, times).going_on())
    }

    /// Creates a recorder that begins a series of files for ParaView.
    ///
    /// A file such as `run.pvd` holds the times. A new folder beside it, here `run`, holds two files for each
    /// frame: the disks, as [`State::write_vtk`](super::State::write_vtk) writes them, and the edges of the
    /// box with the walls in it, such as the parts of a vessel.
    ///
    /// ```
    /// use granular_edmd::prelude::*;
    /// use granular_edmd::trajectory::Recorder;
    ///
    /// # let folder = std::env::temp_dir().join(format!("granular-edmd-walls-{}", std::process::id()));
    /// # std::fs::create_dir_all(&folder)?;
    /// # let path = folder.join("run.pvd");
    /// let drum = Part::drum(DVec2::splat(4.0), 4.0)?.with_rotation(DVec2::splat(4.0), 1.0)?;
    /// let vessel = Vessel::around([("drum", drum)])?;
    /// let disks = initial::random(&vessel, 10, 0.5, 8.0, 1)?;
    /// let mut run = Simulation::builder(Elastic, vessel).disks(disks).build()?;
    ///
    /// // Let `path` be "run.pvd".
    /// let mut recorder = Recorder::create_vtk(&path, SampleTimes::every(1.0)?)?;
    /// run.run_until(3.0, &mut recorder)?;
    /// assert_eq!(recorder.times(), [1.0, 2.0, 3.0]);
    /// # std::fs::remove_dir_all(&folder)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the path does not end in `.pvd`, a file or a folder of these names exists, or they cannot be
    /// created.
    pub fn create_vtk(path: impl AsRef<Path>, times: SampleTimes) -> Result<Self, RecordError> {
        Ok(Self::new(PolyData, Series::create(path.as_ref())?, times))
    }

    /// Creates a recorder that continues a series that [`create_vtk`](Self::create_vtk) began.
    ///
    /// # Errors
    /// If the files cannot be opened, another recorder writes to them, or they are not such a series. They
    /// are then left as they are.
    pub fn append_vtk(path: impl AsRef<Path>, times: SampleTimes) -> Result<Self, RecordError> {
        Ok(Self::new(PolyData, Series::reopen(path.as_ref())?, times).going_on())
    }

    fn new(
        format: impl Format + Send + Sync + 'static,
        store: impl Store + Send + Sync + 'static,
        clock: SampleTimes,
    ) -> Self {
        Self {
            clock,
            format: Box::new(format),
            store: Box::new(store),
            bytes: Vec::new(),
            failure: None,
            before_failure: None,
            must_follow: false,
        }
    }

    /// Returns the same recorder, with its clock as it was after the last frame of the file.
    ///
    /// A clock that begins anew would take a beat just after the start of the run for a beat on the start,
    /// and leave it out. Then a run in pieces that was killed between two of them would lack a frame.
    fn going_on(mut self) -> Self {
        if let Some(&last) = self.times().last() {
            self.clock.start_at(last);
            self.clock.advance_past(last);
        }
        Self { must_follow: true, ..self }
    }
}

/// Frames.
impl Recorder {
    /// Returns the times of the frames in the file.
    pub fn times(&self) -> &[f64] {
        self.store.times()
    }

    fn path(&self) -> &Path {
        &self.store.file().path
    }

    /// Records a frame now, for example of the state before a run.
    ///
    /// A run records its first frame after one interval.
    ///
    /// # Errors
    /// If the frame cannot be written, or the file reaches this time already and does not have this frame.
    pub fn record(&mut self, snapshot: &Snapshot<'_>) -> Result<(), RecordError> {
        let time = snapshot.time();
        let last = self.times().last().copied().unwrap_or(f64::NEG_INFINITY);
        if time <= last || !time.is_finite() {
            return self.compare(snapshot, last);
        }
        self.write_frame(self.times().len(), snapshot)?;
        self.store.append(snapshot, &self.bytes)
    }

    /// Checks that the file has this frame.
    fn compare(&mut self, snapshot: &Snapshot<'_>, last: f64) -> Result<(), RecordError> {
        let time = snapshot.time();
        let number = self.times().binary_search_by(|other| other.total_cmp(&time));
        let is_same = match number {
            Ok(number) => {
                self.write_frame(number, snapshot)?;
                self.store.has(number, &self.bytes)?
            }
            Err(_) => false,
        };
        if is_same {
            return Ok(());
        }
        let (path, is_there) = (self.path().to_owned(), number.is_ok());
        Err(RecordError::AnotherRun { path, time, last, is_there })
    }

    /// Makes the bytes of a frame.
    fn write_frame(&mut self, number: usize, snapshot: &Snapshot<'_>) -> Result<(), RecordError> {
        self.bytes.clear();
        let made = self.format.write_frame(&Frame::new(number, snapshot), &mut self.bytes);
        made.map_err(RecordError::io("make a frame of", self.path()))
    }
}

impl Observer for Recorder {
    fn on_start(&mut self, start: &Snapshot<'_>) {
        self.clock = self.before_failure.take().unwrap_or(self.clock);
        let (time, missed) = (start.time(), self.clock.upcoming());
        let mut clock = self.clock;
        clock.start_at(time);
        if self.must_follow && missed < clock.upcoming().min(time) {
            let last = self.times().last().copied().unwrap_or(f64::NAN);
            self.failure = Some(RecordError::Gap { path: self.path().to_owned(), last, missed, time });
            return;
        }
        (self.clock, self.must_follow) = (clock, false);
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
            self.failure = media::sync(self.store.file()).err();
        }
    }

    #[inline]
    fn verdict(&mut self) -> Verdict {
        verdict(&mut self.failure)
    }
}

impl fmt::Debug for Recorder {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut debug = formatter.debug_struct("Recorder");
        debug.field("path", &self.path()).field("frames", &self.times().len()).finish_non_exhaustive()
    }
}
