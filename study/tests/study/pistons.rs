//! Ramps over the parameters of a wall with a mass, which stays where it is from value to value.

use granular_edmd::boundary::{Boundary, Container, Wall};
use granular_edmd::collision::Elastic;
use granular_edmd::observable::Snapshot;
use granular_edmd::wall::Piston;
use granular_edmd::{Disk, Fingerprint, initial};
use granular_edmd_study::{
    Column, Control, Course, Experiment, ExperimentError, Outcome, Plan, Protocol, Ramp, Study,
};
use serde::{Deserialize, Serialize};

use crate::support::{AnyError, Scratch, assert_same, run_with_interruptions};
use support::report::report;

const HEIGHT: f64 = 40.0;

/// A gas under a lid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Lid {
    disks: usize,
    force: f64,
    highest: f64,
    is_fixed: bool,
}

const LID: Lid = Lid { disks: 40, force: 2.0, highest: 35.0, is_fixed: false };

/// Displacement and velocity of the lid.
type State = (f64, f64);

impl Experiment for Lid {
    type Rule = Elastic;
    type Boundary = Container;
    type Observer = ();
    type Sample = State;

    fn revision() -> Fingerprint {
        Fingerprint::of("Lid")
    }
    fn rule(&self) -> Result<Elastic, ExperimentError> {
        Ok(Elastic)
    }
    fn boundary(&self) -> Result<Container, ExperimentError> {
        let container = Container::closed(15.0, HEIGHT)?;
        if self.is_fixed {
            return Ok(container);
        }
        let lid = Piston::new(10.0, [0.0, self.highest])?.with_force(self.force)?.with_start(15.0, 0.0)?;
        Ok(container.with_piston(Wall::Lid, lid)?)
    }
    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        let disks = initial::scattered(&self.boundary()?, self.disks, 0.5, 25.0, seed)?;
        Ok(initial::with_maxwellian_velocities(disks, 1.0, seed)?)
    }
    fn observer(&self) -> Result<(), ExperimentError> {
        Ok(())
    }
    fn sample(&self, snapshot: &Snapshot<'_>, (): &mut ()) -> State {
        state(snapshot)
    }
    fn columns() -> Vec<Column<Self>> {
        vec![Column::sampled("displacement", "length", |state: &State| state.0)]
    }
}

fn state(snapshot: &Snapshot<'_>) -> State {
    let [place, velocity] = [snapshot.wall_point(3), snapshot.wall_velocity(3)].map(Option::unwrap);
    (HEIGHT - place.y, -velocity.y)
}

/// At any time of the run, also long after the last blow, another force moves the lid from where it is.
#[test]
fn a_lid_under_another_force_starts_where_it_is() -> Result<(), AnyError> {
    for time in [0.0, 0.37, 3.0, 41.3, 1000.7, 12345.6] {
        let mut run = LID.build(1)?;
        run.run_until(time, &mut ())?;
        let before = state(&run.snapshot());
        let heavier = Lid { force: 3.0, ..LID };
        heavier.change(&mut run)?;
        let after = state(&run.snapshot());
        assert!((before.0 - after.0).abs() < 1e-12 * HEIGHT, "{time}: {before:?} {after:?}");
        assert!((before.1 - after.1).abs() < 1e-12, "{time}: {before:?} {after:?}");
        assert_eq!(run.time(), time);
        assert_eq!(run.boundary().state().len(), 3);
        // The new force moves it from now on: energy is kept from here.
        let piston = Piston::new(10.0, [0.0, 35.0])?.with_force(3.0)?;
        let energy = |(place, velocity): State, disks: &[Disk]| {
            piston.energy(place, velocity) + disks.iter().map(Disk::translational_energy).sum::<f64>()
        };
        let start = energy(after, &run.disks());
        run.run_until(time + 20.0, &mut ())?;
        let end = energy(state(&run.snapshot()), &run.disks());
        assert!((end - start).abs() < 1e-9 * start.abs(), "{time}: {start} {end}");
    }
    Ok(())
}

#[test]
fn a_ramp_of_the_force_on_a_lid_goes_on_with_the_same_bytes() -> Result<(), AnyError> {
    let plan = Plan::new(LID, Protocol::new(20, 30, 3)?, 1)?;
    let plan = plan.with_ramp(Ramp::new("force", [2.0, 2.5, 3.0], Course::Up)?)?;
    let (whole, parts) = (Scratch::new("lid"), Scratch::new("lid-interrupted"));
    let study = Study::create(&whole.0, &plan)?;
    study.run(&Control::default())?;
    for record in study.records() {
        let record = record?;
        assert!(matches!(record.outcome(), Outcome::Completed), "{:?}", record.outcome());
    }
    assert!(run_with_interruptions(&parts.0, &plan, |_| 12, |_| {}) > 1);
    assert_same(&parts.0, &whole.0);
    Ok(())
}

#[test]
fn walls_that_cannot_take_over_the_state_are_refused_by_name() -> Result<(), AnyError> {
    let mut run = LID.build(1)?;
    run.run_until(5.0, &mut ())?;
    let before = state(&run.snapshot());
    let error = Lid { is_fixed: true, ..LID }.change(&mut run).unwrap_err();
    assert!(report(&error).contains("state of the walls"), "{}", report(&error));
    let error = Lid { highest: before.0 - 1.0, ..LID }.change(&mut run).unwrap_err();
    assert!(report(&error).contains("displacement of a piston"), "{}", report(&error));
    Ok(())
}
