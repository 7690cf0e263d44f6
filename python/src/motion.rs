//! Motions of walls.

use edmd::wall::{
    BiParabolic, Combined, Fixed, KnownMotion, Piston, Sawtooth, Sinusoidal, Tabulated, Triangular,
    WallMotion,
};
use pyo3::prelude::*;

use crate::data::{Data, data_class, described, from_data, to_data};
use crate::errors::invalid;

/// The motion of a wall or a part: a displacement (length) over time, 0 at rest.
///
/// `a + b` adds two motions. `BiParabolic(0.1, 10.0)` and the like create one.
#[pyclass(name = "Motion", module = "granular_edmd", frozen, from_py_object)]
#[derive(Clone)]
pub(crate) struct Motion(pub(crate) KnownMotion);

impl Motion {
    fn combined(&self) -> Combined {
        Combined::new(self.0.clone())
    }
}

impl Data for Motion {
    fn data<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_data(py, &self.0)
    }
    fn of_data(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        from_data(data).map(Self)
    }
}

data_class!(Motion);

#[pymethods]
impl Motion {
    /// Returns the motion times a factor.
    fn scaled(&self, factor: f64) -> PyResult<Self> {
        self.combined().scaled(factor).map(|motion| Self(motion.into())).map_err(invalid)
    }
    /// Returns the same motion with its phase 0 at this time.
    fn starting_at(&self, time: f64) -> PyResult<Self> {
        self.combined().starting_at(time).map(|motion| Self(motion.into())).map_err(invalid)
    }
    /// Returns the motion that rests until this time, and then begins with phase 0.
    fn delayed_until(&self, time: f64) -> PyResult<Self> {
        self.combined().delayed_until(time).map(|motion| Self(motion.into())).map_err(invalid)
    }
    fn __add__(&self, other: &Self) -> PyResult<Self> {
        self.combined().plus(other.0.clone()).map(|motion| Self(motion.into())).map_err(invalid)
    }
    /// Returns the displacement (length) and the velocity (length/time) at a time.
    fn state(&self, time: f64) -> (f64, f64) {
        let state = self.0.state(time);
        (state.displacement, state.velocity)
    }
    /// The period (time), or `None`.
    #[getter]
    fn period(&self) -> Option<f64> {
        self.0.period()
    }
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        described(&self.data(py)?)
    }
}

/// Creates functions of an amplitude (length) and an angular frequency (1/time).
macro_rules! oscillations {
    ($($function:ident, $motion:ident, $name:literal, $what:literal;)+) => {$(
        #[doc = $what]
        ///
        /// The amplitude has the unit of a length, the angular frequency of 1/time.
        #[pyfunction]
        #[pyo3(name = $name)]
        pub(crate) fn $function(amplitude: f64, angular_frequency: f64) -> PyResult<Motion> {
            $motion::new(amplitude, angular_frequency).map(|motion| Motion(motion.into())).map_err(invalid)
        }
    )+};
}

oscillations! {
    bi_parabolic, BiParabolic, "BiParabolic", "Returns the motion in pieces of parabolas of the paper.";
    sinusoidal, Sinusoidal, "Sinusoidal", "Returns a sinusoidal motion.";
    triangular, Triangular, "Triangular", "Returns a motion of constant speed up and down.";
    sawtooth, Sawtooth, "Sawtooth", "Returns a motion that rises at constant speed and jumps down.";
}

/// Returns the motion of a wall at rest.
#[pyfunction]
#[pyo3(name = "Fixed")]
pub(crate) fn fixed() -> Motion {
    Motion(Fixed.into())
}

/// Returns a motion through the points of a table of (time, displacement), in straight lines.
#[pyfunction]
#[pyo3(name = "Tabulated")]
pub(crate) fn tabulated(rows: Vec<(f64, f64)>) -> PyResult<Motion> {
    Tabulated::new(rows).map(|motion| Motion(motion.into())).map_err(invalid)
}

/// A wall with a mass, which moves freely between two stops and is hit by disks.
///
/// Displacements are from the place of the wall, positive toward the disks: downward for a lid. Gravity does
/// not act on it: a lid of mass M under gravity g needs `force=M * g`. `FreeWall("lid")` measures its motion.
#[pyclass(name = "Piston", module = "granular_edmd", frozen, from_py_object)]
#[derive(Clone)]
pub(crate) struct PyPiston(pub(crate) Piston);

#[pymethods]
impl PyPiston {
    /// Creates a piston.
    ///
    /// `stops` are its smallest and largest displacement (length). `force` (mass length/time²) pushes it
    /// toward the disks. `spring` is a pair: stiffness (mass/time²), and the displacement at which it exerts
    /// no force. `start` is a pair (displacement, velocity).
    #[new]
    #[pyo3(signature = (mass, stops, *, force=None, spring=None, start=None))]
    fn new(
        mass: f64,
        stops: [f64; 2],
        force: Option<f64>,
        spring: Option<(f64, f64)>,
        start: Option<(f64, f64)>,
    ) -> PyResult<Self> {
        let mut piston = Piston::new(mass, stops).map_err(invalid)?;
        if let Some(force) = force {
            piston = piston.with_force(force).map_err(invalid)?;
        }
        if let Some((stiffness, center)) = spring {
            piston = piston.with_spring(stiffness, center).map_err(invalid)?;
        }
        if let Some((displacement, velocity)) = start {
            piston = piston.with_start(displacement, velocity).map_err(invalid)?;
        }
        Ok(Self(piston))
    }
    fn __repr__(&self) -> String {
        format!("Piston(mass={}, stops={:?})", self.0.mass(), self.0.stops())
    }
}
