//! Round obstacles in a container.

use granular_edmd::boundary::{Boundary, Container, Overlap, Probe, Wall, laws};
use granular_edmd::collision::{Contact, Elastic, Impulse, from_fn};
use granular_edmd::glam::DVec2;
use granular_edmd::wall::BiParabolic;
use granular_edmd::{Disk, Kind, Simulation, initial};
use support::cases::few;

fn peg(x: f64, y: f64, radius: f64) -> Disk {
    Disk::new(DVec2::new(x, y), radius).unwrap()
}

fn pegs() -> [Disk; 4] {
    // Two of them overlap, one sticks in the floor, one is near a side.
    [peg(5.0, 6.0, 1.0), peg(5.5, 7.0, 1.0), peg(8.0, 0.0, 0.7), peg(11.5, 5.0, 0.4)]
}

#[test]
fn obstacles_keep_the_contract() {
    let moving = Container::closed(12.0, 9.0)
        .unwrap()
        .with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0).unwrap())
        .unwrap();
    let periodic = Container::open(12.0).unwrap().with_periodic_sides().unwrap();
    let containers = [moving, periodic, Container::periodic(12.0, 9.0).unwrap()];
    for (container, seed) in
        few(containers.iter().flat_map(|container| (0..4).map(move |seed| (container, seed))), 5)
    {
        let mut board = container.clone().with_pegs(pegs()).unwrap();
        assert_eq!(laws::check(&mut board, 0.5, 1.0, seed), Ok(()));
    }
}

/// A gas between pegs keeps its energy, and no disk comes into a peg, also through periodic sides and ends.
#[test]
fn a_gas_flows_around_obstacles() {
    let board = || Container::periodic(12.0, 12.0).unwrap().with_pegs(pegs()).unwrap();
    let disks = initial::scattered(&board(), 40, 0.4, 12.0, 1).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 1).unwrap();
    let energy = |disks: &[Disk]| disks.iter().map(Disk::translational_energy).sum::<f64>();
    let mut run = Simulation::builder(Elastic, board()).disks(disks.clone()).build().unwrap();
    for time in 1..=200 {
        run.run_until(f64::from(time), &mut ()).unwrap();
        for disk in run.disks() {
            let depth = board()
                .overlap(&Probe::new(disk.position(), disk.radius(), 0.0))
                .map_or(0.0, |overlap| overlap.depth);
            assert!(depth < 1e-10, "{disk:?} is in an obstacle by {depth}");
        }
    }
    assert!((energy(&run.disks()) / energy(&disks) - 1.0).abs() < 1e-10);
    assert!(run.counters().wall_collisions > 100, "{:?}", run.counters());
}

/// A rule gets the radius of a peg, and an infinite one at a straight wall.
#[test]
fn a_rule_knows_the_radius_of_a_peg() {
    let seen = std::sync::Mutex::new(std::collections::BTreeSet::new());
    let rule = from_fn(|contact: &Contact| {
        seen.lock().unwrap().insert(format!("{:?}", contact.radii()));
        Impulse::new(contact.normal_impulse(1.0), 0.0)
    });
    let board = Container::open(10.0).unwrap().with_pegs([peg(5.0, 2.0, 1.5)]).unwrap();
    let mut run = Simulation::builder(&rule, board).disks([peg(5.1, 5.5, 0.5)]).gravity(1.0).build().unwrap();
    run.run_until(30.0, &mut ()).unwrap();
    let seen: Vec<String> = seen.lock().unwrap().iter().cloned().collect();
    assert_eq!(seen, ["[0.5, 1.5]", "[0.5, inf]"]);
}

/// A disk that falls centrally on a peg bounces on it as on a floor: from height h it takes sqrt(2h/g).
#[test]
fn a_disk_bounces_on_a_peg() {
    let board = Container::open(10.0).unwrap().with_pegs([peg(5.0, 2.0, 1.0)]).unwrap();
    let disk = peg(5.0, 5.5, 0.5);
    let mut run = Simulation::builder(Elastic, board).disks([disk]).gravity(1.0).build().unwrap();
    run.run_until(4.0, &mut ()).unwrap();
    assert_eq!(run.counters().wall_collisions, 1);
    assert!((run.disk(0).unwrap().position() - disk.position()).length() < 1e-12);
}

#[test]
fn obstacles_have_names_kinds_and_a_fingerprint() {
    let container = || Container::open(10.0).unwrap();
    let board = container().with_pegs([peg(5.0, 2.0, 1.0).with_kind(Kind::new(7))]).unwrap();
    assert_eq!((board.wall_count(), board.wall(3, 0.0).to_string()), (4, "peg 0".to_owned()));
    assert_eq!(board.surface(3, DVec2::new(5.0, 4.0), 0.0).kind, Kind::new(7));
    assert_eq!(board.overlap(&Probe::new(DVec2::new(5.0, 3.0), 0.5, 0.0)), Some(Overlap::new(3, 0.5)));
    let other = container().with_pegs([peg(5.0, 2.0, 1.5)]).unwrap();
    assert_ne!(board.fingerprint(), other.fingerprint());
}

/// An obstacle that lies some periods outside is where it would be seen inside.
#[test]
fn obstacles_are_taken_back_into_a_periodic_domain() {
    for x in [25.0, -15.0, 5.0] {
        let peg = Disk::new(DVec2::new(x, 45.0), 1.0).unwrap();
        let mut board = Container::periodic(10.0, 10.0).unwrap().with_pegs([peg]).unwrap();
        assert_eq!(board.overlap(&Probe::new(DVec2::new(5.0, 5.0), 0.5, 0.0)), Some(Overlap::new(0, 1.5)));
        assert_eq!(laws::check(&mut board, 0.5, 1.0, 3), Ok(()));
    }
}
