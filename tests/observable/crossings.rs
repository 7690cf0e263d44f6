//! Crossings of lines: exact balances of the disks on both sides.

use granular_edmd::boundary::{Container, Part};
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

/// Both one-way rates are those of effusion, n L √(T/2πm), within their errors, over 20 seeds; the net rate
/// is zero.
#[test]
fn one_way_rates_are_those_of_effusion() -> Outcome {
    let (count, side) = (100, 20.0);
    let container = Container::periodic(side, side)?;
    let line = [DVec2::new(0.0, HEIGHT), DVec2::new(side, HEIGHT)];
    let mut squares = [0.0; 2];
    for seed in 0..20 {
        let disks = initial::scattered(&container, count, 0.3, side, seed)?;
        let disks = initial::with_maxwellian_velocities(disks, 1.0, seed)?;
        let disks = initial::without_drift(disks)?;
        let energy: f64 = disks.iter().map(Disk::translational_energy).sum();
        let heat = energy / (count as f64 - 1.0) / disks[0].mass();
        let mut run = Simulation::builder(Elastic, container.clone()).disks(disks).build()?;
        let mut crossings = Crossings::new(line, SampleTimes::every(1.0)?)?;
        run.run_until(400.0, &mut crossings)?;
        let expected = count as f64 / side * (heat / std::f64::consts::TAU).sqrt();
        for (square, rate) in squares.iter_mut().zip(crossings.rates()?) {
            *square += ((rate.mean() - expected) / rate.standard_error()).powi(2);
        }
    }
    println!("{squares:?}");
    // Sums of 20 squares of normal numbers, 20 ± 6. As the number of disks and their energy are fixed, the
    // errors are a little too large.
    assert!(squares.iter().all(|square| (4.0..40.0).contains(square)), "{squares:?}");
    Ok(())
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
            initial::with_maxwellian_velocities(initial::scattered(&container, 40, 0.4, 10.0, 1)?, 1.0, 2)?;
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

/// Disks turn back exactly on lines a radius away from walls, and on lines through the seam of periodic sides
/// and ends. None is lost or gained.
#[test]
fn disks_that_turn_back_on_a_line_have_not_crossed_it() -> Outcome {
    let is_before =
        |disk: &Disk, line: [DVec2; 2]| (disk.position() - line[0]).dot((line[1] - line[0]).perp()) < 0.0;
    for gravity in [0.0, 0.4] {
        let container = Container::closed(20.0, 16.0)?;
        let disks =
            initial::with_maxwellian_velocities(initial::scattered(&container, 50, 0.5, 16.0, 1)?, 1.0, 2)?;
        for [from, to] in [
            [(0.0, 0.5), (20.0, 0.5)],
            [(20.0, 0.5), (0.0, 0.5)],
            [(0.0, 15.5), (20.0, 15.5)],
            [(0.5, 0.0), (0.5, 16.0)],
            [(19.5, 16.0), (19.5, 0.0)],
        ] {
            let line = [from, to].map(DVec2::from);
            let builder = Simulation::builder(Elastic, container.clone()).disks(disks.clone());
            let mut run = builder.gravity(gravity).build()?;
            let before = |disks: &[Disk]| {
                (disks.iter().filter(|disk| is_before(disk, line)).count() as u64).cast_signed()
            };
            let mut crossings = Crossings::new(line, SampleTimes::every(1.0)?)?;
            for piece in 1..=40 {
                run.run_until(5.0 * f64::from(piece), &mut crossings)?;
            }
            assert!(run.counters().wall_collisions > 100);
            assert_eq!(net(&crossings), before(&disks) - before(&run.disks()), "{line:?} {gravity}");
        }
    }
    // A disk bounces on the line; it stops there, and is sent back from there.
    let bouncing = Disk::new(DVec2::splat(2.0), 0.5)?.with_velocity(DVec2::NEG_Y)?;
    let mut run = Simulation::builder(Elastic, Container::closed(4.0, 4.0)?).disks([bouncing]).build()?;
    let mut crossings =
        Crossings::new([DVec2::new(0.0, 0.5), DVec2::new(4.0, 0.5)], SampleTimes::every(6.0)?)?;
    run.run_until(60.0, &mut crossings)?;
    assert_eq!((crossings.forward(), crossings.backward()), (&[0; 10][..], &[0; 10][..]));
    let first = Disk::new(DVec2::new(1.0, 8.0), 0.5)?.with_velocity(DVec2::X)?;
    let row = [first, Disk::new(DVec2::new(6.0, 8.0), 0.5)?];
    let run = Simulation::builder(Elastic, Container::closed(40.0, 16.0)?).disks(row).build()?;
    for line in [[(5.0, 0.0), (5.0, 16.0)], [(5.0, 16.0), (5.0, 0.0)]] {
        let mut crossings = Crossings::new(line.map(DVec2::from), SampleTimes::every(1.0)?)?;
        let mut run = run.clone();
        run.run_until(74.0, &mut crossings)?;
        assert_eq!(net(&crossings), 0, "{line:?}");
    }
    Ok(())
}

/// Net crossings of the lines at the seams of a box that is periodic both ways are what the images count.
#[test]
fn crossings_of_a_seam_are_those_of_the_images() -> Outcome {
    let container = Container::periodic(12.0, 10.0)?;
    let disks = initial::scattered(&container, 30, 0.4, 10.0, 1)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 2)?;
    for [from, to] in [[(12.0, 0.0), (12.0, 10.0)], [(0.0, 0.0), (0.0, 10.0)], [(0.0, 10.0), (12.0, 10.0)]] {
        let line = [from, to].map(DVec2::from);
        let mut run = Simulation::builder(Elastic, container.clone()).disks(disks.clone()).build()?;
        let mut crossings = Crossings::new(line, SampleTimes::every(1.0)?)?;
        run.run_until(100.0, &mut crossings)?;
        let images = |disks: &[Disk]| -> i64 {
            let axis = usize::from(from.1 == to.1);
            disks.iter().map(|disk| i64::from(disk.image()[axis])).sum()
        };
        let sense = if from.1 == to.1 { 1 } else { -1 };
        assert!(crossings.forward().iter().sum::<u64>() > 20);
        assert_eq!(net(&crossings), sense * (images(&run.disks()) - images(&disks)), "{line:?}");
    }
    Ok(())
}

/// A shower through a line into a sink: disks come in above and leave below.
#[test]
fn a_shower_crosses_a_line_on_its_way_to_a_sink() -> Outcome {
    let exit = Part::polyline([(-1.0, 1.0), (9.0, 1.0)].map(DVec2::from))?.absorbing_centers();
    let vessel = Container::open(8.0)?.with_part("exit", exit)?;
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
    let disks =
        initial::with_maxwellian_velocities(initial::scattered(&container, 30, 0.5, 12.0, 1)?, 1.0, 2)?;
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
