//! Experiments that are driven or refilled, and values that come to a limit.

use std::fs;
use std::sync::atomic::{AtomicU32, Ordering};

use granular_edmd::Fingerprint;
use granular_edmd::observable::{Observer, ObserverError, SampleTimes, Snapshot, on_collision};
use granular_edmd::prelude::*;
use granular_edmd::simulation::{Inlet, WhiteNoise};
use granular_edmd_files::{ExtendedXyz, Recorder};
use granular_edmd_study::{
    Axis, Column, Control, Course, Experiment, ExperimentError, Plan, Protocol, Ramp, Run, SavedDriving,
    Start, Study,
};
use serde::{Deserialize, Serialize};

use crate::support::{AnyError, Scratch, assert_same, run_with_interruptions};

/// Does a study of this plan without a break, and one that is interrupted after every few steps; their files
/// must be the same.
fn done_twice<E: Experiment>(name: &str, plan: &Plan<E>) -> (Scratch, Study<E>) {
    let scratch = Scratch::new(name);
    let study = Study::create(&scratch.0, plan).unwrap();
    assert!(study.run(&Control::default()).unwrap().is_complete());
    let cut = Scratch::new(&format!("{name}-interrupted"));
    assert!(run_with_interruptions(&cut.0, plan, |run| run % 3, |_| {}) > 1);
    assert_same(&cut.0, &scratch.0);
    (scratch, study)
}

/// A gas that noise heats and collisions cool.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Gas {
    restitution: f64,
    noise: f64,
}

/// The energy that kicks have brought in, and the energy before the next kick.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
struct Heating {
    gained: f64,
    before: Option<f64>,
    kicks: u64,
}

fn energy_of(snapshot: &Snapshot<'_>) -> f64 {
    snapshot.disks().iter().map(Disk::translational_energy).sum()
}

impl Observer for Heating {
    fn on_start(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ObserverError> {
        let gained = self.before.map_or(0.0, |before| energy_of(snapshot) - before);
        self.gained += gained;
        self.kicks += u64::from(gained != 0.0);
        Ok(())
    }
    fn on_end(&mut self, snapshot: &Snapshot<'_>) {
        self.before = Some(energy_of(snapshot));
    }
}

impl Experiment for Gas {
    type Rule = Smooth;
    type Boundary = Container;
    type Observer = Heating;
    type Sample = [f64; 3];

    fn revision() -> Fingerprint {
        Fingerprint::of("Gas")
    }
    fn rule(&self) -> Result<Smooth, ExperimentError> {
        Ok(Smooth::from_restitution(self.restitution)?)
    }
    fn boundary(&self) -> Result<Container, ExperimentError> {
        Ok(Container::periodic(12.0, 12.0)?)
    }
    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        let disks = initial::lattice(&self.boundary()?, 40, 0.5)?;
        Ok(initial::without_drift(initial::with_maxwellian_velocities(disks, 1.0, seed)?)?)
    }
    fn observer(&self) -> Result<Heating, ExperimentError> {
        Ok(Heating::default())
    }
    fn sample(&self, snapshot: &Snapshot<'_>, heating: &mut Heating) -> [f64; 3] {
        [snapshot.mean(Disk::translational_energy), heating.gained, heating.kicks as f64]
    }
    fn columns() -> Vec<Column<Self>> {
        vec![
            Column::sampled("energy", "energy", |[energy, ..]: &[f64; 3]| *energy),
            Column::of_sample("heat", "energy", |[_, heat, _]: &[f64; 3]| *heat),
        ]
    }
    fn driving(&self, seed: u64) -> Result<Option<Box<dyn SavedDriving>>, ExperimentError> {
        if self.noise == 0.0 {
            return Ok(None);
        }
        Ok(Some(Box::new(WhiteNoise::new(self.noise, SampleTimes::every(0.15)?, seed)?)))
    }
}

#[test]
fn a_driven_gas_goes_on_with_its_noise() -> Result<(), AnyError> {
    let plan = Plan::new(Gas { restitution: 0.8, noise: 0.0 }, Protocol::new(4, 6, 2)?, 1)?;
    let plan = plan.with_ramp(Ramp::new("noise", [0.0, 0.5], Course::Up)?)?;
    let plan = plan.with_axis(Axis::new("restitution", [0.8, 0.9])?)?;
    let (_scratch, study) = done_twice("driven-gas", &plan);
    let energy = |ramp, value| study.record(ramp, value).unwrap().unwrap().mean(|sample| sample[0]).mean();
    // Without noise the gas cools; with it, the energy does not depend on the start.
    assert!(energy(0, 0) < 0.3 && energy(0, 1) > 2.0 * energy(0, 0), "{} {}", energy(0, 0), energy(0, 1));
    assert!(energy(1, 1) > energy(0, 1));
    Ok(())
}

#[test]
fn observers_of_a_driven_study_see_each_kick() -> Result<(), AnyError> {
    let plan = Plan::new(Gas { restitution: 1.0, noise: 0.5 }, Protocol::new(2, 6, 2)?, 1)?;
    let (_scratch, study) = done_twice("kicks", &plan);
    let record = study.record(0, 0)?.ok_or("no record")?;
    let [first_energy, first_heat, first_kicks] = record.samples()[0];
    for (&[energy, heat, kicks], time) in record.samples().iter().zip(record.times()) {
        // Kicks alone bring energy into an elastic gas.
        let gained = 40.0 * (energy - first_energy);
        assert!((heat - first_heat - gained).abs() < 1e-9 * (1.0 + gained), "{heat} {gained}");
        let between = (time / 0.15).floor() - (record.times()[0] / 0.15).floor();
        assert!((kicks - first_kicks - between).abs() <= 1.0, "{kicks} of {between}");
    }
    Ok(())
}

/// A silo whose outlet takes grains out, which come in again at the top. A recorder rides along.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Silo {
    outlet: f64,
}

/// The number of grains that came in.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
struct Comings(u64);

impl Observer for Comings {
    fn on_insert(&mut self, _: &Disk, _: f64) {
        self.0 += 1;
    }
}

impl Experiment for Silo {
    type Rule = ContactDuration<Smooth>;
    type Boundary = Container;
    type Observer = Comings;
    type Sample = usize;

    fn revision() -> Fingerprint {
        Fingerprint::of("Silo")
    }
    fn rule(&self) -> Result<Self::Rule, ExperimentError> {
        Ok(ContactDuration::new(Smooth::from_restitution(0.8)?, 1e-2)?)
    }
    fn boundary(&self) -> Result<Container, ExperimentError> {
        let half = 0.5 * self.outlet;
        let plate = |from, to| Part::polyline([DVec2::new(from, 2.0), DVec2::new(to, 2.0)]);
        let vessel = Container::open(10.0)?.absorbing(Wall::Floor)?;
        Ok(vessel
            .with_part("left plate", plate(0.0, 5.0 - half)?)?
            .with_part("right plate", plate(5.0 + half, 10.0)?)?)
    }
    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        let above = |disk: &Disk| disk.with_position(disk.position() + DVec2::new(0.0, 3.0));
        let disks = initial::scattered(&Container::closed(10.0, 14.0)?, 60, 0.5, 14.0, seed)?;
        Ok(disks.iter().map(above).collect::<Result<_, _>>()?)
    }
    fn gravity(&self) -> Gravity {
        1.0.into()
    }
    fn build(&self, seed: u64) -> Result<Run<Self>, ExperimentError> {
        let builder = Simulation::builder(self.rule()?, self.boundary()?).disks(self.disks(seed)?);
        let mut run = builder.gravity(self.gravity()).build()?;
        let places = [DVec2::new(1.0, 18.0), DVec2::new(9.0, 19.0)];
        run.add_inlet(Inlet::refill(places, DVec2::NEG_Y, SampleTimes::every(0.5)?, seed)?)?;
        Ok(run)
    }
    fn observer(&self) -> Result<Comings, ExperimentError> {
        Ok(Comings::default())
    }
    fn sample(&self, snapshot: &Snapshot<'_>, _: &mut Comings) -> usize {
        snapshot.disks().len()
    }
    fn companion(&self, start: &Start<'_>) -> Result<Option<Box<dyn Observer>>, ExperimentError> {
        let path = start.folder.join(format!("frames-{}-{}.xyz", start.ramp, start.value));
        let times = SampleTimes::every(1.5)?;
        let recorder = Recorder::create_or_append(path, ExtendedXyz, times).map_err(ExperimentError::new)?;
        Ok(Some(Box::new(recorder)))
    }
    fn columns() -> Vec<Column<Self>> {
        vec![
            Column::sampled("grains", "1", |grains| *grains as f64),
            Column::of_record("out", "1", |record| record.counters().removals),
        ]
    }
}

#[test]
fn a_silo_is_refilled_and_recorded() -> Result<(), AnyError> {
    let plan = Plan::new(Silo { outlet: 3.0 }, Protocol::new(0, 10, 1)?, 4)?;
    let plan = plan.with_axis(Axis::new("outlet", [2.5, 4.0])?)?;
    let (scratch, study) = done_twice("silo", &plan);
    let out = |ramp| study.record(ramp, 0).unwrap().unwrap().counters().removals;
    assert!(0 < out(0) && out(0) < out(1), "{} {}", out(0), out(1));
    let record = study.record(1, 0)?.ok_or("no record")?;
    assert!(record.counters().insertions > 0 && record.samples().iter().all(|&grains| grains > 40));
    assert_eq!(record.observer().0, record.counters().insertions);
    let frames = fs::read_to_string(scratch.0.join("frames-1-0.xyz"))?;
    assert_eq!(frames.matches("Lattice=").count(), 6);
    Ok(())
}

#[test]
fn a_value_ends_at_its_limit_of_collisions() -> Result<(), AnyError> {
    let protocol = Protocol::new(4, 6, 2)?.with_most_collisions(300)?;
    let plan = Plan::new(Gas { restitution: 0.5, noise: 0.0 }, protocol, 1)?;
    assert_eq!(Plan::from_toml(&plan.to_toml()?)?, plan);
    let plan = plan.with_axis(Axis::new("restitution", [0.05, 1.0])?)?;
    let (_scratch, study) = done_twice("limit", &plan);
    let record = study.record(1, 0)?.ok_or("no record")?;
    assert_eq!(record.outcome().name(), "limited");
    assert_eq!(record.counters().collisions(), 300);
    assert!(record.samples().len() < 6);
    assert_eq!(study.failed()?, [[0, 0], [1, 0]]);
    assert!(Protocol::new(1, 1, 1)?.with_most_collisions(0).is_err());
    Ok(())
}

#[test]
fn a_value_ends_at_the_limit_of_seconds_and_can_be_retried() -> Result<(), AnyError> {
    let scratch = Scratch::new("seconds");
    let study = Study::create(
        &scratch.0,
        &Plan::new(Gas { restitution: 1.0, noise: 0.0 }, Protocol::new(0, 5, 1)?, 1)?,
    )?;
    let summary = study.run(&Control::default().with_most_seconds(1e-9)?)?;
    assert_eq!((summary.finished, summary.failed), (1, 1));
    assert!(
        study
            .record(0, 0)?
            .ok_or("no record")?
            .outcome()
            .reason()
            .is_some_and(|why| why.contains("more than"))
    );
    // A process that was killed just after it had finished the value may have left the value half done.
    let left = scratch.0.join("unfinished/0000-0000");
    std::fs::create_dir_all(scratch.0.join("unfinished"))?;
    std::fs::write(&left, "half done")?;
    assert!(study.forget_failed(0)?);
    assert!(!left.exists());
    let summary = study.run(&Control::default())?;
    assert_eq!((summary.failed, summary.redone.len()), (0, 0));
    assert_eq!(study.record(0, 0)?.ok_or("no record")?.samples().len(), 5);
    assert!(Control::default().with_most_seconds(0.0).is_err());
    Ok(())
}

static SEEN: AtomicU32 = AtomicU32::new(0);

/// An experiment within which a closure counts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Counted(Gas);

impl Experiment for Counted {
    type Rule = Smooth;
    type Boundary = Container;
    type Observer = ();
    type Sample = f64;

    fn revision() -> Fingerprint {
        Gas::revision()
    }
    fn rule(&self) -> Result<Smooth, ExperimentError> {
        self.0.rule()
    }
    fn boundary(&self) -> Result<Container, ExperimentError> {
        self.0.boundary()
    }
    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        self.0.disks(seed)
    }
    fn observer(&self) -> Result<(), ExperimentError> {
        Ok(())
    }
    fn sample(&self, snapshot: &Snapshot<'_>, (): &mut ()) -> f64 {
        energy_of(snapshot)
    }
    fn columns() -> Vec<Column<Self>> {
        Vec::new()
    }
    fn companion(&self, _: &Start<'_>) -> Result<Option<Box<dyn Observer>>, ExperimentError> {
        Ok(Some(Box::new(on_collision(|_: &Collision| {
            SEEN.fetch_add(1, Ordering::Relaxed);
        }))))
    }
}

#[test]
fn a_closure_rides_along() -> Result<(), AnyError> {
    let scratch = Scratch::new("closure");
    let plan = Plan::new(Counted(Gas { restitution: 0.9, noise: 0.0 }), Protocol::new(2, 5, 1)?, 1)?;
    let study = Study::create(&scratch.0, &plan)?;
    study.run(&Control::default())?;
    let collisions = study.record(0, 0)?.ok_or("no record")?.counters().collisions();
    assert_eq!(u64::from(SEEN.load(Ordering::Relaxed)), collisions);
    Ok(())
}
