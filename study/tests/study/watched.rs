//! Experiments with an observer that must be built, and columns whose names are made when the program runs;
//! ramps and points that do not exist.

use std::fs;

use granular_edmd::boundary::Container;
use granular_edmd::collision::Elastic;
use granular_edmd::observable::{HeightProfile, SampleTimes, Sampled, Snapshot};
use granular_edmd::{Disk, Fingerprint, Gravity, initial};
use granular_edmd_study::{
    Axis, Column, Control, Course, Experiment, ExperimentError, Plan, PlanError, Protocol, Ramp, RampStatus,
    Record, Study, StudyError, Table, Width,
};
use serde::{Deserialize, Serialize};

use crate::support::{AnyError, Scratch};
use support::report::report;

/// Disks that are watched by a profile up to a height.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Watched {
    top: f64,
    weight: f64,
}

impl Experiment for Watched {
    type Rule = Elastic;
    type Boundary = Container;
    type Observer = Sampled<HeightProfile>;
    type Sample = Vec<f64>;

    fn revision() -> Fingerprint {
        Fingerprint::of("Watched")
    }

    fn rule(&self) -> Result<Elastic, ExperimentError> {
        Ok(Elastic)
    }

    fn boundary(&self) -> Result<Container, ExperimentError> {
        Ok(Container::closed(6.0, 6.0)?)
    }

    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        let disks = initial::lattice(&self.boundary()?, 4, 0.5)?;
        Ok(initial::with_maxwellian_velocities(disks, 1.0, seed)?)
    }

    fn gravity(&self) -> Gravity {
        self.weight.into()
    }

    fn observer(&self) -> Result<Sampled<HeightProfile>, ExperimentError> {
        Ok(Sampled::new(HeightProfile::new(0.0, self.top, 2)?, SampleTimes::every(0.1)?))
    }

    fn sample(&self, _: &Snapshot<'_>, profile: &mut Sampled<HeightProfile>) -> Vec<f64> {
        profile.iter().map(|(_, fraction)| fraction).collect()
    }

    fn columns() -> Vec<Column<Self>> {
        let layer = |index: usize| {
            Column::sampled(format!("layer_{index}"), "1", move |sample: &Vec<f64>| sample[index])
        };
        (0..2).map(layer).collect()
    }

    fn tables() -> Vec<Table<Self>> {
        let headings = ["first", "second"].map(|name| (name, String::from("1")));
        vec![Table::new(String::from("layers"), headings, |record| record.samples().to_vec())]
    }

    fn state(record: &Record<Self>) -> Option<String> {
        Some(if record.experiment().weight < 0.5 { "light" } else { "heavy" }.to_owned())
    }
}

fn plan() -> Result<Plan<Watched>, PlanError> {
    let watched = Watched { top: 6.0, weight: 0.1 };
    let ramp = Ramp::new("weight", [0.1, 1.0], Course::Up)?.with_refinement(Width::Absolute(0.5))?;
    Plan::new(watched, Protocol::new(1, 3, 1)?, 1)?.with_ramp(ramp)
}

#[test]
fn an_observer_that_cannot_be_built_refuses_the_plan() -> Result<(), AnyError> {
    let error = report(&plan()?.with_axis(Axis::new("top", [6.0, -1.0])?).unwrap_err());
    assert!(error.contains("top = -1"), "{error}");
    Ok(())
}

#[test]
fn names_of_columns_may_be_made_when_the_program_runs() -> Result<(), AnyError> {
    let scratch = Scratch::new("watched-names");
    let study = Study::create(&scratch.0, &plan()?)?;
    assert!(study.run(&Control::default())?.is_complete());
    let values = fs::read_to_string(scratch.0.join("values.csv"))?;
    assert!(
        values.starts_with("ramp,value,leg,weight,seed,made_by,outcome,samples,layer_0,layer_0_error,"),
        "{values}"
    );
    assert!(values.contains(",layer_1,layer_1_error,layer_1_independent_samples,"), "{values}");
    let layers = fs::read_to_string(scratch.0.join("layers.csv"))?;
    assert!(layers.starts_with("ramp,value,leg,weight,first,second\n"), "{layers}");
    let record = study.record(0, 0)?.ok_or("not done")?;
    assert!(
        record
            .estimate("layer_1")
            .is_some_and(|layer| layer.mean() == record.mean(|sample| sample[1]).mean())
    );
    Ok(())
}

#[test]
fn ramps_that_do_not_exist_are_errors() -> Result<(), AnyError> {
    let scratch = Scratch::new("watched-places");
    let study = Study::create(&scratch.0, &plan()?)?;
    assert_eq!(study.all_status()?, [RampStatus::Waiting]);
    let is_no_ramp = |error: Option<StudyError>| matches!(error, Some(StudyError::Absent { count: 1, .. }));
    for ramp in [1, usize::MAX] {
        assert!(is_no_ramp(study.record(ramp, 0).err()));
        assert!(is_no_ramp(study.transitions(ramp).err()));
        assert!(is_no_ramp(study.run_ramp(ramp, &Control::default()).err()));
        // The ramp is refined, so the number of its records is not known.
        let mut records = study.ramp_records(ramp);
        assert!(is_no_ramp(records.next().and_then(Result::err)) && records.next().is_none());
    }
    Ok(())
}
