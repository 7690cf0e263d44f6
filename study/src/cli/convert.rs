//! The command `convert`: disks from a file of any format, in a file of another.

use std::io;
use std::path::{Path, PathBuf};

use granular_edmd::ParameterError;
use granular_edmd::trajectory::Reader;

use super::files::Ending;
use super::source::tell;
use super::{End, Failure, PlanError};

#[derive(Debug, clap::Args)]
pub(super) struct Wishes {
    /// File to read, recognized by its contents, also compressed: extended XYZ, a dump or a data file of
    /// LAMMPS, GSD, or a table with names of columns. `-` for standard input.
    input: PathBuf,
    /// File to write, by its ending: .xyz, .extxyz, .lammpstrj, .dump, .gsd, .pvd, .csv, .data, .lmp or .vtp;
    /// .xyz.gz and .lammpstrj.gz are compressed. An existing file is not overwritten.
    out: PathBuf,
    /// Frame to read, counted from 0, or from the end if negative; `last` for −1.
    #[arg(long, default_value = "last", allow_negative_numbers = true, value_parser = frame)]
    frame: isize,
    /// Step of the frame to read instead, as dumps and GSD number their frames.
    #[arg(long, conflicts_with = "frame")]
    step: Option<u64>,
    /// Largest overlap that is accepted, relative to the sum of the radii.
    #[arg(long, allow_negative_numbers = true)]
    tolerance: Option<f64>,
    /// Shrinks all radii in proportion until no disks overlap. Overlaps with walls remain, since the file
    /// does not say where walls are.
    #[arg(long)]
    shrink: bool,
    /// Mass per area of disks in a file without masses.
    #[arg(long, allow_negative_numbers = true)]
    density: Option<f64>,
    /// Radius of disks in a file without radii.
    #[arg(long, allow_negative_numbers = true)]
    radius: Option<f64>,
}

/// Reads a frame number.
fn frame(text: &str) -> Result<isize, std::num::ParseIntError> {
    if text == "last" { Ok(-1) } else { text.parse() }
}

impl Wishes {
    fn reader(&self) -> Result<Reader, ParameterError> {
        let reader = Reader::new().with_frame(self.frame);
        let reader = self.step.map_or(reader.clone(), |step| reader.with_step(step));
        let reader = if self.shrink { reader.with_shrunk_radii() } else { reader };
        let reader =
            self.tolerance.map_or(Ok(reader.clone()), |tolerance| reader.with_tolerance(tolerance))?;
        let reader = self.density.map_or(Ok(reader.clone()), |density| reader.with_density(density))?;
        self.radius.map_or(Ok(reader.clone()), |radius| reader.with_radius(radius))
    }
}

/// Converts a file, and reports what is ignored, changed or lost.
pub(super) fn convert(wishes: &Wishes) -> Result<End, Failure> {
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
    Ok(End::Done)
}
