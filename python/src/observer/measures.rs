//! The measures of the library as observers.

use std::collections::BTreeMap;
use std::path::PathBuf;

use edmd::Kind;
use edmd::observable::{
    Accumulator, Arrivals, CollisionCounts, CollisionHistograms, Crossings, EnergyChange,
    EnergyChangeProfile, Fields, HeightProfile, MeanSquaredDisplacement, PairCorrelation, Sampled, Series,
    Stress, Table, TimeCorrelation, Velocities, VelocityDistribution, WallStress,
};
use edmd_files::{ByEnding, Recorder};
use pyo3::prelude::*;

use super::{Named, PyObserver, Saved, Watch};
use crate::arguments::{Every, Pair, region, vector};
use crate::errors::{invalid, unreadable};
use crate::observable::{PyObservable, grid};

/// Makes measures watches that can be saved by these names, some of them with results that are single
/// numbers.
macro_rules! watch {
    ($($label:literal: $measure:ty $(: |$own:ident| [$($name:literal => $value:expr),+])?;)+) => {$(
        #[typetag::serde(name = $label)]
        impl Saved for $measure {
            fn watch(self: Box<Self>) -> Box<dyn Watch> {
                self
            }
        }

        impl Watch for $measure {
            fn table(&self) -> Option<&dyn Table> {
                Some(self)
            }
            fn saved(&self) -> Option<&dyn Saved> {
                Some(self)
            }
            $(fn results(&self) -> Vec<Named> {
                let $own = self;
                vec![$(($name, $value)),+]
            })?
        }
    )+};
}

/// Makes accumulators with a clock watches.
macro_rules! watch_sampled {
    ($($accumulator:ty: $name:literal);+) => {$(
        #[typetag::serde(name = $name)]
        impl Saved for Sampled<$accumulator> {
            fn watch(self: Box<Self>) -> Box<dyn Watch> {
                self
            }
        }

        impl Watch for Sampled<$accumulator> {
            fn table(&self) -> Option<&dyn Table> {
                Some(&**self)
            }
            fn saved(&self) -> Option<&dyn Saved> {
                Some(self)
            }
        }
    )+};
}

watch! {
    "Series": Series<PyObservable>;
    "VelocityCorrelation": TimeCorrelation<Velocities>;
    "CollisionCounts": CollisionCounts;
    "CollisionHistograms": CollisionHistograms;
    "WallStress": WallStress;
    "Arrivals": Arrivals: |own| ["rate" => own.rate().ok()];
    "EnergyChange": EnergyChange: |own| ["disks" => Some(own.disks().estimate())];
    "Crossings": Crossings: |own| [
        "flux" => own.flux().ok(),
        "forward_rate" => own.rates().ok().map(|[forward, _]| forward),
        "backward_rate" => own.rates().ok().map(|[_, backward]| backward)
    ];
    "MeanSquaredDisplacement": MeanSquaredDisplacement: |own| [
        "diffusion_coefficient" => Some(own.diffusion_coefficient())
    ];
    "Stress": Stress: |own| [
        "pressure" => Some(own.tensor().pressure),
        "xx" => Some(own.tensor().xx),
        "xy" => Some(own.tensor().xy),
        "yx" => Some(own.tensor().yx),
        "yy" => Some(own.tensor().yy)
    ];
}

watch_sampled! {
    PairCorrelation: "PairCorrelation"; VelocityDistribution: "VelocityDistribution";
    HeightProfile: "HeightProfile"; EnergyChangeProfile: "EnergyChangeProfile"; Fields: "Fields"
}

impl Watch for Recorder {}

fn sampled<A>(accumulator: A, every: Every) -> PyObserver
where
    A: Accumulator,
    Sampled<A>: Watch + 'static,
{
    PyObserver::of(Sampled::new(accumulator, every.0))
}

/// Returns an observer of the mean energy (energy) that a collision changes; negative if it is lost.
#[pyfunction]
#[pyo3(name = "EnergyChange")]
pub(crate) fn energy_change() -> PyObserver {
    PyObserver::of(EnergyChange::default())
}

/// Returns an observer that counts collisions by walls and regimes.
#[pyfunction]
#[pyo3(name = "CollisionCounts")]
pub(crate) fn collision_counts() -> PyObserver {
    PyObserver::of(CollisionCounts::default())
}

/// Returns histograms of collisions: their obliqueness, closing speeds up to `speed` (length/time) and
/// impulses up to `impulse` (mass length/time); of two disks, or with the walls of these names.
#[pyfunction]
#[pyo3(name = "CollisionHistograms", signature = (speed, impulse, bins, *, walls=Vec::new()))]
pub(crate) fn collision_histograms(
    speed: f64,
    impulse: f64,
    bins: usize,
    walls: Vec<String>,
) -> PyResult<PyObserver> {
    let histograms = CollisionHistograms::new(speed, impulse, bins).map_err(invalid)?;
    Ok(PyObserver::of(walls.into_iter().fold(histograms, CollisionHistograms::with_wall)))
}

/// Returns an observer of the mean squared displacement (length²) over up to `lags` intervals.
#[pyfunction]
#[pyo3(name = "MeanSquaredDisplacement")]
pub(crate) fn mean_squared_displacement(lags: usize, every: Every) -> PyResult<PyObserver> {
    MeanSquaredDisplacement::new(lags, every.0).map(PyObserver::of).map_err(invalid)
}

/// Returns an observer of the correlation of velocities in time over up to `lags` intervals.
#[pyfunction]
#[pyo3(name = "VelocityCorrelation")]
pub(crate) fn velocity_correlation(lags: usize, every: Every) -> PyResult<PyObserver> {
    TimeCorrelation::new(Velocities, lags, every.0).map(PyObserver::of).map_err(invalid)
}

/// Returns an observer of the stress tensor and the pressure (mass/time²), in all of the box or in a region.
#[pyfunction]
#[pyo3(name = "Stress", signature = (every, *, corners=None))]
pub(crate) fn stress(every: Every, corners: Option<(Pair, Pair)>) -> PyResult<PyObserver> {
    let stress = Stress::new(every.0);
    let stress = corners.map_or(Ok(stress.clone()), |corners| stress.within(region(corners)));
    stress.map(PyObserver::of).map_err(invalid)
}

/// Returns an observer of the disks that arrive at walls or parts of these names, per interval.
#[pyfunction]
#[pyo3(name = "Arrivals")]
pub(crate) fn arrivals(names: Vec<String>, every: Every) -> PyObserver {
    PyObserver::of(Arrivals::at(names, every.0))
}

/// Returns an observer of the pressure and the shear stress (mass/time²) on walls, from their names and
/// lengths: `{"left": 40.0}`.
#[pyfunction]
#[pyo3(name = "WallStress")]
pub(crate) fn wall_stress(lengths: BTreeMap<String, f64>, every: Every) -> PyResult<PyObserver> {
    let stress = |stress: WallStress, (name, length)| stress.with_wall(name, length);
    lengths.into_iter().try_fold(WallStress::new(every.0), stress).map(PyObserver::of).map_err(invalid)
}

/// Returns an observer of the disks that cross a line between two points (length): forward is from its right
/// to its left.
#[pyfunction]
#[pyo3(name = "Crossings")]
pub(crate) fn crossings(line: (Pair, Pair), every: Every) -> PyResult<PyObserver> {
    Crossings::new([vector(line.0), vector(line.1)], every.0).map(PyObserver::of).map_err(invalid)
}

/// Returns an observer of the pair correlation up to a range (length), of all disks or between two kinds, in
/// all of the box or in a region.
#[pyfunction]
#[pyo3(name = "PairCorrelation", signature = (range, bins, every, *, kinds=None, corners=None))]
pub(crate) fn pair_correlation(
    range: f64,
    bins: usize,
    every: Every,
    kinds: Option<(u16, u16)>,
    corners: Option<(Pair, Pair)>,
) -> PyResult<PyObserver> {
    let mut pairs = PairCorrelation::new(range, bins).map_err(invalid)?;
    if let Some((first, second)) = kinds {
        pairs = pairs.between(Kind::new(first), Kind::new(second));
    }
    if let Some(corners) = corners {
        pairs = pairs.within(region(corners)).map_err(invalid)?;
    }
    Ok(sampled(pairs, every))
}

/// Returns histograms of velocities up to `largest` (length/time), relative to the mean velocity if wanted.
#[pyfunction]
#[pyo3(name = "VelocityDistribution", signature = (largest, bins, every, *, about_mean=false))]
pub(crate) fn velocity_distribution(
    largest: f64,
    bins: usize,
    every: Every,
    about_mean: bool,
) -> PyResult<PyObserver> {
    let velocities = VelocityDistribution::new(largest, bins).map_err(invalid)?;
    Ok(sampled(if about_mean { velocities.about_mean() } else { velocities }, every))
}

/// Returns an observer of the packing fraction in layers between two heights (length).
#[pyfunction]
#[pyo3(name = "HeightProfile")]
pub(crate) fn height_profile(bottom: f64, top: f64, layers: usize, every: Every) -> PyResult<PyObserver> {
    HeightProfile::new(bottom, top, layers).map(|profile| sampled(profile, every)).map_err(invalid)
}

/// Returns an observer of the energy change and the temperatures in layers between two heights (length).
#[pyfunction]
#[pyo3(name = "EnergyChangeProfile")]
pub(crate) fn energy_change_profile(
    bottom: f64,
    top: f64,
    layers: usize,
    every: Every,
) -> PyResult<PyObserver> {
    EnergyChangeProfile::new(bottom, top, layers).map(|profile| sampled(profile, every)).map_err(invalid)
}

/// Returns an observer of density, velocity and temperature in the cells of a grid over a region, given by
/// its lower left and its upper right corner (length).
#[pyfunction]
#[pyo3(name = "Fields")]
pub(crate) fn fields(
    corners: (Pair, Pair),
    columns: usize,
    rows: usize,
    every: Every,
) -> PyResult<PyObserver> {
    Ok(sampled(Fields::new(grid(corners, columns, rows)?), every))
}

/// Returns an observer that writes a trajectory; the ending of its name is the format: `.xyz`, `.lammpstrj`,
/// `.gsd`, `.pvd`, and `.gz` after the text formats.
///
/// An existing file is not overwritten; with `append`, it is continued.
#[pyfunction]
#[pyo3(name = "Recorder", signature = (path, every, *, append=false))]
pub(crate) fn recorder(path: PathBuf, every: Every, append: bool) -> PyResult<PyObserver> {
    let recorder = if append {
        Recorder::create_or_append(path, ByEnding, every.0)
    } else {
        Recorder::create(path, ByEnding, every.0)
    };
    recorder.map(PyObserver::of).map_err(unreadable)
}
