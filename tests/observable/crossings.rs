//! Crossings of lines: exact balances of the disks on both sides.

use granular_edmd::boundary::{Container, Part, Vessel};
use granular_edmd::collision::{Elastic, Frictional, LeastRebound};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{BetweenKinds, Crossings, OfKind, SampleTimes};
use granular_edmd::simulation::Limits;
use granular_edmd::simulation::{Inlet, WhiteNoise};
use granular_edmd::{Disk, Kind, Simulation, initial};

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;

/// Height of the lines, which no disk hits on purpose.
const HEIGHT: f64 = 4.037;

fn above(disks: &[Disk], kind: Option<Kind>) -> i64 {
    let counts = |disk: &&Disk| disk.position().y > HEIGHT && kind.is_none_or(|kind| disk.kind() == kind);
    (disks.iter().filter(counts).count() as u64).cast_signed()
}

fn net(crossings: &Crossings) -> i64 {
    crossings.forward().iter().sum::<u64>().cast_signed()
        - crossings.backward().iter().sum::<u64>().cast_signed()
}

/// In a box under gravity with kicks, of two kinds: at each end, as many disks more are above as have
/// crossed.
#[test]
fn disks_above_a_line_are_those_that_crossed_it() -> Outcome {
    const RED: Kind = Kind::new(1);
    for periodic in [false, true] {
        let container = Container::closed(12.0, 10.0)?;
        let container = if periodic { container.with_periodic_sides()? } else { container };
        let disks =
            initial::with_maxwellian_velocities(initial::random(&container, 40, 0.4, 10.0, 1)?, 1.0, 2)?;
        let paint = |(k, disk): (usize, Disk)| if k % 3 == 0 { disk.with_kind(RED) } else { disk };
        let disks: Vec<Disk> = disks.into_iter().enumerate().map(paint).collect();
        let rule = LeastRebound::new(Frictional::from_inelasticity(0.1, 0.1, 0.3)?, 0.05)?;
        let mut run = Simulation::builder(rule, container).disks(disks.clone()).gravity(0.3).build()?;
        let line = [DVec2::new(-1.0, HEIGHT), DVec2::new(13.0, HEIGHT)];
        // Across periodic sides, the line must be as long as a period, and no longer.
        let line = if periodic { [DVec2::new(0.0, HEIGHT), DVec2::new(12.0, HEIGHT)] } else { line };
        let all = Crossings::new(line, SampleTimes::every(1.0)?)?;
        let mut both = (all.clone(), OfKind::new(RED, all));
        let mut noise = WhiteNoise::new(2.0, SampleTimes::every(0.5)?, 3)?;
        run.run_driven(&Limits::until(100.0), &mut noise, &mut both)?;
        assert!(both.0.forward().iter().sum::<u64>() > 100);
        assert_eq!(net(&both.0), above(&run.disks(), None) - above(&disks, None), "{periodic}");
        assert_eq!(net(both.1.inner()), above(&run.disks(), Some(RED)) - above(&disks, Some(RED)));
    }
    Ok(())
}

/// A shower through a line into a sink: disks come in above and leave below.
#[test]
fn a_shower_crosses_a_line_on_its_way_to_a_sink() -> Outcome {
    let exit = Part::polyline([(-1.0, 1.0), (9.0, 1.0)].map(DVec2::from))?.absorbing_centers();
    let vessel = Vessel::new(Container::open(8.0)?).with("exit", exit)?;
    let mut run =
        Simulation::builder(Frictional::from_inelasticity(0.1, 0.1, 0.3)?, vessel).gravity(1.0).build()?;
    let model = Disk::new(DVec2::ZERO, 0.3)?;
    let room = [DVec2::new(1.0, 6.0), DVec2::new(7.0, 8.0)];
    run.add_inlet(Inlet::new(room, [model], SampleTimes::every(0.25)?, 5)?)?;
    let line = [DVec2::new(-1.0, HEIGHT), DVec2::new(9.0, HEIGHT)];
    let mut crossings = Crossings::new(line, SampleTimes::every(1.0)?)?;
    for piece in 1..=60 {
        run.run_until(0.5 * f64::from(piece), &mut crossings)?;
    }
    let entered = run.counters().insertions.cast_signed();
    assert!(entered > 100 && run.counters().removals > 50);
    assert_eq!(-net(&crossings), entered - above(&run.disks(), None));
    Ok(())
}

/// Crossings need all collisions of their disks: a filter that keeps some back is noticed.
#[test]
fn crossings_that_miss_collisions_are_refused() -> Outcome {
    let container = Container::periodic(12.0, 12.0)?;
    let disks = initial::with_maxwellian_velocities(initial::random(&container, 30, 0.5, 12.0, 1)?, 1.0, 2)?;
    let disks: Vec<Disk> = (0..).zip(disks).map(|(k, disk)| disk.with_kind(Kind::new(k % 2))).collect();
    let mut run = Simulation::builder(Elastic, container).disks(disks).build()?;
    let line = [DVec2::new(0.0, HEIGHT), DVec2::new(12.0, HEIGHT)];
    let crossings = Crossings::new(line, SampleTimes::every(2.0)?)?;
    let mut between = BetweenKinds::new(Kind::new(0), Kind::new(1), crossings.clone());
    let refused = run.run_until(4.0, &mut between).unwrap_err();
    let refused = std::error::Error::source(&refused).expect("a cause");
    assert!(refused.to_string().contains("otherwise than in the collisions"), "{refused}");
    run.run_until(8.0, &mut OfKind::new(Kind::new(1), crossings))?;
    Ok(())
}
