//! Warnings, stalls and panics point at their cause: each cause is planted.

use std::panic::{AssertUnwindSafe, catch_unwind};

use granular_edmd::boundary::{
    Boundary, Container, Domain, FirstTouch, Overlap, Part, Probe, Region, Surface, Touch, Wall,
};
use granular_edmd::collision::{
    CollisionRule, Contact, ContactDuration, Elastic, Frictional, Impulse, LeastRebound, Smooth, from_fn,
};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{FreeWall, Temperatures, on_collision};
use granular_edmd::simulation::{Limits, Remedy, RunError, Warning};
use granular_edmd::wall::{Piston, Sinusoidal};
use granular_edmd::{Disk, Flight, Simulation, initial};

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

fn walls() -> Outcome<Container> {
    Ok(Container::closed(20.0, 20.0)?)
}

fn gas(container: &Container) -> Outcome<Vec<Disk>> {
    Ok(initial::with_maxwellian_velocities(initial::lattice(container, 100, 0.5)?, 1.0, 1)?)
}

/// Disks that fall out of an open box never come back.
#[test]
fn gravity_upwards_without_a_lid_is_a_warning() -> Outcome {
    let warned = |container: Container, gravity: f64| -> Outcome<Vec<Warning>> {
        let run = Simulation::builder(Elastic, container.clone())
            .disks(gas(&container)?)
            .gravity(gravity)
            .build()?;
        Ok(run.warnings())
    };
    let open = warned(Container::open(20.0)?, -1.0)?;
    assert_eq!(open, [Warning::EndlessFall { upwards: 1.0 }]);
    assert!(open[0].to_string().contains("a lid or another gravity"), "{}", open[0]);
    assert_eq!(warned(Container::open(20.0)?, 1.0)?, []);
    assert_eq!(warned(Container::closed(20.0, 20.0)?, -1.0)?, []);
    // A part may be a lid, but not one that leaves half of the top open.
    for (end, is_open) in [(20.0, false), (10.0, true)] {
        let roof = Part::polyline([(0.0, 24.0), (end, 24.0)].map(DVec2::from))?;
        let vessel = Container::open(20.0)?.with_part("roof", roof)?;
        let disks = gas(&walls()?)?;
        let run = Simulation::builder(Elastic, vessel).disks(disks).gravity(-1.0).build()?;
        assert_eq!(run.warnings().len(), usize::from(is_open), "{:?}", run.warnings());
    }
    Ok(())
}

/// A square lattice at rest over a shaken floor hops in columns for ever; the least motion aside mends it.
#[test]
fn columns_that_hop_in_line_are_a_warning() -> Outcome {
    let container = Container::open(20.0)?.with_motion(Wall::Floor, Sinusoidal::new(0.3, 5.0)?)?;
    let after = |disks: Vec<Disk>| -> Outcome<Vec<Warning>> {
        let rule = ContactDuration::new(Frictional::from_inelasticity(0.05, 0.05, 0.3)?, 1e-5)?;
        let mut run = Simulation::builder(rule, container.clone()).disks(disks).gravity(1.0).build()?;
        run.run_until(100.0, &mut ())?;
        Ok(run.warnings())
    };
    let columns = initial::lattice(&container, 60, 0.5)?;
    let warned = after(columns.clone())?;
    assert!(matches!(warned[..], [Warning::OneDirection { .. }]), "{warned:?}");
    assert!(warned[0].to_string().contains("small velocities"), "{}", warned[0]);
    assert_eq!(after(initial::with_maxwellian_velocities(columns, 1e-20, 1)?)?, []);
    // A gas that is brought to rest, or loses all disks but one, has no direction.
    let mut run = Simulation::builder(Elastic, walls()?).disks(gas(&walls()?)?).build()?;
    run.run_until(20.0, &mut ())?;
    run.map_disks(|_, disk| disk.with_velocity(DVec2::ZERO))?;
    assert_eq!(run.warnings(), []);
    run.remove(|index, _| index > 0)?;
    run.map_disks(|_, disk| disk.with_velocity(DVec2::X))?;
    assert_eq!(run.warnings(), []);
    Ok(())
}

/// A least speed far above the speeds of the flow drives it, and says so with the energy that it put in.
#[test]
fn a_least_rebound_that_drives_is_a_warning() -> Outcome {
    let warned = |speed: f64, end: f64| -> Outcome<(Vec<Warning>, f64)> {
        let rule = LeastRebound::new(Smooth::from_restitution(0.9)?, speed)?;
        let mut run = Simulation::builder(rule, walls()?).disks(gas(&walls()?)?).gravity(1.0).build()?;
        run.run_until(end, &mut ())?;
        Ok((run.warnings(), run.measure(&Temperatures).translational()))
    };
    let (loud, temperature) = warned(10.0, 30.0)?;
    let [Warning::MostlyLeastRebound { energy, .. }] = loud[..] else { panic!("{loud:?}") };
    assert!(energy > 100.0 && temperature > 10.0, "{energy} {temperature}");
    assert_eq!(warned(1e-3, 10.0)?.0, []);
    Ok(())
}

/// Energy that grows without a source is a warning: under gravity, too, and not with a moving wall.
#[test]
fn energy_without_a_source_is_a_warning() -> Outcome {
    let gaining = from_fn(|contact: &Contact| Impulse::new(contact.normal_impulse(1.001), 0.0));
    let mut run = Simulation::builder(gaining, walls()?).disks(gas(&walls()?)?).gravity(0.1).build()?;
    run.run_until(30.0, &mut ())?;
    let warned = run.warnings();
    assert!(matches!(warned[..], [Warning::EnergyGained { before, now }] if now > before), "{warned:?}");
    let mut honest = Simulation::builder(Elastic, walls()?).disks(gas(&walls()?)?).gravity(0.1).build()?;
    honest.run_until(300.0, &mut ())?;
    assert_eq!(honest.warnings(), []);
    // A change by the caller begins a new balance.
    for change in 0..4 {
        let gains = change_and_go_on(run.clone(), change)?;
        assert!(matches!(gains[..], [Warning::EnergyGained { .. }]), "{change}: {gains:?}");
        assert_eq!(change_and_go_on(honest.clone(), change)?, [], "{change}");
    }
    let shaken = walls()?.with_motion(Wall::Floor, Sinusoidal::new(0.5, 5.0)?)?;
    let mut heated =
        Simulation::builder(Elastic, shaken.clone()).disks(gas(&shaken)?).gravity(0.1).build()?;
    heated.run_until(30.0, &mut ())?;
    assert_eq!(heated.warnings(), []);
    Ok(())
}

/// A remedy may add energy, but the rule under it may not, also if the remedy has decided a collision.
#[test]
fn a_gain_under_a_remedy_is_a_warning() -> Outcome {
    for gain in [-0.01, 0.0, 0.01] {
        let rule = from_fn(move |contact: &Contact| Impulse::new(contact.normal_impulse(1.0 + gain), 0.0));
        let rule = LeastRebound::new(rule, 0.02)?;
        let mut run = Simulation::builder(rule, walls()?).disks(gas(&walls()?)?).gravity(0.1).build()?;
        run.run_until(30.0, &mut ())?;
        run.set_gravity(0.2)?;
        run.run_until(60.0, &mut ())?;
        assert!(run.counters().energy_of_rebounds > 0.0);
        let warned = matches!(run.warnings()[..], [Warning::EnergyGained { .. }]);
        assert_eq!(warned, gain > 0.0, "{gain}: {:?}", run.warnings());
    }
    Ok(())
}

/// A run that goes on from a checkpoint with other walls begins a new balance.
#[cfg(feature = "serde")]
#[test]
fn energy_without_a_source_is_a_warning_after_a_resumption_with_other_walls() -> Outcome {
    let shaken = walls()?.with_motion(Wall::Floor, Sinusoidal::new(0.5, 5.0)?)?;
    for gain in [0.0, 1e-3] {
        let rule = from_fn(move |contact: &Contact| Impulse::new(contact.normal_impulse(1.0 + gain), 0.0));
        let mut run = Simulation::builder(rule, shaken.clone()).disks(gas(&shaken)?).build()?;
        run.run_until(std::f64::consts::TAU, &mut ())?;
        let (saved, taller) = (run.checkpoint(), Container::closed(20.0, 21.0)?);
        let resumed = Simulation::resume(&saved, rule, taller).with_another_boundary();
        let mut run = resumed.with_another_rule().build()?;
        run.run_until(36.0, &mut ())?;
        let warned = matches!(run.warnings()[..], [Warning::EnergyGained { .. }]);
        assert_eq!(warned, gain > 0.0, "{gain}: {:?}", run.warnings());
    }
    Ok(())
}

/// Disks that fall along a periodic direction keep their energy, so a gain is noticed there, too.
#[test]
fn energy_without_a_source_is_a_warning_where_disks_fall_forever() -> Outcome {
    for pull in [DVec2::new(0.3, -0.5), DVec2::new(0.0, -0.5)] {
        for gain in [0.0, 1e-3] {
            let rule =
                from_fn(move |contact: &Contact| Impulse::new(contact.normal_impulse(1.0 + gain), 0.0));
            let boxes = [Container::periodic(20.0, 20.0)?, walls()?.with_periodic_sides()?];
            for container in boxes {
                let disks = gas(&container)?;
                let mut run = Simulation::builder(rule, container).disks(disks).gravity(pull).build()?;
                run.run_until(300.0, &mut ())?;
                let warned = matches!(run.warnings()[..], [Warning::EnergyGained { .. }]);
                assert_eq!(warned, gain > 0.0, "{pull} {gain}: {:?}", run.warnings());
            }
        }
    }
    Ok(())
}

/// Changes gravity, walls or disks, runs on, and returns the warnings.
fn change_and_go_on<R: CollisionRule>(
    mut run: Simulation<R, Container>,
    change: u32,
) -> Outcome<Vec<Warning>> {
    match change {
        0 => run.set_gravity(0.4)?,
        1 => run.set_boundary(walls()?)?,
        2 => drop(run.remove(|index, _| index == 3)?),
        _ => run.map_disks(|_, disk| disk.with_velocity(2.0 * disk.velocity()))?,
    }
    run.run_until(run.time() + 20.0, &mut ())?;
    Ok(run.warnings())
}

/// The criterion of the contact duration is the time between the collisions that it leaves, not their share.
#[test]
fn a_contact_duration_is_judged_by_the_rate_of_collisions() -> Outcome {
    let warned = |duration: f64, end: f64| -> Outcome<(Vec<Warning>, f64)> {
        let rule = ContactDuration::new(Smooth::from_restitution(0.9)?, duration)?;
        let mut run = Simulation::builder(rule, walls()?).disks(gas(&walls()?)?).gravity(1.0).build()?;
        run.run_until(end, &mut ())?;
        let counters = run.counters();
        let share = counters.contact_duration_collisions as f64 / counters.collisions() as f64;
        Ok((run.warnings(), share))
    };
    // Matter at rest: nearly all collisions are those of the model, and nothing is wrong.
    let (rest, share) = warned(1e-2, 20.0)?;
    assert!(rest.is_empty() && share > 0.5, "{rest:?} {share}");
    // A flow: a quarter of them are, and the model takes a large part of the dissipation.
    let (flow, share) = warned(0.1, 5.0)?;
    println!("{flow:?} {share}");
    assert!(matches!(flow[..], [Warning::LongContactDuration { .. }]) && share < 0.9, "{flow:?} {share}");
    Ok(())
}

/// A floor that claims to rise while it stays.
struct Lying(Container, f64);

impl Boundary for Lying {
    fn domain(&self) -> Domain {
        self.0.domain()
    }
    fn wall_count(&self) -> usize {
        self.0.wall_count()
    }
    fn set_time_origin(&mut self, origin: f64) {
        self.0.set_time_origin(origin);
    }
    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.0.may_touch(region, radius)
    }
    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        self.0.first_touch(flight, until)
    }
    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        let surface = self.0.surface(wall, position, time);
        Surface::new(surface.normal, surface.velocity + self.1 * surface.normal)
    }
    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        self.0.overlap(probe)
    }
}

/// Collisions of disks that have left count for the disks that were there.
#[test]
fn a_contact_duration_is_judged_by_the_disks_of_its_time() -> Outcome {
    let rule = ContactDuration::new(Elastic, 0.01)?;
    let mut run = Simulation::builder(rule, walls()?).disks(gas(&walls()?)?).build()?;
    run.run_until(60.0, &mut ())?;
    assert_eq!(run.warnings(), []);
    run.remove(|index, _| index >= 3)?;
    run.run_until(61.0, &mut ())?;
    assert_eq!(run.warnings(), []);
    Ok(())
}

fn stall_of<R: CollisionRule, B: Boundary>(rule: R, boundary: B, disks: Vec<Disk>) -> Outcome<Remedy> {
    let mut run = Simulation::builder(rule, boundary).disks(disks).gravity(1.0).build()?;
    match run.run_until(1e4, &mut ()) {
        Err(RunError::Stalled { remedy, .. }) => Ok(remedy),
        other => Err(format!("{other:?}").into()),
    }
}

/// Each cause of a stall is named, with a remedy around the rule and without.
#[test]
fn a_stall_names_its_cause() -> Outcome {
    let disk = || -> Outcome<Vec<Disk>> { Ok(vec![Disk::new(DVec2::new(5.0, 3.0), 0.5)?]) };
    let lossy = Smooth::from_restitution(0.5)?;
    let short = ContactDuration::new(lossy, 1e-12)?;
    assert_eq!(stall_of(lossy, walls()?, disk()?)?, Remedy::ElasticWhenSlow);
    assert_eq!(stall_of(short, walls()?, disk()?)?, Remedy::LongerContactDuration);
    let sinking = || -> Outcome<Lying> { Ok(Lying(walls()?, -0.2)) };
    assert_eq!(stall_of(lossy, sinking()?, disk()?)?, Remedy::WallVelocity);
    assert_eq!(stall_of(short, sinking()?, disk()?)?, Remedy::WallVelocity);
    Ok(())
}

/// A stop absorbs what a disk gives a wall that rests on it: the disk keeps (M - m)/(M + m) of its speed, a
/// run that loses its energy so warns, and one that stalls for this reason says so.
#[test]
fn a_wall_that_rests_on_a_stop_is_a_warning_and_a_cause() -> Outcome {
    let loaded = |mass: f64| -> Outcome<Container> {
        let floor = Piston::new(mass, [0.0, 1.0])?.with_force(-1e3)?;
        Ok(walls()?.with_piston(Wall::Floor, floor)?)
    };
    let disk = Disk::new(DVec2::new(5.0, 3.0), 0.5)?.with_velocity(DVec2::NEG_Y)?;
    for mass in [1.0, 3.0, 1e6] {
        let mut run = Simulation::builder(Elastic, loaded(mass)?).disks([disk.with_mass(1.0)?]).build()?;
        run.run_until(5.0, &mut ())?;
        assert!((run.disks()[0].velocity().y - (mass - 1.0) / (mass + 1.0)).abs() < 1e-12);
        assert_eq!(run.warnings().len(), usize::from(mass < 10.0), "{mass}: {:?}", run.warnings());
    }
    let mut run = Simulation::builder(Elastic, loaded(20.0)?).disks(gas(&walls()?)?).build()?;
    run.run_until(200.0, &mut ())?;
    let warned = run.warnings();
    let [Warning::WallOnStop { wall, energy }] = &warned[..] else { panic!("{warned:?}") };
    let left = 100.0 * run.measure(&Temperatures).translational();
    assert!(wall == "floor" && *energy > 10.0 && *energy + left < 120.0, "{energy} {left}");
    // A lid on a ledge: each hit lifts it, and the ledge takes what it has when it comes down.
    let ledge = |stops: [f64; 2], force: f64| -> Outcome<Container> {
        let lid = Piston::new(20.0, stops)?.with_force(force)?;
        Ok(Container::closed(20.0, 20.0)?.with_piston(Wall::Lid, lid)?)
    };
    let mut run = Simulation::builder(Elastic, ledge([-80.0, 0.0], 50.0)?).disks(gas(&walls()?)?).build()?;
    let kinetic = |run: &Simulation<Elastic>| run.disks().iter().map(Disk::translational_energy).sum::<f64>();
    let before = kinetic(&run);
    run.run_until(200.0, &mut ())?;
    let [Warning::WallOnStop { wall, energy }] = &run.warnings()[..] else { panic!("{:?}", run.warnings()) };
    let after = kinetic(&run) + run.measure(&FreeWall::named("lid")).energy;
    assert!(wall == "lid" && (energy - (before - after)).abs() < 0.05 * before, "{energy} {before} {after}");
    let mut free = Simulation::builder(Elastic, ledge([-80.0, 10.0], 5.0)?).disks(gas(&walls()?)?).build()?;
    free.run_until(20.0, &mut ())?;
    assert_eq!(free.warnings(), []);
    let light = Simulation::builder(Elastic, loaded(3.0)?).disks([disk.with_mass(1.0)?]).gravity(1.0).build();
    let error = light?.run_until(1e4, &mut ()).unwrap_err();
    assert!(matches!(error, RunError::Stalled { remedy: Remedy::WallOnStop, .. }), "{error}");
    Ok(())
}

/// A light disk between a wall and a disk of 10¹² times its mass: 3 141 592 collisions, and no stall.
#[test]
fn an_elastic_run_that_ends_by_itself_goes_on() -> Outcome {
    let light = Disk::new(DVec2::new(3.0, 5.0), 0.05)?.with_mass(1.0)?;
    let heavy = Disk::new(DVec2::new(15.0, 5.0), 0.5)?.with_mass(1e12)?.with_velocity(DVec2::NEG_X)?;
    let mut run = Simulation::builder(Elastic, walls()?).disks([light, heavy]).build()?;
    let most = 3_141_592;
    run.run(&Limits::until(26.0), &mut ())?;
    assert_eq!(run.counters().collisions(), most);
    Ok(())
}

/// After a panic in a part, the simulation refuses to go on, and so does a copy of it.
#[test]
fn a_run_that_a_panic_tore_refuses_to_go_on() -> Outcome {
    let mut run = Simulation::builder(Elastic, walls()?).disks(gas(&walls()?)?).build()?;
    let mut count = 0;
    let mut bomb = on_collision(|_| {
        count += 1;
        assert!(count < 57, "the observer panics");
    });
    let torn = catch_unwind(AssertUnwindSafe(|| run.run_until(10.0, &mut bomb)));
    assert!(torn.is_err());
    let error = run.run_until(20.0, &mut ()).unwrap_err();
    assert!(matches!(error, RunError::Torn { .. }) && error.to_string().contains("panicked"), "{error}");
    assert!(matches!(run.clone().step_until(20.0, &mut ()), Err(RunError::Torn { .. })));
    Ok(())
}
