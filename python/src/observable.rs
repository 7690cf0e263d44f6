//! Observables of Rust, and snapshots for observables in Python.

use edmd::observable::{
    CenterOfMass, Energies, FreeWall, Grid, Heading, HexaticOrder, Observable, OfKind, OrderParameters,
    Snapshot, Tabular, Temperatures, TemperaturesAboutFlow,
};
use edmd::{Disk, Kind};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use serde::{Deserialize, Serialize};

use crate::arguments::{Pair, region};
use crate::data::{Data, data_class, from_data, to_data};
use crate::disks::{Disks, disk_columns};
use crate::errors::invalid;

/// An observable whose values are numbers: [`Tabular`] without its type of values.
trait Numbers: Send + Sync {
    fn headings(&self) -> Vec<Heading>;
    fn numbers(&self, snapshot: &Snapshot<'_>) -> Vec<f64>;
}

impl<T: Tabular + Send + Sync> Numbers for T {
    fn headings(&self) -> Vec<Heading> {
        Tabular::headings(self)
    }
    fn numbers(&self, snapshot: &Snapshot<'_>) -> Vec<f64> {
        let mut row = Vec::new();
        self.add_numbers(&self.measure(snapshot), &mut row);
        row
    }
}

/// One observable of the library.
#[derive(Clone, Serialize, Deserialize)]
enum Part {
    OrderParameters(OrderParameters),
    CenterOfMass(CenterOfMass),
    Energies(Energies),
    Temperatures(Temperatures),
    HexaticOrder(HexaticOrder),
    TemperaturesAboutFlow(TemperaturesAboutFlow),
    FreeWall(FreeWall),
    OfKind(OfKind<PyObservable>),
}

impl Part {
    fn known(&self) -> &dyn Numbers {
        match self {
            Self::OrderParameters(own) => own,
            Self::CenterOfMass(own) => own,
            Self::Energies(own) => own,
            Self::Temperatures(own) => own,
            Self::HexaticOrder(own) => own,
            Self::TemperaturesAboutFlow(own) => own,
            Self::FreeWall(own) => own,
            Self::OfKind(own) => own,
        }
    }
}

/// A quantity that is measured in a snapshot, as numbers with names.
///
/// `Energies()` and the like create one. `Series` also takes a function of a `Snapshot`.
#[pyclass(name = "Observable", module = "granular_edmd", frozen)]
#[derive(Clone, Serialize, Deserialize)]
#[expect(clippy::unsafe_derive_deserialize, reason = "the unsafe code is that of PyO3")]
pub(crate) struct PyObservable(Vec<Part>);

impl Data for PyObservable {
    fn data<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_data(py, self)
    }
    fn of_data(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        from_data(data)
    }
}

data_class!(PyObservable);

impl PyObservable {
    fn of(part: Part) -> Self {
        Self(vec![part])
    }

    /// Returns an observable, or several of a list as one; `None` if the object is something else.
    pub(crate) fn extract(any: &Bound<'_, PyAny>) -> Option<Self> {
        if let Ok(one) = any.cast::<Self>() {
            return Some(one.get().clone());
        }
        let is_list = any.is_instance_of::<PyList>() || any.is_instance_of::<PyTuple>();
        let parts = is_list.then(|| any.try_iter().ok())??;
        let parts = parts.map(|part| Self::extract(&part.ok()?)).collect::<Option<Vec<_>>>()?;
        Some(Self(parts.into_iter().flat_map(|part| part.0).collect()))
    }

    /// Returns the value in a snapshot as a dictionary.
    pub(crate) fn measured<'py>(
        &self,
        py: Python<'py>,
        snapshot: &Snapshot<'_>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let values = PyDict::new(py);
        for (heading, number) in Tabular::headings(self).iter().zip(self.measure(snapshot)) {
            values.set_item(heading.name(), number)?;
        }
        Ok(values)
    }
}

impl Observable for PyObservable {
    type Value = Vec<f64>;

    fn measure(&self, snapshot: &Snapshot<'_>) -> Vec<f64> {
        self.0.iter().flat_map(|part| part.known().numbers(snapshot)).collect()
    }
}

impl Tabular for PyObservable {
    fn headings(&self) -> Vec<Heading> {
        self.0.iter().flat_map(|part| part.known().headings()).collect()
    }
    fn add_numbers(&self, value: &Vec<f64>, row: &mut Vec<f64>) {
        row.extend(value);
    }
}

#[pymethods]
impl PyObservable {
    /// The names of the numbers, as columns of a table have them.
    #[getter]
    fn names(&self) -> Vec<String> {
        Tabular::headings(self).iter().map(|heading| heading.name().to_owned()).collect()
    }
    /// Returns the same observable of the disks of one kind.
    fn of_kind(&self, kind: u16) -> Self {
        Self::of(Part::OfKind(OfKind::new(Kind::new(kind), self.clone())))
    }
    fn __repr__(&self) -> String {
        format!("<Observable of {}>", self.names().join(", "))
    }
}

/// Creates functions without arguments.
macro_rules! observables {
    ($($function:ident, $observable:ident, $name:literal, $what:literal;)+) => {$(
        #[doc = $what]
        #[pyfunction]
        #[pyo3(name = $name)]
        pub(crate) fn $function() -> PyObservable {
            PyObservable::of(Part::$observable($observable))
        }
    )+};
}

observables! {
    order_parameters, OrderParameters, "OrderParameters",
        "Returns the order parameters of convection: `one_roll` and `two_rolls` (length/time).";
    center_of_mass, CenterOfMass, "CenterOfMass", "Returns the center of mass: `center_x` and `center_y` (length).";
    energies, Energies, "Energies", "Returns the translational, rotational and potential energy per disk.";
    temperatures, Temperatures, "Temperatures",
        "Returns the horizontal, vertical and rotational temperature (energy).";
}

/// Returns the hexatic order of neighbors within a range (length).
#[pyfunction]
#[pyo3(name = "HexaticOrder")]
pub(crate) fn hexatic_order(range: f64) -> PyResult<PyObservable> {
    HexaticOrder::new(range).map(Part::HexaticOrder).map(PyObservable::of).map_err(invalid)
}

/// Returns the displacement from the place at rest, the velocity and the energy of a wall or part with a
/// mass, by its name; NaN for another wall.
#[pyfunction]
#[pyo3(name = "FreeWall")]
pub(crate) fn free_wall(name: String) -> PyObservable {
    PyObservable::of(Part::FreeWall(FreeWall::named(name)))
}

/// Returns the temperatures about the mean flow in the cells of a grid over a region, given by its lower left
/// and its upper right corner (length).
#[pyfunction]
#[pyo3(name = "TemperaturesAboutFlow")]
pub(crate) fn temperatures_about_flow(
    corners: (Pair, Pair),
    columns: usize,
    rows: usize,
) -> PyResult<PyObservable> {
    let flow = TemperaturesAboutFlow::new(grid(corners, columns, rows)?);
    Ok(PyObservable::of(Part::TemperaturesAboutFlow(flow)))
}

pub(crate) fn grid(corners: (Pair, Pair), columns: usize, rows: usize) -> PyResult<Grid> {
    Grid::new(region(corners), columns, rows).map_err(invalid)
}

/// The state of a run at a time. Its columns are arrays, as those of `Disks`.
#[pyclass(name = "Snapshot", module = "granular_edmd", frozen)]
pub(crate) struct PySnapshot {
    /// The time.
    #[pyo3(get)]
    time: f64,
    /// The gravity vector (length/time²): (0, -g) if the number g was given.
    #[pyo3(get)]
    gravity: Pair,
    disks: Vec<Disk>,
}

impl PySnapshot {
    pub(crate) fn of(snapshot: &Snapshot<'_>) -> Self {
        let gravity = snapshot.gravity().acceleration().into();
        Self { time: snapshot.time(), gravity, disks: snapshot.disks().to_vec() }
    }

    fn list(&self) -> &[Disk] {
        &self.disks
    }
}

disk_columns!(PySnapshot);

#[pymethods]
impl PySnapshot {
    /// The disks.
    #[getter]
    fn disks(&self) -> Disks {
        Disks(self.disks.clone())
    }
    fn __repr__(&self) -> String {
        format!("<Snapshot of {} disks at time {}>", self.disks.len(), self.time)
    }
}
