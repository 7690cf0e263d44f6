//! Files of this and of other programs.

use std::fs::{File, OpenOptions};
use std::io::{self, BufReader};
use std::path::PathBuf;

use edmd::observable::SampleTimes;
use edmd_files::{ByEnding, Reader, Recorder, State};
use pyo3::prelude::*;

use crate::arguments::Pair;
use crate::disks::{Disks, disk_columns};
use crate::errors::{FileError, invalid, unreadable};

/// The disks of a file, with what else it says. Its columns are arrays, as those of `Disks`.
#[pyclass(name = "State", module = "granular_edmd", frozen)]
pub(crate) struct PyState(State);

impl PyState {
    fn list(&self) -> &[edmd::Disk] {
        self.0.disks()
    }
}

disk_columns!(PyState);

#[pymethods]
impl PyState {
    /// The disks.
    #[getter]
    fn disks(&self) -> Disks {
        Disks(self.0.disks().to_vec())
    }
    /// The time, or `None` if the file has none.
    #[getter]
    fn time(&self) -> Option<f64> {
        self.0.time()
    }
    /// The gravity vector (length/time²), or `None` if the file has none.
    #[getter]
    fn gravity(&self) -> Option<Pair> {
        self.0.gravity().map(|gravity| gravity.acceleration().into())
    }
    /// The rectangle of the box: (left, right, bottom, top), or `None` if the file has none.
    #[getter]
    fn domain(&self) -> Option<(f64, f64, f64, f64)> {
        self.0.domain().map(|domain| (domain.left, domain.right, domain.bottom, domain.top))
    }
    /// What was assumed, in sentences.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.0.notes()
    }
    /// Writes the state to a new file; the ending of its name is the format: `.csv`, `.data` (LAMMPS) or
    /// `.vtp` (VTK).
    fn write(&self, path: PathBuf) -> PyResult<()> {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let write: fn(&State, File) -> io::Result<()> = match ending {
            "csv" => State::write_csv,
            "data" => State::write_lammps_data,
            "vtp" => State::write_vtk,
            _ => {
                let message =
                    format!("{}: a name that ends in .csv, .data or .vtp is needed", path.display());
                return Err(FileError::new_err(message));
            }
        };
        let file = OpenOptions::new().write(true).create_new(true).open(&path);
        file.and_then(|file| write(&self.0, file)).map_err(unreadable)
    }
}

/// Returns a reader with these options.
fn reader(
    frame: isize,
    radius: Option<f64>,
    density: Option<f64>,
    scale: Option<f64>,
    shrink: bool,
) -> PyResult<Reader> {
    let mut reader = Reader::new().with_frame(frame);
    if let Some(radius) = radius {
        reader = reader.with_radius(radius).map_err(invalid)?;
    }
    if let Some(density) = density {
        reader = reader.with_density(density).map_err(invalid)?;
    }
    if let Some(scale) = scale {
        reader = reader.with_scale(scale).map_err(invalid)?;
    }
    Ok(if shrink { reader.with_shrunk_radii() } else { reader })
}

/// Reads a state from a file of this or of another program, whose format is found by its contents.
///
/// `frame` is the number of the frame, from the end if it is negative. `radius` (length) and `density`
/// (mass/length²) are for files without radii or masses, `scale` multiplies all lengths, and `shrink` shrinks
/// radii until disks no longer overlap.
#[pyfunction]
#[pyo3(signature = (path, *, frame=-1, radius=None, density=None, scale=None, shrink=false))]
pub(crate) fn read(
    path: PathBuf,
    frame: isize,
    radius: Option<f64>,
    density: Option<f64>,
    scale: Option<f64>,
    shrink: bool,
) -> PyResult<PyState> {
    reader(frame, radius, density, scale, shrink)?.read(path).map(PyState).map_err(unreadable)
}

/// Reads all frames of a trajectory.
#[pyfunction]
pub(crate) fn frames(path: PathBuf) -> PyResult<Vec<PyState>> {
    let file = File::open(path).map(BufReader::new).map_err(unreadable)?;
    let frames = Reader::new().frames(file).map_err(unreadable)?;
    frames.map(|frame| frame.map(PyState).map_err(unreadable)).collect()
}

/// Writes all frames of a trajectory to a new one, in the format of the ending of its name. Returns their
/// number.
#[pyfunction]
pub(crate) fn convert(source: PathBuf, target: PathBuf) -> PyResult<usize> {
    let file = File::open(source).map(BufReader::new).map_err(unreadable)?;
    let times = SampleTimes::every(1.0).map_err(invalid)?;
    let mut recorder = Recorder::create(target, ByEnding, times).map_err(unreadable)?;
    for frame in Reader::new().frames(file).map_err(unreadable)? {
        recorder.record(&frame.map_err(unreadable)?.snapshot()).map_err(unreadable)?;
    }
    Ok(recorder.times().len())
}
