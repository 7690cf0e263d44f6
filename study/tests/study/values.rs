//! Values: their records, their length, and their ends.

use granular_edmd_study::vibrated_box::{Base, VibratedBox};
use granular_edmd_study::{Course, Experiment, Leg, Outcome, Plan, Protocol, Ramp, Record};

use crate::support::{AnyError, BASE, done, small_box, small_plan};

#[test]
fn a_study_records_what_it_was_asked_for() {
    let (_scratch, study) = done(&small_plan(), "records");
    let records: Vec<_> = study.records().map(Result::unwrap).collect();
    assert_eq!(records.len(), 10);
    for record in &records {
        assert_eq!(record.outcome(), &Outcome::Completed);
        assert_eq!(record.samples().len(), 6);
        assert_eq!(record.seed(), study.plan().ramp_seed(record.ramp_index()));
        let sampled: u64 = record.samples().iter().map(|sample| sample.collisions).sum();
        assert!(sampled > 0 && sampled < record.counters().disk_collisions, "settling has collisions too");
        // All disks are in the profile: its area is theirs.
        let area: f64 = record.profile().map(|(_, fraction)| fraction * 10.0).sum();
        approx::assert_relative_eq!(area, 30.0 * std::f64::consts::FRAC_PI_4, max_relative = 1e-3);
        assert!(record.energy_change().mean() < 0.0 && record.energy_change().standard_error() > 0.0);
        // Samples have a column of this name, too, whose mean would count samples without collisions.
        assert_eq!(record.estimate("energy_change"), Some(record.energy_change()));
        assert!(
            !record.energy_change().is_converged() && !record.mean(|sample| sample.height).is_converged()
        );
    }
    let friction: Vec<_> = records[..5].iter().map(|r| r.experiment().friction).collect();
    assert_eq!(friction, [0.01, 0.1, 0.3, 0.1, 0.01]);
    assert_eq!(records[3].leg(), Some(Leg::Down));
    // Time goes on through a ramp, and samples are at whole periods.
    let period = std::f64::consts::TAU / 10.0;
    approx::assert_relative_eq!(records[1].times()[0], (85.0 + 35.0) * period, max_relative = 1e-12);
    assert_ne!(records[0].samples(), records[5].samples(), "ramps have seeds of their own");
}

/// A value has the same length and samples as one made by hand with the engine.
#[test]
fn a_value_is_the_engine_s_run() -> Result<(), AnyError> {
    use granular_edmd::observable::{OrderParameters, SampleTimes, Series};
    let plan = Plan::new(small_box(), Protocol::new(25, 6, 10)?, 7)?.with_end_states();
    let (_scratch, study) = done(&plan, "engine");
    let record = study.record(0, 0)?.ok_or("no record")?;
    let long = Plan::new(small_box(), Protocol::new(0, 85, 1)?, 7)?.with_end_states();
    let (_scratch, study) = done(&long, "engine-every");
    let every = study.record(0, 0)?.ok_or("no record")?;
    let thinned: Vec<_> = every.samples().iter().skip(34).step_by(10).map(|sample| sample.one_roll).collect();
    assert_eq!(record.samples().iter().map(|sample| sample.one_roll).collect::<Vec<_>>(), thinned);
    let [state, same] = [&record, &every].map(Record::checkpoint);
    let (state, same) = (state.ok_or("no state")?, same.ok_or("no state")?);
    assert_eq!(state.to_bytes()?, same.to_bytes()?);
    // From its last state, it goes on like any other run.
    let container = granular_edmd::boundary::Container::closed(10.0, 30.0)?.with_motion(
        granular_edmd::boundary::Wall::Floor,
        granular_edmd::wall::BiParabolic::new(0.1, 10.0)?,
    )?;
    let rule = granular_edmd::collision::ContactDuration::new(
        granular_edmd::collision::Frictional::from_inelasticity(0.05, 0.05, 0.0)?,
        1e-4,
    )?;
    let scheduler = granular_edmd::scheduler::TournamentTree::default();
    let resumption = granular_edmd::Simulation::resume(state, rule, container);
    let mut run = resumption.with_another_rule().scheduler(scheduler).build()?;
    let period = std::f64::consts::TAU / 10.0;
    let times = SampleTimes::every(10.0 * period)?.starting_at(95.0 * period)?;
    let mut series = Series::new(OrderParameters, times);
    run.run_until(95.0 * period, &mut series)?;
    assert_eq!(series.values().len(), 1);
    Ok(())
}

#[test]
fn other_parameters_ramp_and_other_bases_run() -> Result<(), AnyError> {
    let thermal =
        VibratedBox::new(30, 10.0, Base::Thermal { temperature: 1.0, slip: false }).with_gravity(0.1);
    let ramps = [
        (small_box(), "gravity", vec![0.01, 0.02]),
        (small_box(), "amplitude", vec![0.1, 0.2]),
        (small_box(), "inelasticity", vec![0.0, 0.1]),
        (thermal, "temperature", vec![1.0, 2.0]),
    ];
    for (system, parameter, values) in ramps {
        let ramp = Ramp::new(parameter, values.clone(), Course::Down)?;
        let plan = Plan::new(system, Protocol::new(5, 3, 5)?, 1)?.with_ramp(ramp)?;
        let (_scratch, study) = done(&plan, &format!("other-{parameter}"));
        let last = study.record(0, 1)?.ok_or("no record")?;
        assert_eq!(last.parameter(parameter), Some(values[0].into()));
        assert_eq!(last.outcome(), &Outcome::Completed);
    }
    Ok(())
}

/// Without the contact-duration model, lossy disks stall on a vibrated floor. That is an outcome of the
/// value, and the study goes on.
#[test]
fn a_stalled_value_does_not_stop_the_study() -> Result<(), AnyError> {
    let system = VibratedBox::new(30, 10.0, BASE).with_height(30.0).with_gravity(0.5);
    let ramp = Ramp::new("inelasticity", vec![0.0, 0.45], Course::UpAndDown)?;
    let plan = Plan::new(system, Protocol::new(50, 5, 10)?, 1)?.with_ramp(ramp)?.with_end_states();
    let (_scratch, study) = done(&plan, "stalled");
    let outcomes: Vec<_> =
        study.records().map(|record| record.map(|r| r.outcome().name())).collect::<Result<_, _>>()?;
    assert_eq!(outcomes, ["completed", "stalled", "completed"]);
    let (before, stalled, after) = (study.record(0, 0)?, study.record(0, 1)?, study.record(0, 2)?);
    let time = |record: &Option<granular_edmd_study::Record<VibratedBox>>| {
        record.as_ref().and_then(|r| r.checkpoint()).map(granular_edmd::simulation::Checkpoint::time)
    };
    assert_eq!(time(&before), time(&stalled), "the next value starts where this one did");
    assert!(time(&after) > time(&stalled));
    Ok(())
}

/// Walls have the rule of the disks unless the box says otherwise; the base can differ from the other walls.
#[test]
fn walls_have_the_rule_of_the_disks_or_one_of_their_own() -> Result<(), AnyError> {
    let box_ = small_box().with_friction(0.1);
    let end = |experiment: VibratedBox| -> Result<_, AnyError> {
        let mut run = experiment.build(3).map_err(|error| error.to_string())?;
        run.run_until(100.0, &mut ())?;
        Ok(run.disks())
    };
    let stated = end(box_.clone())?;
    let with = |change: fn(&mut VibratedBox)| {
        let mut changed = box_.clone();
        change(&mut changed);
        changed
    };
    let rubbing = with(|walls| (walls.wall_friction, walls.wall_inelasticity) = (Some(0.1), Some(0.05)));
    assert_eq!(end(rubbing)?, stated);
    let elastic = end(with(|walls| walls.wall_inelasticity = Some(0.0)))?;
    let elastic_base = end(with(|walls| walls.base_inelasticity = Some(0.0)))?;
    assert!(elastic != stated && elastic_base != stated && elastic_base != elastic);
    assert_eq!(end(with(|walls| walls.base_inelasticity = Some(0.05)))?, stated);
    let base = |normal: f64| {
        let mut walls = with(|walls| walls.base_tangential_inelasticity = Some(0.05));
        walls.base_inelasticity = Some(normal);
        walls
    };
    assert_eq!(end(base(0.05))?, stated);
    let elastic_normal = end(base(0.0))?;
    assert!(elastic_normal != stated && elastic_normal != elastic_base);
    assert_ne!(end(with(|walls| walls.wall_friction = Some(0.0)))?, stated);
    let refused = with(|walls| walls.wall_inelasticity = Some(0.7)).boundary().unwrap_err().to_string();
    assert!(refused.contains("0.7"), "{refused}");
    Ok(())
}
