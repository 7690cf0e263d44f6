//! Kinds in a run: rules and observers see them, and files keep them.

use granular_edmd::boundary::{Boundary, Container, Part, Wall};
use granular_edmd::collision::{Contact, Elastic, Frictional, RulesByKind};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    BetweenKinds, CollisionCounts, Energies, EnergyChange, OfKind, Partner, SampleTimes, Series, on_collision,
};
use granular_edmd::simulation::{BuildError, Simulation};
use granular_edmd::{Disk, Kind, initial};

const SMALL: Kind = Kind::new(1);
const LARGE: Kind = Kind::new(2);
const FELT: Kind = Kind::new(9);

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

fn container() -> Outcome<Container> {
    Ok(Container::closed(12.0, 12.0)?.with_kind(Wall::Floor, FELT)?)
}

/// Returns a mixture of two kinds; of one size if `large` is that of the small ones.
fn mixture(large: f64) -> Outcome<Vec<Disk>> {
    let disk = |k: usize| match k % 3 {
        0 => Disk::new(DVec2::ZERO, large)?.with_mass(2.0).map(|disk| disk.with_kind(LARGE)),
        _ => Ok(Disk::new(DVec2::ZERO, 0.4)?.with_kind(SMALL)),
    };
    let disks = (0..30).map(disk).collect::<Result<Vec<_>, _>>()?;
    let disks = initial::scattered_mix(&container()?, disks, 12.0, 5)?;
    Ok(initial::with_maxwellian_velocities(disks, 1.0, 5)?)
}

#[test]
fn every_contact_of_a_run_knows_its_partners() -> Outcome {
    for large in [0.7, 0.4] {
        let disks = mixture(large)?;
        let container = container()?;
        let mut seen = [0; 4];
        let mut watch = on_collision(|collision: &granular_edmd::observable::Collision| {
            let disk = &disks[collision.disk];
            let (kind, radius) = match collision.partner {
                Partner::Disk(partner) => (disks[partner].kind(), disks[partner].radius()),
                Partner::Wall(wall) if container.wall(wall, 0.0).name == "floor" => (FELT, f64::INFINITY),
                Partner::Wall(_) => (Kind::WALL, f64::INFINITY),
            };
            assert_eq!(collision.contact.kinds(), [disk.kind(), kind]);
            assert_eq!(collision.contact.radii(), [disk.radius(), radius]);
            seen[[SMALL, LARGE, FELT, Kind::WALL].iter().position(|&other| other == kind).unwrap()] += 1;
        });
        let mut run =
            Simulation::builder(Elastic, container.clone()).disks(disks.clone()).gravity(0.1).build()?;
        run.run_until(30.0, &mut watch)?;
        assert!(seen.into_iter().all(|count| count > 5), "{seen:?}");
        assert!(run.disks().iter().zip(&disks).all(|(now, then)| now.kind() == then.kind()));
    }
    Ok(())
}

/// A table in which all rules are the same gives the bits of that rule.
#[test]
fn kinds_alone_change_nothing() -> Outcome {
    let rule = Frictional::from_inelasticity(0.1, 0.1, 0.3)?;
    let table = RulesByKind::new(rule).with(SMALL, LARGE, rule);
    let mut with = Simulation::builder(table, container()?).disks(mixture(0.4)?).build()?;
    let blank = mixture(0.4)?.into_iter().map(|disk| disk.with_kind(Kind::DEFAULT));
    let mut without = Simulation::builder(rule, container()?).disks(blank).build()?;
    with.run_until(20.0, &mut ())?;
    without.run_until(20.0, &mut ())?;
    let blank: Vec<Disk> = with.disks().iter().map(|disk| disk.with_kind(Kind::DEFAULT)).collect();
    assert_eq!(blank, without.disks());
    Ok(())
}

/// The energies of both kinds sum to those of all, and the collisions between all pairs to all collisions.
#[test]
fn observers_by_kind_share_out_the_whole() -> Outcome {
    let times = SampleTimes::every(2.0)?;
    let mut all = (Series::new(Energies, times), EnergyChange::default(), CollisionCounts::default());
    let mut small =
        (Series::new(OfKind::new(SMALL, Energies), times), OfKind::new(SMALL, CollisionCounts::default()));
    let mut large =
        (Series::new(OfKind::new(LARGE, Energies), times), OfKind::new(LARGE, CollisionCounts::default()));
    let between = |first, second| BetweenKinds::new(first, second, EnergyChange::default());
    let mut pairs = vec![between(SMALL, SMALL), between(LARGE, SMALL), between(LARGE, LARGE)];
    let mut floor = between(FELT, LARGE);
    let mut run = Simulation::builder(Frictional::from_inelasticity(0.05, 0.05, 0.2)?, container()?)
        .disks(mixture(0.7)?)
        .build()?;
    run.run_until(20.0, &mut (&mut all, &mut small, &mut large, &mut pairs, &mut floor))?;

    for ((all, small), large) in all.0.values().iter().zip(small.0.values()).zip(large.0.values()) {
        let sum = (20.0 * small.total() + 10.0 * large.total()) / 30.0;
        assert!((sum / all.total() - 1.0).abs() < 1e-14);
    }
    let counts: Vec<u64> = pairs.iter().map(|pair| pair.inner().disks().count()).collect();
    assert!(counts.iter().all(|&count| count > 0));
    assert_eq!(counts.iter().sum::<u64>(), all.1.disks().count());
    let of_kind = |counts: &OfKind<CollisionCounts>| counts.inner().disk_collisions();
    assert_eq!((of_kind(&small.1), of_kind(&large.1)), (counts[0] + counts[1], counts[1] + counts[2]));
    let floor_hits = large.1.inner().collisions_with_wall("floor");
    assert_eq!(floor.inner().wall("floor").count(), floor_hits);
    assert!(floor_hits > 0);
    Ok(())
}

#[test]
fn a_rule_may_decide_by_radius() -> Outcome {
    let rule = granular_edmd::collision::from_fn(|contact: &Contact| {
        let restitution = if contact.effective_radius() > 0.3 { 0.5 } else { 1.0 };
        granular_edmd::collision::Impulse::new(contact.normal_impulse(restitution), 0.0)
    });
    let mut loss = [0.0; 2];
    let mut watch = on_collision(|collision: &granular_edmd::observable::Collision| {
        loss[usize::from(collision.contact.effective_radius() > 0.3)] += collision.energy_change;
    });
    let mut run = Simulation::builder(rule, container()?).disks(mixture(0.7)?).build()?;
    run.run_until(5.0, &mut watch)?;
    assert!(loss[0].abs() < 1e-12 && loss[1] < -1.0, "{loss:?}");
    Ok(())
}

#[cfg(feature = "serde")]
#[test]
fn a_resumed_run_keeps_its_kinds() -> Outcome {
    for large in [0.7, 0.4] {
        let table = RulesByKind::new(Frictional::from_inelasticity(0.02, 0.02, 0.3)?).with(
            LARGE,
            FELT,
            Frictional::from_inelasticity(0.0, 0.0, 0.0)?,
        );
        let mut first =
            Simulation::builder(table.clone(), container()?).disks(mixture(large)?).gravity(0.1).build()?;
        first.run_until(5.0, &mut ())?;
        let bytes = first.checkpoint().to_bytes()?;
        let checkpoint = granular_edmd::simulation::Checkpoint::from_bytes(&bytes)?;
        let mut second = Simulation::resume(&checkpoint, table, container()?).build()?;
        first.run_until(10.0, &mut ())?;
        second.run_until(10.0, &mut ())?;
        assert_eq!(first.disks(), second.disks());
    }
    Ok(())
}

/// A wall of the kind that is watched is no disk of that kind.
#[test]
fn a_wall_of_a_kind_is_no_disk_of_it() -> Outcome {
    let ball = Disk::new(DVec2::new(6.0, 3.0), 0.5)?.with_kind(SMALL);
    let mut counts =
        (OfKind::new(FELT, CollisionCounts::default()), OfKind::new(SMALL, CollisionCounts::default()));
    let mut run = Simulation::builder(Elastic, container()?).disks([ball]).gravity(1.0).build()?;
    run.run_until(20.0, &mut counts)?;
    assert_eq!(counts.0.inner().wall_collisions(), 0);
    assert!(counts.1.inner().wall_collisions() > 3);
    Ok(())
}

/// A block is there for one kind only: a disk inside it cannot become of this kind.
#[test]
fn a_kind_that_does_not_fit_is_refused() -> Outcome {
    let corners = [(2.0, 2.0), (9.0, 2.0), (9.0, 6.0), (2.0, 6.0)].map(DVec2::from);
    let block = Part::block(corners)?.only_for([LARGE]);
    let vessel = Container::closed(12.0, 12.0)?.with_part("block", block)?;
    let disk = Disk::new(DVec2::new(5.0, 4.0), 0.5)?.with_kind(SMALL);
    let mut run = Simulation::builder(Elastic, vessel).disks([disk]).build()?;
    let refused = run.map_disks(|_, disk| Ok(disk.with_kind(LARGE))).unwrap_err();
    assert!(matches!(refused, BuildError::OverlapsWall { .. }), "{refused}");
    assert_eq!(run.disks()[0].kind(), SMALL);
    run.map_disks(|_, disk| disk.with_position(DVec2::new(10.5, 4.0)).map(|disk| disk.with_kind(LARGE)))?;
    Ok(())
}
