//! Convective states from the records of the box, and the columns of its tables.

use granular_edmd::observable::{ConvectionOrder, DenseLayer};
use granular_edmd::statistics::Estimate;

use super::{Sample, VibratedBox};
use crate::analysis::thermal_noise;
use crate::{Column, Experiment, Record, Table};

/// Convection, layers and energy loss in a record of the box.
///
/// ```no_run
/// use granular_edmd_study::analysis::StateCriteria;
/// use granular_edmd_study::Study;
/// use granular_edmd_study::vibrated_box::VibratedBox;
///
/// for record in Study::<VibratedBox>::open("study")?.records() {
///     let record = record?;
///     let (noise, layer) = (record.thermal_noise(), record.densest_layer());
///     println!("{}", StateCriteria::default().classify(&record.order(), noise, layer)?.state());
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
impl Record<VibratedBox> {
    /// Returns $`(\Psi_1, \Psi_2)`$ of each sample.
    pub fn order(&self) -> Vec<ConvectionOrder> {
        let order = |sample: &Sample| ConvectionOrder::new(sample.one_roll, sample.two_rolls);
        self.samples().iter().map(order).collect()
    }

    /// Returns the packing fraction by height, averaged over the samples: heights of the middles of bins of
    /// one diameter, and fractions.
    pub fn profile(&self) -> impl Iterator<Item = (f64, f64)> {
        self.observer().profile()
    }

    /// Returns the densest layer of the profile, or `None` without samples.
    pub fn densest_layer(&self) -> Option<DenseLayer> {
        DenseLayer::among(self.profile())
    }

    /// Returns the mean energy change in a collision of two disks, over all collisions.
    pub fn energy_change(&self) -> Estimate {
        let collisions: f64 = self.samples().iter().map(|sample| sample.collisions as f64).sum();
        let total: f64 = self.samples().iter().map(|s| s.collisions as f64 * s.energy_change).sum();
        let mean = total / collisions;
        let per_sample = collisions / self.samples().len() as f64;
        // The error of a ratio is the error of the mean residual, over the mean number of collisions.
        self.mean(|s| s.collisions as f64 * (s.energy_change - mean) / per_sample).about(mean)
    }

    /// Returns the standard deviation of $`\Psi_1`$ and $`\Psi_2`$ in a gas at rest of this temperature,
    /// $`\sqrt{T_y/2N}`$.
    pub fn thermal_noise(&self) -> f64 {
        let temperature = self.mean(|sample| sample.vertical_temperature).mean();
        thermal_noise(temperature, 1.0, self.experiment().disks).unwrap_or(f64::NAN)
    }
}

/// Returns the columns of the tables of values and samples. None has the name of a parameter, which could
/// then not vary.
pub(super) fn columns() -> Vec<Column<VibratedBox>> {
    vec![
        Column::of_record("state", "", |record| VibratedBox::state(record).unwrap_or_default()),
        Column::sampled("one_roll", "velocity", |s: &Sample| s.one_roll),
        Column::averaged("one_roll_magnitude", "velocity", |s: &Sample| s.one_roll.abs()),
        Column::sampled("two_rolls", "velocity", |s: &Sample| s.two_rolls),
        Column::sampled("center_of_mass_height", "diameter", |s: &Sample| s.height),
        Column::sampled("translational_energy", "energy", |s: &Sample| s.translational_energy),
        Column::sampled("rotational_energy", "energy", |s: &Sample| s.rotational_energy),
        Column::sampled("vertical_temperature", "energy", |s: &Sample| s.vertical_temperature),
        Column::of_sample("collisions", "1", |s: &Sample| s.collisions),
        Column::of_sample("energy_change", "energy", |s: &Sample| s.energy_change),
        Column::estimated("energy_change", "energy", Record::energy_change),
        Column::of_record("thermal_noise", "velocity", Record::thermal_noise),
        Column::of_record("densest_packing", "1", |record| {
            record.densest_layer().map_or(f64::NAN, |layer| layer.packing_fraction)
        }),
        Column::of_record("densest_height", "diameter", |record| {
            record.densest_layer().map_or(f64::NAN, |layer| layer.height)
        }),
        Column::of_record("collisions", "1", |record| record.counters().disk_collisions),
        Column::of_record("wall_collisions", "1", |record| record.counters().wall_collisions),
        Column::of_record("contact_duration_collisions", "1", |record| {
            record.counters().contact_duration_collisions
        }),
        Column::of_record("max_overlap", "diameter", |record| record.counters().max_overlap),
        Column::of_record("warnings", "1", |record| record.counters().warnings().len() as f64),
    ]
}

/// Returns the table of profiles.
pub(super) fn tables() -> Vec<Table<VibratedBox>> {
    vec![Table::new("profiles", [("layer_height", "diameter"), ("packing_fraction", "1")], |record| {
        record.profile().map(|(height, fraction)| vec![height, fraction]).collect()
    })]
}
