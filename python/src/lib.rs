//! The extension of the Python package `granular_edmd`: the public parts of the library as classes and
//! functions.
//!
//! Each file is a thin layer over a module of the library. Rules, motions and containers are the library's
//! own values, so that runs have the same bits as in Rust; errors keep their sentences.

mod arguments;
mod boundary;
mod data;
mod disks;
mod driving;
mod errors;
mod files;
mod initial;
mod kinetic;
mod motion;
mod observable;
mod observer;
mod program;
mod replay;
mod rule;
mod simulation;
mod statistics;
mod study;

/// Event-driven molecular dynamics of granular disks.
#[pyo3::pymodule]
mod _granular_edmd {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::arguments::PySampleTimes;
    #[pymodule_export]
    use crate::boundary::{PyBrick, PyContainer, PyPart, PyThermal};
    #[pymodule_export]
    use crate::disks::Disks;
    #[pymodule_export]
    use crate::driving::{PyDriving, PyInlet, kick, rescaling, white_noise};
    #[pymodule_export]
    use crate::files::{PyState, convert, frames, read};
    #[pymodule_export]
    use crate::initial::{
        PyRadii, disks_from_radii, even_lattice, lattice, packed_mix, placed_in_rows, scattered,
        scattered_mix, triangular_lattice, with_maxwellian_velocities, without_drift,
    };
    #[pymodule_export]
    use crate::kinetic::{
        PyDirectSimulation, PyMaxwellian, effective_inelasticity, friction_of_largest_loss,
        frictionless_energy_change, iso_line, mean_energy_change, monte_carlo_energy_change,
        sticking_fraction,
    };
    #[pymodule_export]
    use crate::motion::{Motion, PyPiston, bi_parabolic, fixed, sawtooth, sinusoidal, tabulated, triangular};
    #[pymodule_export]
    use crate::observable::{
        PyObservable, PySnapshot, center_of_mass, energies, free_wall, hexatic_order, order_parameters,
        temperatures, temperatures_about_flow,
    };
    #[pymodule_export]
    use crate::observer::{
        PyCollision, PyObserver, arrivals, collision_counts, collision_histograms, crossings, energy_change,
        energy_change_profile, fields, height_profile, mean_squared_displacement, on_collision, on_sample,
        pair_correlation, recorder, series, stop_when, stress, velocity_correlation, velocity_distribution,
        wall_stress,
    };
    #[pymodule_export]
    use crate::program::run_program;
    #[pymodule_export]
    use crate::replay::PyReplay;
    #[pymodule_export]
    use crate::rule::{
        PyContact, PyRule, contact_duration, elastic, elastic_below, frictional, least_rebound,
        rolling_friction, rough, rules_by_kind, smooth, speed_dependent,
    };
    #[pymodule_export]
    use crate::simulation::{PySamples, PySimulation};
    #[pymodule_export]
    use crate::statistics::{PyEstimate, averaged};
    #[pymodule_export]
    use crate::study::{run_study, vibrated_box};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let py = module.py();
        module.add("ParameterError", py.get_type::<crate::errors::ParameterError>())?;
        module.add("RunError", py.get_type::<crate::errors::RunError>())?;
        module.add("CheckpointError", py.get_type::<crate::errors::CheckpointError>())?;
        module.add("FileError", py.get_type::<crate::errors::FileError>())?;
        module.add("WALL", edmd::Kind::WALL.number())?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
