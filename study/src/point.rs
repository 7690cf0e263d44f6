//! Points: values with all their repeats.

use granular_edmd::statistics::Estimate;

use super::{Experiment, Leg, Record};
use crate::experiment::with_error;

/// A value at a point of the grid, with the records of its repeats, which have the same parameters and
/// different seeds.
///
/// ```
/// # use granular_edmd_study::vibrated_box::{Base, VibratedBox};
/// # use granular_edmd_study::{Control, Plan, Protocol, Study};
/// # let base = Base::Thermal { temperature: 1.0, slip: false };
/// # let plan = Plan::new(VibratedBox::new(10, 10.0, base).with_gravity(0.1), Protocol::new(10, 20, 1)?, 1)?;
/// # let plan = plan.with_repeats(3)?;
/// # let folder = std::env::temp_dir().join(format!("granular-edmd-point-{}", std::process::id()));
/// # let study = Study::create(&folder, &plan)?;
/// # study.run(&Control::default())?;
/// for point in study.points() {
///     let point = point?;
///     let height = point.mean(|sample| sample.height);
///     println!("{height}, as from {:.1} independent samples", height.independent_samples());
///     assert_eq!((point.records().len(), height.samples()), (3, 60));
/// }
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Point<E: Experiment> {
    pub(super) index: usize,
    pub(super) value: usize,
    /// The records of the finished repeats, at least one.
    pub(super) records: Vec<Record<E>>,
}

impl<E: Experiment> Point<E> {
    /// Returns the index of the point in the grid.
    pub const fn index(&self) -> usize {
        self.index
    }

    /// Returns the index of the value in the ramp.
    pub const fn value_index(&self) -> usize {
        self.value
    }

    /// Returns the direction from which the ramp came to the value; `None` without a ramp.
    pub fn leg(&self) -> Option<Leg> {
        self.records[0].leg()
    }

    /// Returns the experiment, with the parameters of this value.
    pub fn experiment(&self) -> &E {
        self.records[0].experiment()
    }

    /// Returns the records of the finished repeats.
    pub fn records(&self) -> &[Record<E>] {
        &self.records
    }

    /// Returns the mean of a quantity over the samples of all repeats, by [`Estimate::over_repeats`].
    pub fn mean(&self, quantity: impl Fn(&E::Sample) -> f64) -> Estimate {
        Estimate::over_repeats(self.records.iter().map(|record| record.mean(&quantity)))
    }

    /// Returns the mean of the column of this name over all repeats; `None` if there is no such column, or it
    /// has no error.
    pub fn estimate(&self, column: &str) -> Option<Estimate> {
        let columns = E::columns();
        let column = with_error(&columns, column)?;
        Some(Estimate::over_repeats(self.records.iter().filter_map(|record| column.estimate(record))))
    }
}
