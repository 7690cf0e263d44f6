//! Kinetic theory of two disks, and gases without correlations.

use edmd::collision::Frictional;
use edmd::kinetic::{self, DirectSimulation, IsoLine, Maxwellian, MonteCarlo};
use pyo3::prelude::*;

use crate::disks::{Disks, disk_columns};
use crate::errors::{ParameterError, invalid, or_raised};
use crate::rule::{AnyRule, SharedRule};
use crate::statistics::PyEstimate;

/// A gas with velocities and spins of Maxwell's distribution.
///
/// The temperatures are energies; the rotational one is the translational one unless it is given.
#[pyclass(name = "Maxwellian", module = "granular_edmd", frozen, from_py_object)]
#[derive(Clone)]
pub(crate) struct PyMaxwellian(Maxwellian);

#[pymethods]
impl PyMaxwellian {
    #[new]
    #[pyo3(signature = (temperature, *, rotational=None))]
    fn new(temperature: f64, rotational: Option<f64>) -> PyResult<Self> {
        let gas = Maxwellian::new(temperature).map_err(invalid)?;
        let rotational = rotational.unwrap_or(temperature);
        gas.with_rotational_temperature(rotational).map(Self).map_err(invalid)
    }
    /// Returns the same gas of pairs like the first two of these disks.
    fn with_partners(&self, disks: &Disks) -> PyResult<Self> {
        let [first, second, ..] = &*disks.0 else {
            return Err(ParameterError::new_err("two disks are needed"));
        };
        Ok(Self(self.0.with_partners(first, second)))
    }
    fn __repr__(&self) -> String {
        let (translational, rotational) =
            (self.0.translational_temperature(), self.0.rotational_temperature());
        format!("Maxwellian({translational}, rotational={rotational})")
    }
}

fn rule(normal: f64, tangential: f64, friction: f64) -> PyResult<Frictional> {
    Frictional::from_inelasticity(normal, tangential, friction).map_err(invalid)
}

/// Returns the mean energy change of a collision (energy), in closed form, for `Frictional(normal,
/// tangential, friction)`.
#[pyfunction]
pub(crate) fn mean_energy_change(
    normal: f64,
    tangential: f64,
    friction: f64,
    gas: &PyMaxwellian,
) -> PyResult<f64> {
    Ok(kinetic::mean_energy_change(&rule(normal, tangential, friction)?, &gas.0))
}

/// Returns the share of the collisions in which the surfaces stick.
#[pyfunction]
pub(crate) fn sticking_fraction(
    normal: f64,
    tangential: f64,
    friction: f64,
    gas: &PyMaxwellian,
) -> PyResult<f64> {
    Ok(kinetic::sticking_fraction(&rule(normal, tangential, friction)?, &gas.0))
}

/// Returns the friction at which most energy is lost, or `None`.
#[pyfunction]
pub(crate) fn friction_of_largest_loss(
    normal: f64,
    tangential: f64,
    gas: &PyMaxwellian,
) -> PyResult<Option<f64>> {
    Ok(kinetic::friction_of_largest_loss(&rule(normal, tangential, 0.0)?, &gas.0))
}

/// Returns the inelasticity of smooth disks with this mean energy change (energy) at a temperature (energy).
#[pyfunction]
pub(crate) fn effective_inelasticity(mean_energy_change: f64, temperature: f64) -> PyResult<f64> {
    kinetic::effective_inelasticity(mean_energy_change, temperature).map_err(invalid)
}

/// Returns the mean energy change (energy) of smooth disks of this inelasticity at a temperature (energy).
#[pyfunction]
pub(crate) fn frictionless_energy_change(inelasticity: f64, temperature: f64) -> PyResult<f64> {
    kinetic::frictionless_energy_change(inelasticity, temperature).map_err(invalid)
}

/// Returns the inelasticities at which the mean energy change (energy) is this, at a friction.
#[pyfunction]
pub(crate) fn iso_line(mean_energy_change: f64, gas: &PyMaxwellian, friction: f64) -> PyResult<Vec<f64>> {
    let line = IsoLine::new(mean_energy_change, &gas.0).map_err(invalid)?;
    line.inelasticities(friction).map_err(invalid)
}

/// Returns the mean energy change of a collision (energy) under any rule, by Monte Carlo: with a number of
/// samples, or to a standard error.
#[pyfunction]
#[pyo3(signature = (rule, gas, seed, *, samples=None, standard_error=None))]
pub(crate) fn monte_carlo_energy_change(
    py: Python<'_>,
    rule: AnyRule,
    gas: &PyMaxwellian,
    seed: u64,
    samples: Option<u64>,
    standard_error: Option<f64>,
) -> PyResult<PyEstimate> {
    let mut method = MonteCarlo::new(seed);
    if let Some(samples) = samples {
        method = method.with_samples(samples);
    }
    if let Some(error) = standard_error {
        method = method.with_standard_error(error).map_err(invalid)?;
    }
    let rule = rule.0.rule;
    or_raised(Ok(PyEstimate(py.detach(|| method.mean_energy_change(&rule, &gas.0)))))
}

/// A homogeneous gas without correlations, by direct simulation Monte Carlo.
///
/// `density` is the number of disks per area, enhanced by the pair correlation at contact.
#[pyclass(name = "DirectSimulation", module = "granular_edmd")]
pub(crate) struct PyDirectSimulation(DirectSimulation<SharedRule>);

impl PyDirectSimulation {
    fn list(&self) -> &[edmd::Disk] {
        self.0.disks()
    }
}

disk_columns!(PyDirectSimulation);

#[pymethods]
impl PyDirectSimulation {
    #[new]
    fn new(rule: AnyRule, disks: &Disks, density: f64, seed: u64) -> PyResult<Self> {
        DirectSimulation::new(rule.0.rule, disks.0.clone(), density, seed).map(Self).map_err(invalid)
    }
    /// Runs until a time.
    fn run_until(&mut self, py: Python<'_>, time: f64) -> PyResult<()> {
        or_raised(py.detach(|| self.0.run_until(time)).map_err(invalid))
    }
    /// The present time.
    #[getter]
    fn time(&self) -> f64 {
        self.0.time()
    }
    /// The number of collisions since the start.
    #[getter]
    fn collisions(&self) -> u64 {
        self.0.collisions()
    }
    /// The disks. They can be set to the same number of disks.
    #[getter]
    fn disks(&self) -> Disks {
        Disks(self.0.disks().to_vec())
    }
    #[setter]
    fn set_disks(&mut self, disks: &Disks) -> PyResult<()> {
        let (given, present) = (disks.0.len(), self.0.disks().len());
        if given != present {
            return Err(ParameterError::new_err(format!("{given} disks for {present}")));
        }
        self.0.disks_mut().copy_from_slice(&disks.0);
        Ok(())
    }
}
