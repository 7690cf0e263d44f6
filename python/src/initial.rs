//! Initial states, with the names that they have in Rust.

use edmd::initial::{self, Radii};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::arguments::{Column, to_array};
use crate::boundary::PyContainer;
use crate::disks::Disks;
use crate::errors::{ParameterError, invalid};

/// Creates functions of a container, a number of disks and their radius.
macro_rules! lattices {
    ($($function:ident, $what:literal;)+) => {$(
        #[doc = $what]
        ///
        /// The disks are at rest and have the mass 1.
        #[pyfunction]
        pub(crate) fn $function(boundary: &PyContainer, count: usize, radius: f64) -> PyResult<Disks> {
            initial::$function(&boundary.0, count, radius).map(Disks).map_err(invalid)
        }
    )+};
}

lattices! {
    lattice, "Returns equal disks on a lattice from the floor upward.";
    triangular_lattice, "Returns equal disks on a triangular lattice, as close as possible.";
    even_lattice, "Returns equal disks on a lattice that fills the container evenly.";
}

/// Returns equal disks at random positions below a height (length).
#[pyfunction]
pub(crate) fn scattered(
    boundary: &PyContainer,
    count: usize,
    radius: f64,
    below: f64,
    seed: u64,
) -> PyResult<Disks> {
    initial::scattered(&boundary.0, count, radius, below, seed).map(Disks).map_err(invalid)
}

/// Returns these disks at random positions below a height (length).
#[pyfunction]
pub(crate) fn scattered_mix(boundary: &PyContainer, disks: &Disks, below: f64, seed: u64) -> PyResult<Disks> {
    initial::scattered_mix(&boundary.0, disks.0.clone(), below, seed).map(Disks).map_err(invalid)
}

/// Returns these disks in a dense random packing below a height (length).
#[pyfunction]
pub(crate) fn packed_mix(
    py: Python<'_>,
    boundary: &PyContainer,
    disks: &Disks,
    below: f64,
    seed: u64,
) -> PyResult<Disks> {
    let (boundary, disks) = (boundary.0.clone(), disks.0.clone());
    py.detach(|| initial::packed_mix(&boundary, disks, below, seed)).map(Disks).map_err(invalid)
}

/// Returns these disks in rows from the floor upward.
#[pyfunction]
pub(crate) fn placed_in_rows(boundary: &PyContainer, disks: &Disks) -> PyResult<Disks> {
    initial::placed_in_rows(&boundary.0, disks.0.clone()).map(Disks).map_err(invalid)
}

/// Returns the disks with velocities and spins of a gas of this temperature (energy).
#[pyfunction]
pub(crate) fn with_maxwellian_velocities(disks: &Disks, temperature: f64, seed: u64) -> PyResult<Disks> {
    initial::with_maxwellian_velocities(disks.0.clone(), temperature, seed).map(Disks).map_err(invalid)
}

/// Returns the disks with a total momentum of 0.
#[pyfunction]
pub(crate) fn without_drift(disks: &Disks) -> PyResult<Disks> {
    initial::without_drift(disks.0.clone()).map(Disks).map_err(invalid)
}

/// Returns homogeneous disks of these radii (length) at the origin, where `mass` is the mass of a disk of
/// diameter 1.
#[pyfunction]
pub(crate) fn disks_from_radii(radii: Column<'_>, mass: f64) -> PyResult<Disks> {
    if radii.as_array().ndim() != 1 {
        return Err(ParameterError::new_err("radii: a list or an array of numbers is needed"));
    }
    initial::disks_from_radii(radii.as_array().iter().copied(), mass).map(Disks).map_err(invalid)
}

/// A distribution of radii (length) within bounds.
#[pyclass(name = "Radii", module = "granular_edmd", frozen)]
pub(crate) struct PyRadii(Radii);

#[pymethods]
impl PyRadii {
    /// Creates a distribution of radii between these bounds, all equally likely.
    #[staticmethod]
    fn uniform(smallest: f64, largest: f64) -> PyResult<Self> {
        Radii::uniform(smallest, largest).map(Self).map_err(invalid)
    }
    /// Creates a log-normal distribution, cut at these bounds.
    #[staticmethod]
    fn log_normal(median: f64, deviation: f64, smallest: f64, largest: f64) -> PyResult<Self> {
        Radii::log_normal(median, deviation, smallest, largest).map(Self).map_err(invalid)
    }
    /// Creates a distribution with a density in proportion to the radius to the power of `-exponent`.
    #[staticmethod]
    fn power_law(exponent: f64, smallest: f64, largest: f64) -> PyResult<Self> {
        Radii::power_law(exponent, smallest, largest).map(Self).map_err(invalid)
    }
    /// Creates a distribution of two radii, in which this share of the disks is large.
    #[staticmethod]
    fn two_sizes(small: f64, large: f64, share: f64) -> PyResult<Self> {
        Radii::two_sizes(small, large, share).map(Self).map_err(invalid)
    }
    /// Draws `count` radii in random order, as an array.
    fn draw<'py>(&self, py: Python<'py>, count: usize, seed: u64) -> Bound<'py, PyArray1<f64>> {
        to_array(py, self.0.draw(count, seed))
    }
}
