//! The observer that records a run.

use std::fmt;
use std::ops::ControlFlow;
use std::path::Path;

use granular_edmd::observable::{Observer, ObserverError, SampleTimes, Snapshot, Verdict};

use super::recording::{Recording, Start};
use super::{Format, Frame, RecordError};

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
