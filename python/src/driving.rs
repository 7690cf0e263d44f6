//! Drivings: kicks of all disks at set times; and inlets.

use edmd::observable::SampleTimes;
use edmd::simulation::{Driving, Inlet, Rescaling, WhiteNoise};
use edmd::{Disk, Kind, ParameterError};
use pyo3::prelude::*;

use crate::arguments::{Every, Pair, vector};
use crate::disks::Disks;
use crate::errors::{call, invalid};

pub(crate) type BoxedDriving = Box<dyn Driving + Send + Sync>;

/// A driving of runs: give it to `run_until(…, drive=…)`. The next run continues it.
#[pyclass(name = "Driving", module = "granular_edmd")]
pub(crate) struct PyDriving(pub(crate) Option<BoxedDriving>);

impl PyDriving {
    fn of(driving: impl Driving + Send + Sync + 'static) -> Self {
        Self(Some(Box::new(driving)))
    }
}

/// Returns random kicks at equal intervals: `noise` is the growth of each component of the velocity, squared,
/// per time (length²/time³), and `rotational_noise` that of the spin.
#[pyfunction]
#[pyo3(name = "WhiteNoise", signature = (noise, every, seed, *, rotational_noise=0.0))]
pub(crate) fn white_noise(noise: f64, every: Every, seed: u64, rotational_noise: f64) -> PyResult<PyDriving> {
    let driving = WhiteNoise::new(noise, every.0, seed);
    driving
        .and_then(|driving| driving.with_rotational_noise(rotational_noise))
        .map(PyDriving::of)
        .map_err(invalid)
}

/// Returns a driving that scales all velocities to a temperature (energy) at set times.
#[pyfunction]
#[pyo3(name = "Rescaling")]
pub(crate) fn rescaling(temperature: f64, every: Every) -> PyResult<PyDriving> {
    Rescaling::new(temperature, every.0).map(PyDriving::of).map_err(invalid)
}

/// Returns a driving by a function, which gets the disks and returns them with other velocities.
#[pyfunction]
#[pyo3(name = "Kick")]
pub(crate) fn kick(function: Py<PyAny>, every: Every) -> PyDriving {
    PyDriving::of(Kick { function, times: every.0 })
}

/// A driving in Python.
struct Kick {
    function: Py<PyAny>,
    times: SampleTimes,
}

impl Driving for Kick {
    fn times(&mut self) -> &mut SampleTimes {
        &mut self.times
    }
    fn kick(&mut self, disks: &mut [Disk]) -> Result<(), ParameterError> {
        let before = Disks(disks.to_vec());
        let kicked = call(|py| Ok(self.function.call1(py, (before,))?.extract::<Disks>(py)?));
        let count = kicked.as_ref().map_or(f64::NAN, |kicked| kicked.0.len() as f64);
        match kicked {
            Some(kicked) if kicked.0.len() == disks.len() => {
                disks.copy_from_slice(&kicked.0);
                Ok(())
            }
            _ => Err(ParameterError::new("number of kicked disks", format!("{}", disks.len()), count)),
        }
    }
}

/// An inlet: it lets disks into a run at set times, at random positions in a rectangle.
///
/// Give it to `add_inlet` of a simulation.
#[pyclass(name = "Inlet", module = "granular_edmd", frozen)]
#[derive(Clone)]
pub(crate) struct PyInlet(pub(crate) Inlet);

#[pymethods]
impl PyInlet {
    /// Creates an inlet that lets in a copy of one of the disks, drawn at random, at each of the times.
    ///
    /// The rectangle is given by its lower left and its upper right corner (length).
    #[new]
    fn new(corners: (Pair, Pair), disks: &Disks, every: Every, seed: u64) -> PyResult<Self> {
        let places = [vector(corners.0), vector(corners.1)];
        Inlet::new(places, disks.0.iter().copied(), every.0, seed).map(Self).map_err(invalid)
    }
    /// Creates an inlet that puts back the disks that sinks have removed, at this velocity (length/time).
    #[staticmethod]
    fn refill(corners: (Pair, Pair), velocity: Pair, every: Every, seed: u64) -> PyResult<Self> {
        let places = [vector(corners.0), vector(corners.1)];
        Inlet::refill(places, vector(velocity), every.0, seed).map(Self).map_err(invalid)
    }
    /// Returns the same inlet, whose disks all enter with this kind.
    fn with_kind(&self, kind: u16) -> Self {
        Self(self.0.clone().with_kind(Kind::new(kind)))
    }
    /// The number of disks that wait for room or for the next opening.
    #[getter]
    fn waiting(&self) -> usize {
        self.0.waiting()
    }
}
