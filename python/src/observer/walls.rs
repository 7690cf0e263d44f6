//! Observers of walls by name. The library names walls by index, which is known once a run begins.

use std::collections::HashMap;

use edmd::observable::{Arrivals, Observer, Table, WallStress};
use pyo3::prelude::*;

use super::{Named, PyObserver, Watch};
use crate::arguments::Every;
use crate::errors::{ParameterError, invalid};

type Make = Box<dyn Fn(&[String]) -> PyResult<Box<dyn Watch>> + Send + Sync>;

/// An observer that is made when the names of the walls are known.
struct AtWalls(Make);

impl Observer for AtWalls {}

impl Watch for AtWalls {
    fn prepared(&self, walls: &[String]) -> PyResult<Option<Box<dyn Watch>>> {
        self.0(walls).map(Some)
    }
}

impl Watch for Arrivals {
    fn table(&self) -> Option<&dyn Table> {
        Some(self)
    }
    fn results(&self) -> Vec<Named> {
        vec![("rate", self.rate().ok())]
    }
}

impl Watch for WallStress {
    fn table(&self) -> Option<&dyn Table> {
        Some(self)
    }
}

/// Returns the indices of the walls of this name.
fn indices(walls: &[String], name: &str) -> PyResult<Vec<usize>> {
    let found: Vec<usize> = (0..walls.len()).filter(|&wall| walls[wall] == name).collect();
    if found.is_empty() {
        return Err(ParameterError::new_err(format!("no wall {name:?}: the walls are {walls:?}")));
    }
    Ok(found)
}

/// Returns an observer of the disks that arrive at walls or parts of these names, per interval.
#[pyfunction]
#[pyo3(name = "Arrivals")]
pub(crate) fn arrivals(names: Vec<String>, every: Every) -> PyObserver {
    PyObserver::of(AtWalls(Box::new(move |walls| {
        let chosen = names.iter().map(|name| indices(walls, name)).collect::<PyResult<Vec<_>>>()?;
        Ok(Box::new(Arrivals::at(chosen.into_iter().flatten(), every.0)))
    })))
}

/// Returns an observer of the pressure and the shear stress (mass/time²) on walls, from their names and
/// lengths: `{"left": 40.0}`.
#[pyfunction]
#[pyo3(name = "WallStress")]
pub(crate) fn wall_stress(lengths: HashMap<String, f64>, every: Every) -> PyObserver {
    PyObserver::of(AtWalls(Box::new(move |walls| {
        let mut stress = WallStress::new(every.0);
        for (name, length) in &lengths {
            for wall in indices(walls, name)? {
                stress = stress.with_wall(wall, *length).map_err(invalid)?;
            }
        }
        Ok(Box::new(stress))
    })))
}
