//! The formats of recordings.

use std::path::Path;

use super::recording::{Recording, Start};
use super::{ExtendedXyz, FrameFormat, LammpsDump, RecordError, gsd, one_file, vtk};

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
