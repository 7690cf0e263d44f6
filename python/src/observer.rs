//! Observers: what a run shows its samples and collisions to.

mod functions;
mod measures;

pub(crate) use functions::{PyCollision, on_collision, on_sample, series, stop_when};
pub(crate) use measures::{
    arrivals, collision_counts, collision_histograms, crossings, energy_change, energy_change_profile,
    fields, height_profile, mean_squared_displacement, pair_correlation, recorder, stress,
    velocity_correlation, velocity_distribution, wall_stress,
};

use edmd::Kind;
use edmd::observable::{BetweenKinds, ByCollisions, Heading, Observer, OfKind, Table};
use edmd::statistics::Estimate;
use pyo3::exceptions::{PyKeyError, PyRuntimeError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::de::{Deserialize, Deserializer};
use serde::ser::{Error, Serialize, Serializer};

use crate::arguments::{Column, to_array};
use crate::data::{Data, data_class, from_data, to_data};
use crate::errors::invalid;
use crate::statistics::{PyEstimate, averaged};

/// The name of a result, and its value once it can be told.
pub(crate) type Named = (&'static str, Option<Estimate>);

/// An observer of Rust, with its results.
pub(crate) trait Watch: Observer + Send + Sync {
    fn table(&self) -> Option<&dyn Table> {
        None
    }

    /// Returns the results that are single numbers.
    fn results(&self) -> Vec<Named> {
        Vec::new()
    }

    /// Returns the observer as data, unless it has a function of Python or an open file.
    fn saved(&self) -> Option<&dyn Saved> {
        None
    }

    /// Returns the table as arrays by the names of the columns.
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let table = self.table().ok_or_else(|| PyTypeError::new_err("this observer has no table"))?;
        let rows: Vec<Vec<f64>> = table.rows().collect();
        let columns = PyDict::new(py);
        for (index, heading) in table.headings().iter().enumerate() {
            columns.set_item(heading.name(), to_array(py, rows.iter().map(|row| row[index])))?;
        }
        Ok(columns)
    }
}

/// A watch that can be saved, by the name of its type.
#[typetag::serde]
pub(crate) trait Saved: Sync {
    fn watch(self: Box<Self>) -> Box<dyn Watch>;
}

impl Serialize for Box<dyn Watch> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let unsaved = "an observer with a function of Python or an open file cannot be saved: keep its table";
        self.saved().ok_or_else(|| S::Error::custom(unsaved))?.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Box<dyn Watch> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Box::<dyn Saved>::deserialize(deserializer).map(Saved::watch)
    }
}

/// Passes everything on to the watch inside an adapter.
macro_rules! adapters {
    ($($adapter:ident $name:literal),+) => {$(
        #[typetag::serde(name = $name)]
        impl Saved for $adapter<Box<dyn Watch>> {
            fn watch(self: Box<Self>) -> Box<dyn Watch> {
                self
            }
        }

        impl Watch for $adapter<Box<dyn Watch>> {
            fn table(&self) -> Option<&dyn Table> {
                self.inner().table()
            }
            fn results(&self) -> Vec<Named> {
                self.inner().results()
            }
            fn saved(&self) -> Option<&dyn Saved> {
                self.inner().saved().map(|_| self as &dyn Saved)
            }
            fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
                self.inner().columns(py)
            }
        }
    )+};
}

adapters!(OfKind "OfKind", BetweenKinds "BetweenKinds", ByCollisions "ByCollisions");

/// An observer of runs: give it to `run_until(…, observe=…)`, and read its table or results afterwards.
///
/// A run takes the observer out of the object and puts it back at its end. The next run continues it. To save
/// a run with what it has measured, pickle both together: `pickle.dumps((simulation, observers))`. Observers
/// with functions of Python and with open files cannot be pickled or copied.
#[pyclass(name = "Observer", module = "granular_edmd")]
pub(crate) struct PyObserver(pub(crate) Option<Box<dyn Watch>>);

impl PyObserver {
    pub(crate) fn of(watch: impl Watch + 'static) -> Self {
        Self(Some(Box::new(watch)))
    }

    fn watch(&self) -> PyResult<&dyn Watch> {
        self.0.as_deref().ok_or_else(absent)
    }

    /// Moves the observer into an adapter.
    fn adapted<W: Watch + 'static>(
        &mut self,
        adapter: impl FnOnce(Box<dyn Watch>) -> PyResult<W>,
    ) -> PyResult<Self> {
        adapter(self.0.take().ok_or_else(absent)?).map(Self::of)
    }
}

impl Data for PyObserver {
    fn data<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_data(py, self.0.as_ref().ok_or_else(absent)?)
    }
    fn of_data(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        from_data(data).map(|watch| Self(Some(watch)))
    }
}

data_class!(PyObserver);

/// Returns the exception for an observer that is in use.
pub(crate) fn absent() -> PyErr {
    PyRuntimeError::new_err("this observer is used by a run or by another observer, or it is given twice")
}

#[pymethods]
impl PyObserver {
    /// Returns the table: a dictionary of arrays, as `pandas.DataFrame` and `polars.DataFrame` take it.
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.watch()?.columns(py)
    }
    /// Returns a column of the table.
    fn __getitem__<'py>(&self, py: Python<'py>, column: &str) -> PyResult<Bound<'py, PyAny>> {
        let columns = self.table(py)?;
        let unknown = || PyKeyError::new_err(format!("no column {column:?}, but {}", columns.keys()));
        columns.get_item(column)?.ok_or_else(unknown)
    }
    /// The units of the columns by their names, in words; "1" for a pure number.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let units = PyDict::new(py);
        for heading in self.watch()?.table().map(Table::headings).unwrap_or_default() {
            units.set_item(heading.name(), heading.unit())?;
        }
        Ok(units)
    }
    /// Returns the mean of a column without its first `skip` rows, with an error that accounts for
    /// correlation.
    #[pyo3(signature = (column, *, skip=0))]
    fn mean(&self, py: Python<'_>, column: &str, skip: usize) -> PyResult<PyEstimate> {
        let numbers: Column<'_> = self.__getitem__(py, column)?.extract()?;
        let rows: Vec<f64> = numbers.as_array().iter().skip(skip).copied().collect();
        averaged(to_array(py, rows).extract()?)
    }
    /// The results that are single numbers, by name: an `Estimate`, or `None` before there are enough
    /// samples.
    #[getter]
    fn results<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let results = PyDict::new(py);
        for (name, estimate) in self.watch()?.results() {
            results.set_item(name, estimate.map(PyEstimate))?;
        }
        Ok(results)
    }
    /// Returns the observer of disks of one kind; this object gives its observer away.
    fn of_kind(&mut self, kind: u16) -> PyResult<Self> {
        self.adapted(|inner| Ok(OfKind::new(Kind::new(kind), inner)))
    }
    /// Returns the observer of collisions between two kinds; this object gives its observer away.
    fn between_kinds(&mut self, first: u16, second: u16) -> PyResult<Self> {
        self.adapted(|inner| Ok(BetweenKinds::new(Kind::new(first), Kind::new(second), inner)))
    }
    /// Returns the observer with a sample after each number of collisions, in place of its times; this object
    /// gives its observer away.
    fn by_collisions(&mut self, count: u64) -> PyResult<Self> {
        self.adapted(|inner| ByCollisions::new(count, inner).map_err(invalid))
    }
    fn __repr__(&self) -> String {
        let names = self.0.as_ref().and_then(|watch| Some(watch.table()?.headings()));
        let names = names.unwrap_or_default();
        let names: Vec<&str> = names.iter().map(Heading::name).collect();
        format!("<Observer of {}>", names.join(", "))
    }
}
