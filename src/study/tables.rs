//! Records as tables.

use std::fmt::{Debug, Display, Write};

use super::record::Record;
use super::{Parameter, Sample};
use crate::statistics::Estimate;

/// A quantity of a sample, by its name in tables.
type Quantity = (&'static str, fn(&Sample) -> f64);

/// The quantities whose means are in the table of values.
const QUANTITIES: [Quantity; 7] = [
    ("one_roll", |sample| sample.one_roll),
    ("one_roll_magnitude", |sample| sample.one_roll.abs()),
    ("two_rolls", |sample| sample.two_rolls),
    ("height", |sample| sample.height),
    ("translational_energy", |sample| sample.translational_energy),
    ("rotational_energy", |sample| sample.rotational_energy),
    ("vertical_temperature", |sample| sample.vertical_temperature),
];

/// The three tables of a study, as they grow.
pub(super) struct Tables {
    varied: Vec<Parameter>,
    pub(super) values: String,
    pub(super) samples: String,
    pub(super) profiles: String,
}

impl Tables {
    /// Tables with a first line and no rows.
    ///
    /// The last column of the table of values names the quantities whose error is a lower bound, apart by
    /// spaces: they have too few samples for their correlations.
    pub(super) fn new(varied: Vec<Parameter>) -> Self {
        let mut place = String::from("ramp,value,leg");
        for parameter in &varied {
            append_name(&mut place, parameter);
        }
        let mut values = format!("{place},seed,outcome,samples");
        for (name, _) in QUANTITIES {
            append_name(&mut values, name);
            append_name(&mut values, &format_args!("{name}_error"));
        }
        values.push_str(",energy_change,energy_change_error,thermal_noise,densest_packing,densest_height");
        values
            .push_str(",collisions,wall_collisions,contact_duration_collisions,max_overlap,not_converged\n");
        let samples = format!(
            "{place},time,one_roll,two_rolls,height,translational_energy,rotational_energy,vertical_temperature,\
             collisions,energy_change\n"
        );
        let profiles = format!("{place},height,packing_fraction\n");
        Self { varied, values, samples, profiles }
    }

    /// Adds the rows of a record.
    pub(super) fn add(&mut self, record: &Record) {
        let place = self.place(record);
        self.add_value(record, &place);
        record.samples().iter().for_each(|sample| add_sample(&mut self.samples, sample, &place));
        for (height, fraction) in record.profile() {
            row(&mut self.profiles, &place, &[&height, &fraction]);
        }
    }

    /// The first columns of all rows of a record.
    fn place(&self, record: &Record) -> String {
        let mut place = format!("{},{},", record.ramp(), record.value());
        if let Some(leg) = record.leg() {
            place.push_str(&leg.to_string());
        }
        for &parameter in &self.varied {
            append(&mut place, &record.system().get(parameter).unwrap_or(f64::NAN));
        }
        place
    }

    fn add_value(&mut self, record: &Record, place: &str) {
        let mut line =
            format!("{place},{},{},{}", record.seed(), record.outcome().name(), record.samples().len());
        let mut not_converged = Vec::new();
        let means = QUANTITIES.into_iter().map(|(name, quantity)| (name, record.mean(quantity)));
        for (name, estimate) in means.chain([("energy_change", record.energy_change())]) {
            append_estimate(&mut line, estimate);
            not_converged.extend((!estimate.is_converged()).then_some(name));
        }
        append(&mut line, &record.thermal_noise());
        let densest = record.densest_layer();
        append(&mut line, &densest.map_or(f64::NAN, |layer| layer.packing_fraction));
        append(&mut line, &densest.map_or(f64::NAN, |layer| layer.height));
        let counters = record.counters();
        for count in [counters.collisions, counters.wall_collisions, counters.contact_duration_collisions] {
            append(&mut line, &count);
        }
        append(&mut line, &counters.max_overlap);
        append_name(&mut line, &not_converged.join(" "));
        row(&mut self.values, &line, &[]);
    }
}

fn add_sample(table: &mut String, sample: &Sample, place: &str) {
    let Sample { time, one_roll, two_rolls, height, translational_energy, rotational_energy, .. } = sample;
    let Sample { vertical_temperature, collisions, energy_change, .. } = sample;
    row(
        table,
        place,
        &[
            time,
            one_roll,
            two_rolls,
            height,
            translational_energy,
            rotational_energy,
            vertical_temperature,
            collisions,
            energy_change,
        ],
    );
}

fn row(table: &mut String, place: &str, cells: &[&dyn Debug]) {
    table.push_str(place);
    for cell in cells {
        append(table, cell);
    }
    table.push('\n');
}

fn append_estimate(line: &mut String, estimate: Estimate) {
    append(line, &estimate.mean());
    append(line, &estimate.standard_error());
}

fn append(line: &mut String, cell: &(impl Debug + ?Sized)) {
    // Numbers as they read back, with an exponent where one is due; writing to a string does not fail.
    let _ = write!(line, ",{cell:?}");
}

fn append_name(line: &mut String, name: &(impl Display + ?Sized)) {
    let _ = write!(line, ",{name}");
}
