//! Disks as columns of numpy arrays.

use edmd::glam::DVec2;
use edmd::{Disk, ParameterError as Refused};
use pyo3::prelude::*;

use crate::arguments::{Column, Rows, column, kind, rows};
use crate::data::{Data, data_class, from_data, to_data};
use crate::errors::{ParameterError, invalid};

/// Disks, whose columns are read as arrays. They never change: `with_` returns others.
///
/// Each read of a column makes one copy.
#[pyclass(name = "Disks", module = "granular_edmd", frozen, from_py_object)]
#[derive(Clone)]
pub(crate) struct Disks(pub(crate) Vec<Disk>);

impl Data for Disks {
    fn data<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_data(py, &self.0)
    }
    fn of_data(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        from_data(data).map(Self)
    }
}

data_class!(Disks);

/// Adds columns of disks as properties to a class with a method `list` that returns its disks.
macro_rules! disk_columns {
    ($class:ty) => {
        #[pyo3::pymethods]
        impl $class {
            /// The positions (length), of shape (N, 2). One copy.
            #[getter]
            fn positions<'py>(
                &self,
                py: pyo3::Python<'py>,
            ) -> pyo3::PyResult<pyo3::Bound<'py, numpy::PyArray2<f64>>> {
                crate::arguments::to_rows(py, self.list().iter().map(edmd::Disk::position))
            }
            /// The velocities (length/time), of shape (N, 2). One copy.
            #[getter]
            fn velocities<'py>(
                &self,
                py: pyo3::Python<'py>,
            ) -> pyo3::PyResult<pyo3::Bound<'py, numpy::PyArray2<f64>>> {
                crate::arguments::to_rows(py, self.list().iter().map(edmd::Disk::velocity))
            }
            /// The angles (radians), of shape (N,). One copy.
            #[getter]
            fn angles<'py>(&self, py: pyo3::Python<'py>) -> pyo3::Bound<'py, numpy::PyArray1<f64>> {
                crate::arguments::to_array(py, self.list().iter().map(edmd::Disk::angle))
            }
            /// The angular velocities (1/time), counterclockwise, of shape (N,). One copy.
            #[getter]
            fn spins<'py>(&self, py: pyo3::Python<'py>) -> pyo3::Bound<'py, numpy::PyArray1<f64>> {
                crate::arguments::to_array(py, self.list().iter().map(edmd::Disk::angular_velocity))
            }
            /// The radii (length), of shape (N,). One copy.
            #[getter]
            fn radii<'py>(&self, py: pyo3::Python<'py>) -> pyo3::Bound<'py, numpy::PyArray1<f64>> {
                crate::arguments::to_array(py, self.list().iter().map(edmd::Disk::radius))
            }
            /// The masses, of shape (N,). One copy.
            #[getter]
            fn masses<'py>(&self, py: pyo3::Python<'py>) -> pyo3::Bound<'py, numpy::PyArray1<f64>> {
                crate::arguments::to_array(py, self.list().iter().map(edmd::Disk::mass))
            }
            /// The kinds, of shape (N,) and type uint16. One copy.
            #[getter]
            fn kinds<'py>(&self, py: pyo3::Python<'py>) -> pyo3::Bound<'py, numpy::PyArray1<u16>> {
                crate::arguments::to_array(py, self.list().iter().map(|disk| disk.kind().number()))
            }
            /// The numbers that identify the disks in a run, of shape (N,) and type uint64. One copy.
            #[getter]
            fn ids<'py>(&self, py: pyo3::Python<'py>) -> pyo3::Bound<'py, numpy::PyArray1<u64>> {
                crate::arguments::to_array(py, self.list().iter().map(edmd::Disk::id))
            }
            /// How often each disk crossed the periodic sides and ends, of shape (N, 2). One copy.
            #[getter]
            fn images<'py>(
                &self,
                py: pyo3::Python<'py>,
            ) -> pyo3::PyResult<pyo3::Bound<'py, numpy::PyArray2<f64>>> {
                let image = |disk: &edmd::Disk| edmd::glam::DVec2::from(disk.image().map(f64::from));
                crate::arguments::to_rows(py, self.list().iter().map(image))
            }
            fn __len__(&self) -> usize {
                self.list().len()
            }
        }
    };
}

pub(crate) use disk_columns;

disk_columns!(Disks);

/// The columns of disks that can be set.
struct Columns<'py> {
    velocities: Option<Rows<'py>>,
    angles: Option<Column<'py>>,
    spins: Option<Column<'py>>,
    masses: Option<Column<'py>>,
    inertia_factors: Option<Column<'py>>,
    kinds: Option<Column<'py>>,
}

impl Columns<'_> {
    /// Returns the disks with these columns.
    fn set(&self, mut disks: Vec<Disk>) -> PyResult<Vec<Disk>> {
        type Set = fn(Disk, f64) -> Result<Disk, Refused>;
        let columns: [(&str, &Option<Column<'_>>, Set); 4] = [
            ("angles", &self.angles, Disk::with_angle),
            ("spins", &self.spins, Disk::with_angular_velocity),
            ("masses", &self.masses, Disk::with_mass),
            ("inertia_factors", &self.inertia_factors, Disk::with_inertia_factor),
        ];
        let count = disks.len();
        for (name, numbers, set) in columns {
            let Some(numbers) = numbers else { continue };
            for (disk, number) in disks.iter_mut().zip(column(name, numbers, count)?) {
                *disk = set(*disk, number).map_err(invalid)?;
            }
        }
        if let Some(kinds) = &self.kinds {
            for (disk, number) in disks.iter_mut().zip(column("kinds", kinds, count)?) {
                *disk = disk.with_kind(kind(number)?);
            }
        }
        self.set_velocities(disks)
    }

    fn set_velocities(&self, disks: Vec<Disk>) -> PyResult<Vec<Disk>> {
        let Some(velocities) = &self.velocities else { return Ok(disks) };
        let velocities = rows("velocities", velocities)?;
        if velocities.len() != disks.len() {
            let message = format!("velocities: {} rows for {} disks", velocities.len(), disks.len());
            return Err(ParameterError::new_err(message));
        }
        let with = |(disk, velocity): (Disk, DVec2)| disk.with_velocity(velocity);
        disks.into_iter().zip(velocities).map(with).collect::<Result<_, _>>().map_err(invalid)
    }
}

impl Disks {
    pub(crate) fn list(&self) -> &[Disk] {
        &self.0
    }
}

#[pymethods]
impl Disks {
    /// Creates disks from arrays: positions of shape (N, 2), radii and all others of shape (N,).
    ///
    /// A number in place of an array is the same for all disks. Without them, velocities, angles and spins
    /// are 0, masses 1, moments of inertia m R²/2 (`inertia_factors` 0.5) and kinds 0.
    #[new]
    #[pyo3(signature = (
        positions, radii, *, velocities=None, angles=None, spins=None, masses=None, inertia_factors=None, kinds=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn new(
        positions: Rows<'_>,
        radii: Column<'_>,
        velocities: Option<Rows<'_>>,
        angles: Option<Column<'_>>,
        spins: Option<Column<'_>>,
        masses: Option<Column<'_>>,
        inertia_factors: Option<Column<'_>>,
        kinds: Option<Column<'_>>,
    ) -> PyResult<Self> {
        let positions = rows("positions", &positions)?;
        let radii = column("radii", &radii, positions.len())?;
        let disks = positions.into_iter().zip(radii).map(|(position, radius)| Disk::new(position, radius));
        let disks = disks.collect::<Result<Vec<_>, _>>().map_err(invalid)?;
        Columns { velocities, angles, spins, masses, inertia_factors, kinds }.set(disks).map(Self)
    }
    /// Returns the same disks with other columns.
    #[pyo3(name = "with_", signature = (
        *, velocities=None, angles=None, spins=None, masses=None, inertia_factors=None, kinds=None
    ))]
    fn with(
        &self,
        velocities: Option<Rows<'_>>,
        angles: Option<Column<'_>>,
        spins: Option<Column<'_>>,
        masses: Option<Column<'_>>,
        inertia_factors: Option<Column<'_>>,
        kinds: Option<Column<'_>>,
    ) -> PyResult<Self> {
        Columns { velocities, angles, spins, masses, inertia_factors, kinds }.set(self.0.clone()).map(Self)
    }
    fn __add__(&self, other: &Self) -> Self {
        Self([self.list(), other.list()].concat())
    }
    /// Returns the disks of a slice, a mask or a list of indices.
    fn __getitem__(&self, chosen: &Bound<'_, PyAny>) -> PyResult<Self> {
        let numpy = chosen.py().import("numpy")?;
        let indices = numpy.call_method1("arange", (self.0.len(),))?.get_item(chosen)?;
        let indices: Vec<usize> = numpy.call_method1("atleast_1d", (indices,))?.extract()?;
        Ok(Self(indices.into_iter().map(|index| self.0[index]).collect()))
    }
    fn __repr__(&self) -> String {
        format!("<{} Disks>", self.0.len())
    }
}
