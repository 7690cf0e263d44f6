//! Parts that lie in a wall replace its stretch, and parts for some kinds let the others pass.

use granular_edmd::boundary::{Container, Part, Thermal, Wall};
use granular_edmd::collision::{Elastic, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Arrivals, SampleTimes};
use granular_edmd::{Disk, Kind, Simulation, initial};

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

fn door() -> Outcome<Part> {
    Ok(Part::polyline([DVec2::new(10.0, 4.0), DVec2::new(10.0, 6.0)])?)
}

fn disk(y: f64) -> Outcome<Disk> {
    Ok(Disk::new(DVec2::new(2.0, y), 0.5)?.with_velocity(DVec2::X)?)
}

#[test]
fn a_door_in_a_wall_of_a_container_takes_disks_out() -> Outcome {
    let vessel = Container::closed(10.0, 10.0)?.with_part("door", door()?.absorbing())?;
    let mut flow = Arrivals::at(["door"], SampleTimes::every(20.0)?);
    let mut run = Simulation::builder(Elastic, vessel).disks([disk(5.0)?, disk(8.0)?]).build()?;
    run.run_until(20.0, &mut flow)?;
    assert_eq!((run.len(), flow.counts()), (1, &[1][..]));
    assert_eq!(run.disks()[0].position().y, 8.0, "beside the door is a wall");
    Ok(())
}

/// In a polygon, in either order of the parts, also turned by an angle that rounds.
#[test]
fn a_door_in_a_polygon_takes_disks_out_in_either_order() -> Outcome {
    for angle in [0.0, 0.3, 1.1, 2.0] {
        let turn = DVec2::from_angle(angle);
        let corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
        let room = Part::polygon(corners.map(|corner| turn.rotate(DVec2::from(corner))))?;
        let door = Part::polyline([(10.0, 4.0), (10.0, 6.0)].map(|end| turn.rotate(DVec2::from(end))))?;
        let parts = [("room", room), ("door", door.absorbing())];
        for order in [[0, 1], [1, 0]] {
            let vessel = Container::around(order.map(|part| parts[part].clone()))?;
            let flying = Disk::new(turn.rotate(DVec2::new(2.0, 5.0)), 0.5)?.with_velocity(turn)?;
            let mut run = Simulation::builder(Elastic, vessel).disks([flying]).build()?;
            run.run_until(20.0, &mut ())?;
            assert!(run.is_empty(), "{angle} {order:?}");
        }
    }
    Ok(())
}

/// A thermal stretch, a belt and a lossy stretch in the floor act where they lie.
#[test]
fn a_patch_in_the_floor_acts_there() -> Outcome {
    let stretch = || Part::polyline([DVec2::new(8.0, 0.0), DVec2::new(2.0, 0.0)]);
    let falling = |x: f64| Disk::new(DVec2::new(x, 3.0), 0.5)?.with_velocity(DVec2::NEG_Y);
    let after = |part: Part| -> Outcome<Vec<Disk>> {
        let floor = Container::closed(10.0, 10.0)?.with_rule(Wall::Floor, Elastic)?;
        let vessel = floor.with_part("patch", part)?;
        let rule = granular_edmd::collision::Rough::from_restitution(1.0, 0.0)?;
        let mut run =
            Simulation::builder(rule, vessel).disks([falling(1.0)?, falling(5.0)?]).seed(3).build()?;
        run.run_until(3.0, &mut ())?;
        Ok(run.disks())
    };
    let lossy = after(stretch()?.with_rule(Smooth::from_restitution(0.5)?))?;
    assert_eq!((lossy[0].velocity().y, lossy[1].velocity().y), (1.0, 0.5));
    let belt = after(stretch()?.with_surface_speed(0.5)?)?;
    assert_eq!(belt[0].velocity().x, 0.0);
    assert!(belt[1].velocity().x.abs() > 0.1, "{:?}", belt[1]);
    let hot = after(stretch()?.with_temperature(Thermal::new(9.0)?))?;
    assert_eq!(hot[0].velocity().y, 1.0);
    assert!(hot[1].velocity().x != 0.0);
    Ok(())
}

/// A sieve holds the large disks and lets the small ones through; nothing overlaps a wall that concerns it,
/// and initial states may lie across a wall that does not.
#[test]
fn a_sieve_stops_some_kinds_only() -> Outcome {
    const LARGE: Kind = Kind::new(7);
    let sieve = Part::polyline([DVec2::new(0.0, 5.0), DVec2::new(20.0, 5.0)])?.only_for([LARGE]);
    let vessel = Container::closed(20.0, 20.0)?.with_part("sieve", sieve)?;
    let lying = Disk::new(DVec2::new(3.0, 5.0), 0.4)?;
    assert!(Simulation::builder(Elastic, vessel.clone()).disks([lying]).build().is_ok());
    assert!(Simulation::builder(Elastic, vessel.clone()).disks([lying.with_kind(LARGE)]).build().is_err());
    let mix = |k: usize| {
        let disk = Disk::new(DVec2::ZERO, 0.4)?;
        Ok(if k.is_multiple_of(2) { disk.with_kind(LARGE) } else { disk })
    };
    let mix = (0..60).map(mix).collect::<Result<Vec<_>, granular_edmd::ParameterError>>()?;
    let disks = initial::scattered_mix(&vessel, mix, 20.0, 4)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 5)?;
    let below = |disks: &[Disk], kind: Kind| {
        disks.iter().filter(|disk| disk.kind() == kind && disk.position().y < 5.0).count()
    };
    let mut run = Simulation::builder(Elastic, vessel).disks(disks.clone()).build()?;
    let mut seen = Vec::new();
    for piece in 1..=20 {
        run.run_until(10.0 * f64::from(piece), &mut ())?;
        assert_eq!(below(&run.disks(), LARGE), below(&disks, LARGE));
        seen.push(below(&run.disks(), Kind::DEFAULT));
    }
    assert!(seen.iter().any(|&count| count != seen[0]), "small disks go through: {seen:?}");
    Ok(())
}
