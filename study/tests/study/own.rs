//! Experiments of users, which are swept, ramped, recorded, resumed, or refused with an error.

use std::fs;
use std::sync::atomic::{AtomicU32, Ordering};

use granular_edmd::boundary::Container;
use granular_edmd::collision::Smooth;
use granular_edmd::observable::{Observer, Snapshot};
use granular_edmd::{Disk, Fingerprint, Gravity, initial};
use granular_edmd_study::{
    Axis, Column, Control, Course, Experiment, ExperimentError, Plan, PlanError, Protocol, Ramp, Record,
    Scalar, Study, StudyError,
};
use serde::{Deserialize, Serialize};

use crate::logs;
use crate::mixture::{Mixture, Sticky, mixture};
use crate::support::{AnyError, Scratch, assert_same, contents, run_with_interruptions};
use support::report::report;

/// Coupled parameters: the weight is ramped, the loss and the mixture differ between ramps.
fn plan() -> Plan<Mixture> {
    Plan::new(mixture(), Protocol::new(4, 5, 2).unwrap().with_phase(0.5).unwrap(), 3)
        .and_then(|plan| plan.with_axis(Axis::new("loss", [0.0, 0.2]).unwrap()))
        .and_then(|plan| plan.with_axis(Axis::new("disks.large", [2.0, 4.0]).unwrap()))
        .and_then(|plan| plan.with_ramp(Ramp::new("weight", [0.1, 0.2], Course::UpAndDown).unwrap()))
        .unwrap()
}

fn done(name: &str) -> (Scratch, Study<Mixture>) {
    let scratch = Scratch::new(name);
    let study = Study::create(&scratch.0, &plan()).unwrap();
    assert!(study.run(&Control::default()).unwrap().is_complete());
    (scratch, study)
}

#[test]
fn an_own_experiment_is_swept_ramped_and_recorded() -> Result<(), AnyError> {
    let (scratch, study) = done("own");
    let records: Vec<_> = study.records().collect::<Result<_, _>>()?;
    assert_eq!(records.len(), 4 * 3);
    assert_eq!(
        study.plan().parameters(1, 0)[1],
        ("disks.large", Scalar::Integer(4)),
        "numbers of the field's kind"
    );
    assert_eq!(records[3].experiment().disks.large, 4);
    assert!(records[3].checkpoint().is_some());
    // The cycle changes along the ramp, and the next value starts at the end of the previous one.
    let cycles = [1.0 / 1.1, 1.0 / 1.2];
    let expected = 14.0 * cycles[0] + (4.0 + 1.5) * cycles[1];
    assert!((records[1].times()[0] - expected).abs() < 1e-9, "{} {expected}", records[1].times()[0]);
    assert!(records.iter().all(|record| record.samples().iter().any(|sample| sample.collisions > 0)));
    let lengths: Vec<usize> = records.iter().flat_map(Record::samples).map(|s| s.heights.len()).collect();
    assert!(lengths.iter().any(|length| *length != lengths[0]), "samples are of variable length");
    let heights = fs::read_to_string(scratch.0.join("heights.csv"))?;
    assert!(heights.starts_with("ramp,value,leg,loss,disks.large,weight,sample,height\n"), "{heights}");
    assert_eq!(heights.lines().count(), 1 + lengths.iter().sum::<usize>());
    Ok(())
}

#[test]
fn an_own_experiment_goes_on_with_the_same_bytes() {
    let (expected, _) = done("own-not-interrupted");
    let scratch = Scratch::new("own-interrupted");
    assert!(run_with_interruptions(&scratch.0, &plan(), |_| 12, |_| {}) > 1);
    assert_same(&scratch.0, &expected.0);
}

#[test]
fn a_damaged_record_of_one_s_own_is_done_again() -> Result<(), AnyError> {
    let (scratch, study) = done("own-damaged");
    let before = contents(&scratch.0);
    drop(study);
    let sound = logs::record(&scratch.0, 2, 1);
    for cut in [0, 20, sound.len() / 2, sound.len() - 1] {
        logs::replace(&scratch.0, 2, 1, &sound[..cut]);
        let study = Study::<Mixture>::open(&scratch.0)?;
        assert!(matches!(study.record(2, 1), Err(StudyError::Damaged { .. })));
        let redone = study.run(&Control::default().with_verification())?.redone;
        assert_eq!(redone, [scratch.0.join("blocks/0002.log")]);
        assert!(contents(&scratch.0) == before);
    }
    Ok(())
}

#[test]
fn unknown_parameters_are_refused_with_those_that_there_are() {
    let refused = |name: &str| report(&plan().with_axis(Axis::new(name, [1.0]).unwrap()).unwrap_err());
    let error = refused("wieght");
    assert!(
        error.contains("no parameter `wieght`") && error.contains("disks.large, disks.small, loss, weight"),
        "{error}"
    );
    assert!(refused("loss.small").contains("no parameter `loss.small`"));
    assert!(refused("disks.medium").contains("unknown field `medium`"));
    assert!(refused("large").contains("varies twice"), "the last part of a name is enough");
    let note = Plan::new(mixture(), Protocol::new(1, 1, 1).unwrap(), 1)
        .unwrap()
        .with_axis(Axis::new("note", ["a", "b"]).unwrap());
    assert_eq!(
        note.unwrap().experiment(1, 0).unwrap().note.as_deref(),
        Some("b"),
        "a parameter without a value is one"
    );
    let error = report(&plan().with_axis(Axis::new("small", [1.5]).unwrap()).unwrap_err());
    assert!(error.contains("the experiment cannot be at small = 1.5"), "{error}");
}

#[test]
fn parameters_that_are_refused_are_named_when_the_plan_is_made() {
    let error = Plan::new(mixture(), Protocol::new(1, 1, 1).unwrap(), 1)
        .and_then(|plan| plan.with_axis(Axis::new("loss", [0.1, -0.5]).unwrap()))
        .unwrap_err();
    assert_eq!(
        report(&error),
        "the experiment cannot be at loss = -0.5: loss must be finite and not negative, but is -0.5"
    );
    let crowd = Plan::new(mixture(), Protocol::new(1, 1, 1).unwrap(), 1)
        .and_then(|plan| plan.with_axis(Axis::new("large", [4, 100_000]).unwrap()))
        .unwrap_err();
    assert!(
        matches!(&crowd, PlanError::Experiment { place, .. } if place == " at large = 100000"),
        "{crowd}"
    );
}

/// Ignores parameters that it does not know, and has samples that cannot be read back.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Careless {
    loss: f64,
}

#[derive(Serialize, Deserialize)]
struct Gap {
    #[serde(skip_serializing_if = "Option::is_none")]
    maybe: Option<f64>,
    always: f64,
}

/// Ends the value after this many collisions.
#[derive(Debug, Default, Serialize, Deserialize)]
struct Patience(u64);

impl Observer for Patience {
    fn on_collision(&mut self, _: &granular_edmd::observable::Collision) {
        self.0 += 1;
    }

    fn verdict(&mut self) -> Result<std::ops::ControlFlow<()>, granular_edmd::observable::ObserverError> {
        use std::ops::ControlFlow::{Break, Continue};
        Ok(if self.0 >= 40 { Break(()) } else { Continue(()) })
    }
}

impl Experiment for Careless {
    type Rule = Sticky;
    type Boundary = Container;
    type Observer = Patience;
    type Sample = Gap;

    fn revision() -> Fingerprint {
        Fingerprint::of("Careless")
    }

    fn rule(&self) -> Result<Sticky, ExperimentError> {
        Ok(Sticky { loss: self.loss })
    }

    fn boundary(&self) -> Result<Container, ExperimentError> {
        Ok(Container::closed(6.0, 6.0)?)
    }

    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        let disks = initial::lattice(&self.boundary()?, 5, 0.5)?;
        Ok(initial::with_maxwellian_velocities(disks, 1.0, seed)?)
    }

    fn observer(&self) -> Result<Patience, ExperimentError> {
        Ok(Patience::default())
    }

    fn sample(&self, snapshot: &Snapshot<'_>, _: &mut Patience) -> Gap {
        let speed = snapshot.mean(|disk| disk.velocity().length());
        Gap { maybe: (self.loss > 0.0).then_some(speed), always: speed }
    }

    fn columns() -> Vec<Column<Self>> {
        vec![Column::sampled("speed", "velocity", |sample: &Gap| sample.maybe.unwrap_or(sample.always))]
    }
}

#[test]
fn a_parameter_that_the_experiment_ignores_is_none() {
    let plan = Plan::new(Careless { loss: 0.0 }, Protocol::new(1, 1, 1).unwrap(), 1).unwrap();
    let error = report(&plan.with_axis(Axis::new("los", [0.0]).unwrap()).unwrap_err());
    assert!(error.contains("no parameter `los` (the experiment ignores it); there are loss"), "{error}");
}

#[test]
fn samples_that_do_not_read_back_are_an_error_and_no_record() -> Result<(), AnyError> {
    let scratch = Scratch::new("own-careless");
    let study = Study::create(&scratch.0, &Plan::new(Careless { loss: 0.0 }, Protocol::new(1, 2, 1)?, 1)?)?;
    let error = study.run(&Control::default()).unwrap_err();
    assert!(matches!(error, StudyError::Encode { .. }), "{error}");
    assert!(report(&error).contains("skip_serializing_if"), "{error}");
    assert!(study.record(0, 0)?.is_none());
    Ok(())
}

#[test]
fn an_observer_ends_a_value_and_the_ramp_goes_on_from_there() -> Result<(), AnyError> {
    let plan = Plan::new(Careless { loss: 0.1 }, Protocol::new(0, 50, 1)?, 1)?;
    let plan = plan.with_ramp(Ramp::new("loss", [0.1, 0.2], Course::Up)?)?;
    let scratch = Scratch::new("own-stopped");
    let study = Study::create(&scratch.0, &plan)?;
    assert!(study.run(&Control::default())?.is_complete());
    let [first, second] = [0, 1].map(|value| study.record(0, value).unwrap().unwrap());
    assert_eq!(first.outcome().name(), "stopped");
    assert!(!first.samples().is_empty() && first.samples().len() < 50);
    assert_eq!(first.observer().0, 40);
    assert!(
        second.times()[0] > first.checkpoint().unwrap().time()
            && second.times()[0] <= first.checkpoint().unwrap().time() + 1.0 + 1e-9
    );
    Ok(())
}

/// Loss in hundredths that the code adds for three disks, as if somebody had changed it. Tests that run at
/// the same time have other numbers of disks.
static ADDED: AtomicU32 = AtomicU32::new(0);

/// Disks that fall, and at large losses come to rest, where time stalls.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Fall {
    count: usize,
    loss: f64,
    labels: Labels,
}

/// Parameters that have the names of columns.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
struct Labels {
    seed: f64,
    time: f64,
    samples: f64,
    height_error: f64,
    height_independent_samples: f64,
    height: f64,
}

fn fall(count: usize, loss: f64) -> Fall {
    Fall { count, loss, labels: Labels::default() }
}

impl Experiment for Fall {
    type Rule = Smooth;
    type Boundary = Container;
    type Observer = ();
    type Sample = f64;

    fn revision() -> Fingerprint {
        Fingerprint::of("Fall")
    }

    fn rule(&self) -> Result<Smooth, ExperimentError> {
        let added = if self.count == 3 { ADDED.load(Ordering::Relaxed) } else { 0 };
        Ok(Smooth::from_inelasticity(self.loss + 0.01 * f64::from(added))?)
    }

    fn boundary(&self) -> Result<Container, ExperimentError> {
        Ok(Container::closed(6.0, 20.0)?)
    }

    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        let disks = initial::lattice(&self.boundary()?, self.count, 0.5)?;
        Ok(initial::with_maxwellian_velocities(disks, 1.0, seed)?)
    }

    fn gravity(&self) -> Gravity {
        1.0.into()
    }

    fn observer(&self) -> Result<(), ExperimentError> {
        Ok(())
    }

    fn sample(&self, snapshot: &Snapshot<'_>, (): &mut ()) -> f64 {
        snapshot.mean(|disk| disk.position().y)
    }

    fn columns() -> Vec<Column<Self>> {
        vec![Column::sampled("height", "length", |height| *height)]
    }
}

/// Otherwise a table would have two columns of one name, and readers by name would see only one.
#[test]
fn a_parameter_of_the_name_of_a_column_cannot_vary() -> Result<(), AnyError> {
    let plan = Plan::new(fall(4, 0.0), Protocol::new(0, 2, 1)?, 1)?;
    for name in ["seed", "time", "samples", "height_error", "height_independent_samples"] {
        let expected =
            format!("{name:?} cannot be the name of a varied parameter: a column of the tables has it");
        let swept = plan.clone().with_axis(Axis::new(name, [0.0, 1.0])?);
        let ramped = plan.clone().with_ramp(Ramp::new(name, [0.0, 1.0], Course::Up)?);
        assert_eq!([swept, ramped].map(|plan| report(&plan.unwrap_err())), [expected.clone(), expected]);
    }
    let error = report(&plan.clone().with_axis(Axis::new("height", [0.0, 1.0])?).unwrap_err());
    assert_eq!(error, "\"height\" cannot be the name of a column: another one has it");
    for name in ["repeat", "outcome", "labels.time_error"] {
        let error = report(&plan.clone().with_axis(Axis::new(name, [0.0, 1.0])?).unwrap_err());
        assert!(error.contains(&format!("there is no parameter `{name}`")), "{error}");
    }
    Ok(())
}

#[test]
fn a_parameter_of_the_first_disks_alone_cannot_be_ramped() -> Result<(), AnyError> {
    let plan = Plan::new(fall(4, 0.0), Protocol::new(0, 2, 1)?, 1)?;
    plan.clone().with_ramp(Ramp::new("loss", [0.0, 0.1], Course::Up)?)?;
    let error = plan.with_ramp(Ramp::new("count", [4.0, 8.0], Course::Up)?).unwrap_err();
    assert_eq!(report(&error), "count cannot be ramped with the disks in place; sweep it instead");
    Ok(())
}

#[test]
fn values_that_stall_are_counted_and_say_why() -> Result<(), AnyError> {
    let plan = Plan::new(fall(12, 0.4), Protocol::new(0, 200, 1)?, 1)?.with_repeats(3)?;
    let scratch = Scratch::new("failed");
    let study = Study::create(&scratch.0, &plan)?;
    for summary in [study.run(&Control::default())?, study.run(&Control::default().with_verification())?] {
        assert_eq!((summary.finished, summary.failed), (3, 3));
    }
    let outcome = study.record(0, 0)?.ok_or("no record")?.outcome().clone();
    assert!(outcome.reason().is_some_and(|reason| reason.contains("stalled")), "{outcome:?}");
    let points = fs::read_to_string(scratch.0.join("points.csv"))?;
    assert!(points.starts_with("point,value,leg,repeats,failed,height,"), "{points}");
    assert!(points.lines().nth(1).is_some_and(|line| line.starts_with("0,0,,3,3,")), "{points}");
    Ok(())
}

#[test]
fn records_of_changed_code_are_refused() -> Result<(), AnyError> {
    let plan = Plan::new(fall(3, 0.0), Protocol::new(0, 2, 1)?, 1)?;
    let scratch = Scratch::new("changed");
    let study = Study::create(&scratch.0, &plan)?;
    study.run(&Control::default())?;
    ADDED.store(1, Ordering::Relaxed);
    let refused = [study.record(0, 0).map(drop), study.run(&Control::default()).map(drop)];
    ADDED.store(0, Ordering::Relaxed);
    let [record, run] = refused.map(Result::unwrap_err);
    assert!(record.to_string().contains("was made with another rule"), "{record}");
    assert!(matches!(&run, StudyError::Code { .. }) && run.to_string().contains("rule is"), "{run}");
    assert!(study.record(0, 0)?.is_some(), "nothing was touched");
    Ok(())
}
