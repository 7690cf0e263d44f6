//! The command `convert`, and the file formats for disks, which follow from the endings of file names.

use std::f64::consts::PI;
use std::io;
use std::path::Path;

use granular_edmd::observable::SampleTimes;
use granular_edmd::{Disk, ParameterError};
use granular_edmd_files::{ByEnding, ExtendedXyz, Frame, FrameFormat, LammpsDump, Reader, Recorder, State};

use super::arguments::Convert;
use super::{Failure, PlanError, tell, write_new};

impl Convert {
    fn reader(&self) -> Result<Reader, ParameterError> {
        let reader = Reader::new().with_frame(self.frame);
        let reader = self.step.map_or(reader.clone(), |step| reader.with_step(step));
        let reader = if self.shrink { reader.with_shrunk_radii() } else { reader };
        let reader =
            self.tolerance.map_or(Ok(reader.clone()), |tolerance| reader.with_tolerance(tolerance))?;
        let reader = self.scale.map_or(Ok(reader.clone()), |factor| reader.with_scale(factor))?;
        let reader = self.density.map_or(Ok(reader.clone()), |density| reader.with_density(density))?;
        self.radius.map_or(Ok(reader.clone()), |radius| reader.with_radius(radius))
    }
}

/// Converts a file, and reports what is ignored, changed or lost.
pub(super) fn convert(wishes: &Convert) -> Result<(), Failure> {
    let ending = Ending::need(&wishes.out, |_| true)?;
    let reader = wishes.reader().map_err(PlanError::from)?;
    let state = match &wishes.input {
        path if path == Path::new("-") => reader.read_from(io::stdin().lock())?,
        path => reader.read(path)?,
    };
    ending.write(&wishes.out, &state)?;
    state.notes().iter().for_each(|note| tell(note));
    if state.domain().is_none() && ending != Ending::Csv {
        tell(&format!("{} has no box, and gets the rectangle around its disks", wishes.out.display()));
    }
    let lost = ending.lost(&state);
    if !lost.is_empty() {
        tell(&format!("{} has no place for the {} of the file", wishes.out.display(), lost.join(", ")));
    }
    Ok(())
}

/// A file format for disks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ending {
    Csv,
    Data,
    Dump,
    Gsd,
    Pvd,
    Vtp,
    Xyz,
}

/// Endings of file names.
const ENDINGS: [(&str, Ending); 10] = [
    ("xyz", Ending::Xyz),
    ("extxyz", Ending::Xyz),
    ("lammpstrj", Ending::Dump),
    ("dump", Ending::Dump),
    ("gsd", Ending::Gsd),
    ("pvd", Ending::Pvd),
    ("csv", Ending::Csv),
    ("data", Ending::Data),
    ("lmp", Ending::Data),
    ("vtp", Ending::Vtp),
];

impl Ending {
    /// Returns the format of a file from the ending of its name. A text trajectory may be compressed.
    fn of(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?.to_ascii_lowercase();
        let (name, is_packed) = name.strip_suffix(".gz").map_or((name.as_str(), false), |name| (name, true));
        let (_, found) = ENDINGS
            .into_iter()
            .find(|(ending, _)| name.strip_suffix(ending).is_some_and(|stem| stem.ends_with('.')))?;
        (!is_packed || matches!(found, Self::Xyz | Self::Dump)).then_some(found)
    }

    /// Returns the format of a file, or an error if the ending of its name is not accepted.
    pub(super) fn need(path: &Path, accepts: impl Fn(Self) -> bool) -> Result<Self, PlanError> {
        Self::of(path).filter(|&ending| accepts(ending)).ok_or_else(|| {
            let accepted = ENDINGS.iter().filter(|(_, ending)| accepts(*ending));
            let names: Vec<String> = accepted.map(|(ending, _)| format!(".{ending}")).collect();
            PlanError::Refused(format!("{} must end in one of {}", path.display(), names.join(", ")))
        })
    }

    /// Returns whether a file of the format can have many frames.
    pub(super) const fn is_trajectory(self) -> bool {
        matches!(self, Self::Xyz | Self::Dump | Self::Gsd | Self::Pvd)
    }

    /// Returns `state` encoded in this format, or `None` if the format is not plain text or the file is
    /// compressed.
    fn text(self, path: &Path, state: &State) -> Option<io::Result<Vec<u8>>> {
        if path.extension().is_some_and(|ending| ending == "gz") {
            return None;
        }
        let (snapshot, mut bytes) = (state.snapshot(), Vec::new());
        let frame = Frame::new(0, &snapshot);
        let written = match self {
            Self::Csv => state.write_csv(&mut bytes),
            Self::Data => state.write_lammps_data(&mut bytes),
            Self::Vtp => state.write_vtk(&mut bytes),
            Self::Xyz => ExtendedXyz.write_frame(&frame, &mut bytes),
            Self::Dump => LammpsDump.write_frame(&frame, &mut bytes),
            Self::Gsd | Self::Pvd => return None,
        };
        Some(written.map(|()| bytes))
    }

    /// Writes a state to a new file.
    pub(super) fn write(self, path: &Path, state: &State) -> Result<(), Failure> {
        if self.is_trajectory() {
            Recorder::create(path, ByEnding, SampleTimes::every(1.0)?)?.record(&state.snapshot())?;
            return Ok(());
        }
        let bytes = self.text(path, state).transpose()?.unwrap_or_default();
        write_new(path, &bytes)
    }

    /// Returns the names of the state's data that the format cannot hold.
    fn lost(self, state: &State) -> Vec<&'static str> {
        let has_gravity = state.gravity().is_some_and(|gravity| gravity.strength() > 0.0);
        let any = |has: fn(&Disk) -> bool| state.disks().iter().any(has);
        let is_lammps = matches!(self, Self::Dump | Self::Data);
        let is_single = |number: f64| f64::from(number as f32) == number;
        let has_digits = state.disks().iter().any(|disk| {
            let (position, velocity) = (disk.position(), disk.velocity());
            let numbers = [position.x, position.y, velocity.x, velocity.y, disk.radius(), disk.mass()];
            !numbers.into_iter().all(is_single)
        });
        let keeps_time = self != Self::Csv;
        let keeps_gravity = matches!(self, Self::Xyz | Self::Gsd);
        let parts = [
            (self == Self::Csv && state.domain().is_some(), "box"),
            (!keeps_time && state.time().is_some(), "time"),
            (!keeps_gravity && has_gravity, "gravity"),
            (!state.kind_names().is_empty(), "names of kinds"),
            (is_lammps && any(|disk| disk.inertia_factor() != 0.5), "inertia factors"),
            (self == Self::Data && any(|disk| disk.angle() != 0.0), "angles"),
            (self == Self::Gsd && any(|disk| disk.angle().abs() > PI), "whole turns of angles"),
            (self == Self::Gsd && has_digits, "digits beyond single precision"),
        ];
        parts.into_iter().filter(|(is_lost, _)| *is_lost).map(|(_, name)| name).collect()
    }
}
