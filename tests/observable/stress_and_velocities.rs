//! Stress, histograms, and velocities about a flow, of known states and of chance.

use granular_edmd::boundary::{Boundary, Container, Part, Region, Wall};
use granular_edmd::collision::{Contact, Elastic, Impulse};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    Accumulator, BetweenKinds, Collision, CollisionHistograms, Grid, Observable, Observer, OfKind,
    PairCorrelation, Partner, SampleTimes, Sampled, Snapshot, Stress, Temperatures, TemperaturesAboutFlow,
    VelocityDistribution, WallStress,
};
use granular_edmd::statistics::Histogram;
use granular_edmd::wall::Piston;
use granular_edmd::{Disk, Kind, ParameterError, Simulation, initial};

use crate::chance::{BOX, Chance, points};

type Outcome = Result<(), Box<dyn std::error::Error>>;

fn times() -> Result<SampleTimes, ParameterError> {
    SampleTimes::every(1.0)
}

/// One collision whose line of centers is cut by the region in halves, and one across the periodic side.
#[test]
fn a_region_gets_its_share_of_a_collision() -> Outcome {
    let domain = BOX.with_periodic_sides();
    let region = Region::new(DVec2::ZERO, DVec2::new(2.0, 10.0));
    let mut stress = Stress::new(times()?).within(region)?;
    stress.on_start(&Snapshot::new(0.0, &[], domain, 0.0).with_wall_count(2)).unwrap();
    let contact = Contact::new(2.0, 0.5, 0.5, 0.5 / 3.0);
    let at = |x: f64| {
        let impulse = Impulse::new(3.0, 1.0);
        let mut collision = Collision::new(0.5, 0, Partner::Disk(1), contact, impulse);
        (collision.normal, collision.position) = (DVec2::X, DVec2::new(x, 5.0));
        collision
    };
    // From 1.5 to 2.5; from 19.25 to 20.25, of which a quarter is beyond the side; and outside.
    for x in [2.5, 20.25, 10.0] {
        stress.on_collision(&at(x));
    }
    stress.on_sample(&Snapshot::new(1.0, &[], domain, 0.0));
    let tensor = stress.collisional();
    let (xx, yx) = (tensor.xx.mean(), tensor.yx.mean());
    assert!((xx - 3.0 * 0.75 / 20.0).abs() < 1e-15 && (yx - 0.75 / 20.0).abs() < 1e-15, "{tensor:?}");
    assert_eq!((tensor.xy.mean(), tensor.yy.mean(), tensor.pressure.samples()), (0.0, 0.0, 1));
    Ok(())
}

/// The pressure on a wall with a mass that a gas pushes from one side, over 40 seeds and two intervals: its
/// error is that of the momentum of the wall, not that of blocks of bounded sums.
#[test]
fn the_error_of_the_pressure_on_a_wall_with_a_mass_is_its_scatter() -> Outcome {
    let (force, length) = (4.0, 8.0);
    let piston = Piston::new(30.0, [-90.0, 8.0])?.with_force(force)?;
    let head = Part::polyline([(0.0, 10.0), (8.0, 10.0)].map(DVec2::from))?;
    let lid = Container::closed(8.0, 10.0)?.with_piston(Wall::Lid, piston)?;
    let head = Container::closed(8.0, 100.0)?.with_part("head", head.with_piston(DVec2::NEG_Y, piston)?)?;
    for (walls, name, interval) in [(&lid, "lid", 1.0), (&lid, "lid", 25.0), (&head, "head", 1.0)] {
        let mut squares = 0.0;
        for seed in 1..=40 {
            let disks = initial::scattered(walls, 20, 0.3, 9.0, seed)?;
            let disks = initial::with_maxwellian_velocities(disks, 1.0, seed)?;
            let mut run = Simulation::builder(Elastic, walls.clone()).disks(disks).build()?;
            run.run_until(50.0, &mut ())?;
            let mut push = WallStress::new(SampleTimes::every(interval)?).with_wall(name, length)?;
            run.run_until(350.0, &mut push)?;
            let pressure = push.pressure(name).ok_or("it is watched")?;
            squares += ((pressure.mean() - force / length) / pressure.standard_error()).powi(2);
            assert!(
                pressure.standard_error() < 0.015 * pressure.mean(),
                "{name}, {interval}, {seed}: {pressure}"
            );
        }
        // A sum of 40 squares of normal numbers is 40 ± 9, and the errors are uncertain by a tenth.
        assert!((13.0..80.0).contains(&squares), "{name}, {interval}: {squares}");
        println!("{name}, {interval}: {squares}");
    }
    Ok(())
}

/// A ball between walls, in one run and in a run in pieces that cut the intervals.
#[test]
fn a_run_in_pieces_has_the_stress_of_a_run_in_one() -> Outcome {
    let container = Container::closed(5.0, 3.0)?;
    let floor = "floor";
    let ball = Disk::new(DVec2::new(2.0, 1.0), 0.5)?.with_velocity(DVec2::new(0.3, 3.0))?;
    let measured = |ends: &[f64]| -> Result<_, Box<dyn std::error::Error>> {
        let mut run = Simulation::builder(Elastic, container.clone()).disks(vec![ball]).build()?;
        let walls = WallStress::new(times()?).with_wall(floor, 5.0)?;
        let mut watched = (walls, Stress::new(times()?));
        run.run_until(0.4, &mut ())?;
        for &end in ends {
            run.run_until(end, &mut watched)?;
        }
        Ok(watched)
    };
    let whole = measured(&[10.0])?;
    let pieces = measured(&[1.7, 3.0, 3.1, 10.0])?;
    assert_eq!(whole.0.pressure(floor), pieces.0.pressure(floor));
    assert_eq!(whole.1.tensor(), pieces.1.tensor());
    // The run began within an interval, whose rest does not count.
    assert_eq!(whole.1.tensor().pressure.samples(), 9);
    assert_eq!(whole.0.pressure("lid"), None);
    Ok(())
}

/// The second run begins where the first ended, in another box: the interval between is of no box.
#[test]
fn an_interval_of_two_domains_does_not_count() -> Outcome {
    let mut stress = Stress::new(times()?);
    let other = Container::periodic(5.0, 3.0)?.domain();
    stress.on_start(&Snapshot::new(0.0, &[], BOX, 0.0).with_wall_count(4)).unwrap();
    stress.on_end(&Snapshot::new(0.5, &[], BOX, 0.0).with_wall_count(4));
    stress.on_start(&Snapshot::new(0.5, &[], other, 0.0).with_wall_count(4)).unwrap();
    stress.on_sample(&Snapshot::new(1.0, &[], other, 0.0));
    assert_eq!(stress.tensor().pressure.samples(), 0);
    stress.on_sample(&Snapshot::new(2.0, &[], other, 0.0));
    assert_eq!(stress.tensor().pressure.samples(), 1);
    Ok(())
}

/// What is left of the velocities is rounding, and no temperature.
#[test]
fn disks_that_all_move_alike_have_no_distribution() -> Outcome {
    let grid = Grid::new(Region::new(DVec2::ZERO, DVec2::splat(10.0)), 2, 2)?;
    for k in 1..200_u32 {
        let velocity = DVec2::new(libm::sin(f64::from(k)), libm::cos(f64::from(3 * k)));
        let disk = |place: u32| {
            let at = DVec2::splat(0.5 + f64::from(place));
            Disk::new(at, 0.5)?.with_mass(0.3 + 0.37 * f64::from(place))?.with_velocity(velocity)
        };
        let disks = (0..10).map(disk).collect::<Result<Vec<_>, _>>()?;
        let snapshot = Snapshot::new(0.0, &disks, BOX, 0.0);
        let new = || VelocityDistribution::new(4.0, 8);
        for mut velocities in [new()?.about_mean(), new()?.about_flow(grid)] {
            velocities.add(&snapshot).unwrap();
            assert_eq!(velocities.second_cumulant().samples(), 0, "{velocity}");
        }
        let alone = Snapshot::new(0.0, &disks[..1], BOX, 0.0);
        assert!(TemperaturesAboutFlow::new(grid).measure(&alone).horizontal.is_nan());
    }
    Ok(())
}

#[test]
fn flow_is_no_temperature_on_a_grid() -> Outcome {
    let mut chance = Chance::new(3);
    let region = Region::new(DVec2::ZERO, DVec2::new(20.0, 10.0));
    let disks = points(40_000, &mut chance)?;
    let flows: [fn(DVec2) -> DVec2; 2] =
        [|place| DVec2::new(0.5 * place.y, 0.0), |place| 0.5 * (place - DVec2::new(10.0, 5.0)).perp()];
    for (flow, both) in flows.into_iter().zip([false, true]) {
        let moving = |disk: &Disk| disk.with_velocity(flow(disk.position()));
        let moving = disks.iter().map(moving).collect::<Result<Vec<_>, _>>()?;
        let snapshot = Snapshot::new(0.0, &moving, BOX, 0.0);
        assert!(Temperatures.measure(&snapshot).horizontal > 2.0);
        let about = |columns, rows| {
            Ok::<_, ParameterError>(
                TemperaturesAboutFlow::new(Grid::new(region, columns, rows)?).measure(&snapshot),
            )
        };
        // The rest is the flow within a cell of side 1 and of 1/5: m γ²h²/12. The mean square of 4e4 uniform
        // numbers is known to 0.9/√4e4, half of a percent.
        let left = 0.25 / 12.0;
        let (coarse, fine) = (about(20, 10)?, about(100, 50)?);
        assert!((coarse.horizontal / left - 1.0).abs() < 0.03, "{coarse:?}");
        assert!((fine.horizontal / left - 0.04).abs() < 0.002, "{fine:?}");
        assert_eq!(coarse.vertical > 0.0, both);
        assert!(!both || (coarse.vertical / left - 1.0).abs() < 0.03, "{coarse:?}");
    }
    // A gas at rest has the same temperature on any grid.
    let gas = initial::with_maxwellian_velocities(disks, 2.0, 5)?;
    let snapshot = Snapshot::new(0.0, &gas, BOX, 0.0);
    for (columns, rows) in [(1, 1), (20, 10), (100, 100)] {
        let grid = Grid::new(region, columns, rows)?;
        let temperature = TemperaturesAboutFlow::new(grid).measure(&snapshot);
        // There are 4e4 - 1e4 degrees of freedom in each direction, or more: 0.8 %.
        assert!((temperature.horizontal / 2.0 - 1.0).abs() < 0.03, "{columns}: {temperature:?}");
        assert!((temperature.translational() / 2.0 - 1.0).abs() < 0.02, "{columns}: {temperature:?}");
    }
    Ok(())
}

/// A Maxwellian gas of two masses in a swirl: only about the flow are all cumulants zero.
#[test]
fn velocities_about_a_flow_are_those_of_the_gas_in_it() -> Outcome {
    let mut chance = Chance::new(4);
    let grid = Grid::new(Region::new(DVec2::ZERO, DVec2::new(20.0, 10.0)), 10, 5)?;
    let new = || VelocityDistribution::new(4.0, 20);
    let mut distributions = [new()?, new()?.about_mean(), new()?.about_flow(grid)];
    for time in 0..400 {
        let disk = |disk: Disk| {
            let mass = 1.0 + 3.0 * f64::from(disk.kind().number());
            // One velocity for each cell, as the swirl has it at its middle.
            let cell = (disk.position() / 2.0).floor() * 2.0 + DVec2::ONE;
            let noise = DVec2::new(chance.normal(), chance.normal()) / mass.sqrt();
            disk.with_mass(mass)?.with_velocity(noise + (cell - DVec2::new(10.0, 5.0)).perp())
        };
        let disks = points(200, &mut Chance::new(time + 10))?;
        let disks = disks.into_iter().map(disk).collect::<Result<Vec<_>, _>>()?;
        let snapshot = Snapshot::new(time as f64, &disks, BOX, 0.0);
        for distribution in &mut distributions {
            distribution.add(&snapshot).unwrap();
        }
    }
    let [all, about_mean, about_flow] = &distributions;
    for estimate in [about_flow.second_cumulant(), about_flow.third_cumulant()] {
        assert!(estimate.mean().abs() < 4.0 * estimate.standard_error(), "{estimate}");
    }
    for swirling in [all, about_mean] {
        assert!(swirling.second_cumulant().mean().abs() > 0.1, "{}", swirling.second_cumulant());
    }
    assert_eq!(about_flow.speed().count(), 80_000);
    assert_eq!(about_flow.horizontal().count(), about_flow.vertical().count());
    Ok(())
}

#[test]
fn a_histogram_counts_what_is_inside_and_outside() -> Outcome {
    let mut histogram = Histogram::new(-1.0, 1.0, 4)?;
    histogram.extend([-1.0, -0.5, 0.0, 0.999, 1.0, -1.1, f64::INFINITY, f64::NEG_INFINITY, f64::NAN]);
    assert_eq!(histogram.bins().map(|bin| bin.count).collect::<Vec<_>>(), [1, 1, 1, 1]);
    assert_eq!((histogram.count(), histogram.below(), histogram.above()), (8, 2, 2));
    let bin = histogram.bins().nth(1).unwrap();
    assert_eq!((bin.low, bin.high, bin.density.mean()), (-0.5, 0.0, 0.25));
    assert_eq!(bin.density.standard_error(), (0.125_f64 * 0.875 / 8.0).sqrt() / 0.5);
    Ok(())
}

/// Numbers that come after each other are alike, as velocities in time are: the errors must hold the truth
/// all the same. Those of independent numbers would be four times too small.
#[test]
fn errors_of_a_histogram_hold_for_correlated_numbers() -> Outcome {
    let (mut held, mut called) = (0, 0);
    for seed in 0..200 {
        let mut histogram = Histogram::new(-2.0, 2.0, 8)?;
        // A series with correlation 0.9 between neighbors, of variance 1.
        let mut chance = Chance::new(seed);
        let mut present = chance.normal();
        for _ in 0..50_000 {
            present = 0.9 * present + (1.0_f64 - 0.81).sqrt() * chance.normal();
            histogram.push(present);
        }
        // The bin from 0 to 0.5 has 19.15 % of a normal distribution.
        let density = histogram.bins().nth(4).ok_or("no bin")?.density;
        called += u32::from(density.is_converged());
        held += u32::from((density.mean() - 2.0 * 0.191_462).abs() < 2.0 * density.standard_error());
    }
    assert!(called >= 180 && held >= 180, "{called} of 200 are converged, {held} within two errors");
    Ok(())
}

#[test]
fn a_wall_has_histograms_of_its_own() -> Outcome {
    let mut histograms = CollisionHistograms::new(4.0, 4.0, 4)?.with_wall("wall 1");
    histograms.on_start(&Snapshot::new(0.0, &[], BOX, 0.0).with_wall_count(2))?;
    let contact = Contact::new(1.5, -1.5, 1.0, 1.0 / 3.0);
    for partner in [Partner::Disk(1), Partner::Wall(0), Partner::Wall(1)] {
        histograms.on_collision(&Collision::new(0.5, 0, partner, contact, Impulse::new(3.0, 0.0)));
    }
    let counts = |histogram: &Histogram| histogram.bins().map(|bin| bin.count).collect::<Vec<_>>();
    assert_eq!(counts(histograms.obliqueness()), [1, 0, 0, 0]);
    assert_eq!(counts(histograms.closing_speed()), [0, 1, 0, 0]);
    assert_eq!(counts(histograms.impulse()), [0, 0, 0, 1]);
    Ok(())
}

/// The parts of all pairs of kinds add up to the whole.
#[test]
fn measures_by_kind_are_parts_of_the_whole() -> Outcome {
    let container = Container::periodic(20.0, 20.0)?;
    let disks = initial::scattered(&container, 120, 0.5, 20.0, 1)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 2)?;
    let kinds = [Kind::new(0), Kind::new(1)];
    let kind = |(index, disk): (usize, Disk)| disk.with_kind(kinds[usize::from(index % 3 == 0)]);
    let disks: Vec<Disk> = disks.into_iter().enumerate().map(kind).collect();
    let pairs = [(0, 0), (0, 1), (1, 1)].map(|(i, j): (usize, usize)| (kinds[i], kinds[j]));
    let between = pairs.map(|(i, j)| BetweenKinds::new(i, j, Stress::new(SampleTimes::every(0.5).unwrap())));
    let histograms = CollisionHistograms::new(5.0, 5.0, 1)?;
    let met = pairs.map(|(i, j)| BetweenKinds::new(i, j, histograms.clone()));
    let alike = PairCorrelation::new(2.0, 4)?;
    let mut watched = (
        (Stress::new(SampleTimes::every(0.5)?), Vec::from(between)),
        (histograms.clone(), Vec::from(met)),
        (
            OfKind::new(kinds[1], Sampled::new(alike.clone(), times()?)),
            Sampled::new(alike.between(kinds[1], kinds[1]), times()?),
        ),
    );
    Simulation::builder(Elastic, container).disks(disks).build()?.run_until(50.0, &mut watched)?;
    let ((whole, stresses), (all, met), (of_kind, between)) = watched;
    let sum: f64 = stresses.iter().map(|part| part.inner().collisional().pressure.mean()).sum();
    assert!((sum / whole.collisional().pressure.mean() - 1.0).abs() < 1e-12);
    let sum: u64 = met.iter().map(|part| part.inner().impulse().count()).sum();
    assert!(sum == all.impulse().count() && sum > 1000);
    assert!(of_kind.inner().iter().map(|(_, value)| value.mean()).eq(between.iter().map(|(_, v)| v.mean())));
    Ok(())
}
