//! Measures that were once wrong without a word, each in the setting that showed it.

use std::f64::consts::PI;

use granular_edmd::boundary::{Boundary, Brick, Container, Part, Probe, Region, Wall};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    Accumulator, CenterOfMass, EnergyChange, EnergyChangeProfile, Fields, Grid, HeightProfile,
    MeanSquaredDisplacement, Observable, Observer, PairCorrelation, SampleTimes, Sampled, Series, Snapshot,
    Stress, Temperatures, TemperaturesAboutFlow, TimeCorrelation, WallStress, measured_by,
};
use granular_edmd::replay::Replay;
use granular_edmd::simulation::{Inlet, RunError};
use granular_edmd::wall::Sinusoidal;
use granular_edmd::{Disk, ParameterError, Simulation, initial};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

type Failure = Box<dyn std::error::Error>;

fn times() -> Result<SampleTimes, ParameterError> {
    SampleTimes::every(1.0)
}

/// Returns the reason of an error; nothing without one.
#[expect(clippy::needless_pass_by_value, reason = "it is what `map_err` and `err` give")]
fn told(error: Option<RunError>) -> String {
    let source = error.as_ref().and_then(std::error::Error::source);
    source.map(ToString::to_string).unwrap_or_default()
}

fn disk(x: f64, y: f64) -> Result<Disk, ParameterError> {
    Disk::new(DVec2::new(x, y), 0.4)
}

fn corners<const N: usize>(corners: [(f64, f64); N]) -> [DVec2; N] {
    corners.map(DVec2::from)
}

/// A thin gas of 200 small disks, which is nearly ideal: the pressure is n T, but for some thousandths.
fn gas<B: Boundary + Clone>(boundary: &B, height: f64) -> Result<Simulation<Elastic, B>, Failure> {
    let disks = initial::scattered(boundary, 200, 0.01, height, 1)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 2)?;
    Ok(Simulation::builder(Elastic, boundary.clone()).disks(disks).build()?)
}

fn pressure_of<B: Boundary + Clone>(boundary: &B, height: f64, area: f64) -> Result<f64, Failure> {
    let mut run = gas(boundary, height)?;
    let mut stress = Stress::new(times()?);
    run.run_until(400.0, &mut stress)?;
    let ideal = 200.0 / area * run.measure(&Temperatures).translational();
    Ok(stress.tensor().pressure.mean() / ideal)
}

#[test]
fn the_pressure_in_any_vessel_is_that_of_its_own_area() -> Result<(), Failure> {
    let drum = Container::around([("drum", Part::drum(DVec2::ZERO, 10.0)?)])?;
    let triangle = Part::polygon(corners([(0.0, 0.0), (20.0, 0.0), (0.0, 15.0)]))?;
    let triangle = Container::around([("triangle", triangle)])?;
    let block = Part::block(corners([(4.0, 4.0), (10.0, 4.0), (10.0, 10.0), (4.0, 10.0)]))?;
    let block = Container::closed(12.0, 12.0)?.with_part("block", block)?;
    for (vessel, height, area) in [(drum, 10.0, 100.0 * PI), (triangle, 15.0, 150.0), (block, 12.0, 108.0)] {
        let ratio = pressure_of(&vessel, height, area)?;
        assert!((ratio - 1.0).abs() < 0.015, "{ratio}");
    }
    let pegs = Container::closed(12.0, 12.0)?.with_pegs([Disk::new(DVec2::splat(6.0), 4.0)?])?;
    let ratio = pressure_of(&pegs, 12.0, 144.0 - 16.0 * PI)?;
    assert!((ratio - 1.0).abs() < 0.015, "{ratio}");
    Ok(())
}

/// In a dense gas, the pressure inside is the pressure on the walls, whatever their shape.
#[test]
fn the_pressure_of_a_dense_gas_is_that_on_the_walls() -> Result<(), Failure> {
    let drum = Container::around([("wall", Part::drum(DVec2::ZERO, 6.0)?)])?;
    let triangle = Part::polygon(corners([(0.0, 0.0), (16.0, 0.0), (0.0, 12.0)]))?;
    let triangle = Container::around([("wall", triangle)])?;
    for (vessel, length) in [(drum, vec![12.0 * PI]), (triangle, vec![16.0, 20.0, 12.0])] {
        let disks = initial::scattered(&vessel, 40, 0.5, 12.0, 1)?;
        let disks = initial::with_maxwellian_velocities(disks, 1.0, 2)?;
        let name =
            |brick: usize| if length.len() == 1 { "wall".into() } else { format!("wall, brick {brick}") };
        let numbered = || length.iter().enumerate();
        let mut pushed = numbered()
            .try_fold(WallStress::new(SampleTimes::every(20.0)?), |stress, (brick, &length)| {
                stress.with_wall(name(brick), length)
            })?;
        let mut stress = Stress::new(SampleTimes::every(20.0)?);
        let mut run = Simulation::builder(Elastic, vessel).disks(disks).build()?;
        run.run_until(8000.0, &mut (&mut stress, &mut pushed))?;
        let force =
            numbered().filter_map(|(brick, length)| Some(pushed.pressure(&name(brick))?.mean() * length));
        let (on_walls, inside) = (force.sum::<f64>() / length.iter().sum::<f64>(), stress.tensor().pressure);
        let ratio = inside.mean() / on_walls;
        assert!((ratio - 1.0).abs() < 2e-3, "{ratio}");
    }
    Ok(())
}

#[test]
fn a_profile_of_a_triangle_is_flat() -> Result<(), Failure> {
    let triangle = Part::polygon(corners([(0.0, 0.0), (20.0, 0.0), (0.0, 15.0)]))?;
    let vessel = Container::around([("triangle", triangle)])?;
    let mut run = gas(&vessel, 15.0)?;
    let mut profile = Sampled::new(HeightProfile::new(-2.0, 17.0, 19)?, times()?);
    let grid = Grid::new(Region::new(DVec2::ZERO, DVec2::new(20.0, 15.0)), 2, 3)?;
    let mut fields = Sampled::new(Fields::new(grid), times()?);
    run.run_until(4000.0, &mut (&mut profile, &mut fields))?;
    let expected = 200.0 * PI * 1e-4 / 150.0;
    for (height, fraction) in profile.iter().filter(|(height, _)| (0.0..13.0).contains(height)) {
        assert!((fraction / expected - 1.0).abs() < 0.08, "{height}: {fraction}");
    }
    let outside = profile.iter().filter(|(height, _)| *height < 0.0 || *height > 15.0);
    assert!(outside.map(|(_, fraction)| fraction).all(|fraction| fraction == 0.0));
    for cell in fields.iter().filter(|cell| cell.count > 0) {
        let fraction = cell.number_density / (200.0 / 150.0);
        assert!((fraction - 1.0).abs() < 0.06, "{}: {fraction}", cell.center);
        assert!((cell.packing_fraction / cell.number_density / (PI * 1e-4) - 1.0).abs() < 1e-9);
    }
    Ok(())
}

#[test]
fn the_layer_that_a_floor_sweeps_has_the_area_that_is_left() -> Result<(), Failure> {
    // The floor is at height 1 at the samples, in the middle of the lowest layer.
    let motion = Sinusoidal::new(1.0, 2.0 * PI)?;
    let container = Container::closed(10.0, 8.0)?.with_motion(Wall::Floor, motion)?;
    let still = disk(5.0, 1.5)?;
    let run = Simulation::builder(Elastic, container).disks([still]).starting_at(0.25).build()?;
    let (mut profile, region) =
        (HeightProfile::new(0.0, 8.0, 4)?, Region::new(DVec2::ZERO, DVec2::splat(8.0)));
    let mut fields = Fields::new(Grid::new(region, 1, 4)?);
    profile.add(&run.snapshot()).unwrap();
    fields.add(&run.snapshot()).unwrap();
    let lowest = profile.iter().next().map(|(_, fraction)| fraction);
    assert!((lowest.unwrap_or(0.0) / (PI * 0.16 / 10.0) - 1.0).abs() < 1e-9, "{lowest:?}");
    assert!((fields.iter().next().map_or(0.0, |cell| cell.number_density) - 1.0 / 8.0).abs() < 1e-9);
    Ok(())
}

/// A boundary that knows its area only in some regions, at some times.
#[derive(Clone)]
struct Silent {
    vessel: Container,
    origin: f64,
    knows: fn(&Region, f64) -> bool,
}

impl Silent {
    fn drum(knows: fn(&Region, f64) -> bool) -> Result<Self, Failure> {
        let vessel = Container::around([("drum", Part::drum(DVec2::ZERO, 10.0)?)])?;
        Ok(Self { vessel, origin: 0.0, knows })
    }
}

impl Boundary for Silent {
    fn domain(&self) -> granular_edmd::boundary::Domain {
        self.vessel.domain()
    }
    fn wall_count(&self) -> usize {
        self.vessel.wall_count()
    }
    fn set_time_origin(&mut self, origin: f64) {
        self.origin = origin;
        self.vessel.set_time_origin(origin);
    }
    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.vessel.may_touch(region, radius)
    }
    fn first_touch(
        &self,
        flight: &granular_edmd::Flight,
        until: f64,
    ) -> granular_edmd::boundary::FirstTouch<granular_edmd::boundary::Touch> {
        self.vessel.first_touch(flight, until)
    }
    fn surface(&self, wall: usize, position: DVec2, time: f64) -> granular_edmd::boundary::Surface<'_> {
        self.vessel.surface(wall, position, time)
    }
    fn overlap(&self, probe: &Probe) -> Option<granular_edmd::boundary::Overlap> {
        self.vessel.overlap(probe)
    }
    fn area(&self, region: &Region, radius: f64, time: f64) -> Option<f64> {
        self.vessel.area(region, radius, time).filter(|_| (self.knows)(region, self.origin + time))
    }
}

#[test]
fn an_unknown_area_is_refused_by_name() -> Result<(), Failure> {
    let drum = Silent::drum(|_, _| false)?;
    let refusal = |observer: &mut dyn Observer| {
        let failed = gas(&drum, 10.0).ok().and_then(|mut run| run.run_until(5.0, observer).err());
        told(failed)
    };
    let across = Region::new(DVec2::ZERO, DVec2::splat(9.0));
    let inside = Region::new(DVec2::ZERO, DVec2::splat(5.0));
    for message in [
        refusal(&mut Stress::new(times()?)),
        refusal(&mut Stress::new(times()?).within(across)?),
        refusal(&mut Sampled::new(HeightProfile::new(-10.0, 10.0, 4)?, times()?)),
        refusal(&mut Sampled::new(Fields::new(Grid::new(across, 2, 2)?), times()?)),
    ] {
        assert!(message.contains("Boundary::area"), "{message:?}");
    }
    // The whole is known, and its parts are not.
    let coarse = Silent::drum(|region, _| region.max.distance(region.min) > 28.0)?;
    let (whole, mut fields) = (Region::new(DVec2::splat(-10.0), DVec2::splat(10.0)), None);
    for observer in [
        &mut Sampled::new(HeightProfile::new(-10.0, 10.0, 4)?, times()?) as &mut dyn Observer,
        fields.insert(Sampled::new(Fields::new(Grid::new(whole, 2, 2)?), times()?)),
    ] {
        let message = told(gas(&coarse, 10.0)?.run_until(5.0, observer).err());
        assert!(message.contains("Boundary::area"), "{message:?}");
    }
    assert_eq!(fields.map(|fields| fields.samples()), Some(0));
    // Where no wall can be, all is free.
    assert_eq!(refusal(&mut Stress::new(times()?).within(inside)?), "");
    assert_eq!(refusal(&mut Sampled::new(Fields::new(Grid::new(inside, 2, 2)?), times()?)), "");
    Ok(())
}

/// Boundaries are asked for areas inside the domain only, so a seam needs no care of theirs.
#[test]
fn measures_that_reach_beyond_a_seam_are_cut_there() -> Result<(), Failure> {
    let plain = Container::periodic(9.0, 6.0)?;
    let inside = |region: &Region, _| {
        let Region { min, max, .. } = *region;
        min.cmpge(DVec2::ZERO).all() && max.cmple(DVec2::new(9.0, 6.0)).all()
    };
    let torus = Silent { vessel: plain.clone(), origin: 0.0, knows: inside };
    let wide = Region::new(DVec2::new(-3.0, -2.0), DVec2::new(12.0, 8.0));
    let start = disk(2.0, 3.0)?.with_velocity(DVec2::new(0.3, 0.77))?;
    let profile = Sampled::new(HeightProfile::new(-1.0, 8.0, 3)?, times()?);
    let fields = Sampled::new(Fields::new(Grid::new(wide, 2, 2)?), times()?);
    let (mut found, mut expected) = ((profile.clone(), fields.clone()), (profile, fields));
    let mut run = Simulation::builder(Elastic, torus).disks([start]).build()?;
    run.run_until(50.0, &mut (&mut found.0, &mut found.1))?;
    let mut run = Simulation::builder(Elastic, plain).disks([start]).build()?;
    run.run_until(50.0, &mut (&mut expected.0, &mut expected.1))?;
    assert_eq!(found, expected);
    // Each of the four cells has a fourth of the area, 54.
    let densities: f64 = found.1.iter().map(|cell| cell.number_density).sum();
    assert!((densities * 54.0 / 4.0 - 1.0).abs() < 1e-12, "{densities}");
    Ok(())
}

/// What was measured before stays.
#[test]
fn an_area_that_becomes_unknown_ends_the_run() -> Result<(), Failure> {
    let drum = Silent::drum(|_, time| time < 2.5)?;
    let whole = Region::new(DVec2::splat(-10.0), DVec2::splat(10.0));
    let times = SampleTimes::every(1.0)?;
    let mut fields = Sampled::new(Fields::new(Grid::new(whole, 1, 1)?), times);
    let mut profile = Sampled::new(HeightProfile::new(-10.0, 10.0, 1)?, times);
    let mut stress = Stress::new(times);
    for observer in [&mut fields as &mut dyn Observer, &mut profile, &mut stress] {
        let message = told(gas(&drum, 10.0)?.run_until(5.0, observer).err());
        assert!(message.contains("Boundary::area"), "{message:?}");
    }
    assert_eq!([fields.samples(), profile.samples(), stress.tensor().pressure.samples()], [2; 3]);
    assert!(fields.iter().all(|cell| cell.packing_fraction.is_finite()));
    assert!(stress.tensor().pressure.mean().is_finite());
    Ok(())
}

#[test]
fn pairs_of_a_gas_whose_number_grows_are_those_of_an_ideal_gas() -> Result<(), Failure> {
    let model = Disk::new(DVec2::ZERO, 1e-4)?.with_velocity(DVec2::new(0.6, 0.3))?;
    let mut run = Simulation::builder(Elastic, Container::periodic(50.0, 50.0)?).build()?;
    let everywhere = [DVec2::ZERO, DVec2::splat(50.0)];
    run.add_inlet(Inlet::new(everywhere, [model], SampleTimes::every(50.0)?, 5)?)?;
    let whole = PairCorrelation::new(20.0, 10)?;
    let part = whole.clone().within(Region::new(DVec2::splat(5.0), DVec2::splat(35.0)))?;
    let times = SampleTimes::every(17.0)?;
    let (mut whole, mut part) = (Sampled::new(whole, times), Sampled::new(part, times));
    run.run_until(10000.0, &mut (&mut whole, &mut part))?;
    for correlation in [&whole, &part] {
        let mean = correlation.iter().skip(3).map(|(_, value)| value.mean()).sum::<f64>() / 7.0;
        assert!((mean - 1.0).abs() < 0.03, "{mean}");
    }
    Ok(())
}

/// An ideal gas has no correlations, also if some samples have no disks, or if the box changes its size.
#[test]
fn pairs_of_an_ideal_gas_in_samples_without_disks_and_in_boxes_of_two_sizes() -> Result<(), Failure> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut mean = |numbers: [usize; 4], sizes: [f64; 2], is_periodic: bool| -> Result<f64, Failure> {
        let mut correlation = PairCorrelation::new(3.0, 3)?;
        for sample in 0..10_000 {
            let size = sizes[sample / 5_000];
            let mut place = || random.random_range(0.0..size);
            let disks: Result<Vec<Disk>, _> =
                (0..numbers[sample % 4]).map(|_| Disk::new(DVec2::new(place(), place()), 1e-6)).collect();
            let domain = if is_periodic {
                Container::periodic(size, size)?.domain()
            } else {
                Container::closed(size, size)?.domain()
            };
            correlation.add(&Snapshot::new(sample as f64, &disks?, domain, 0.0)).unwrap();
        }
        Ok(correlation.iter().map(|(_, value)| value.mean()).sum::<f64>() / 3.0)
    };
    for numbers in [[0, 1, 2, 3], [0, 0, 0, 2], [0, 4, 0, 4], [0, 0, 0, 20], [10; 4]] {
        for sizes in [[10.0, 10.0], [10.0, 20.0]] {
            for is_periodic in [true, false] {
                let found = mean(numbers, sizes, is_periodic)?;
                assert!((found - 1.0).abs() < 0.1, "{numbers:?} {sizes:?} {is_periodic}: {found}");
            }
        }
    }
    Ok(())
}

/// A lattice with disks exactly on the upper edges of a periodic box is the one with disks on the lower
/// edges.
#[test]
fn disks_on_a_seam_are_counted_once() -> Result<(), Failure> {
    let lattice = |first: f64| -> Result<Vec<Disk>, Failure> {
        let place = |k: u32| DVec2::new(first + f64::from(k % 20), first + f64::from(k / 20));
        (0..240).map(|k| Ok(Disk::new(place(k), 0.5)?.with_velocity(DVec2::new(-1.0, -1.0))?)).collect()
    };
    let region = |x: f64| Region::new(DVec2::new(x, 0.0), DVec2::new(x + 10.0, 12.0));
    let measured = |first: f64, region: Region| -> Result<_, Failure> {
        let mut run =
            Simulation::builder(Elastic, Container::periodic(20.0, 12.0)?).disks(lattice(first)?).build()?;
        let mut pairs = Sampled::new(PairCorrelation::new(1.2, 1)?.within(region)?, times()?);
        let mut stress = Stress::new(times()?).within(region)?;
        let mut profile = Sampled::new(EnergyChangeProfile::new(0.0, 12.0, 1)?, times()?);
        let grid = Grid::new(region, 1, 1)?;
        let mut fields = Sampled::new(Fields::new(grid), times()?);
        run.run_until(3.0, &mut (&mut pairs, &mut stress, &mut profile, &mut fields))?;
        let pressure = stress.tensor().pressure.mean();
        let g = pairs.iter().next().map(|(_, value)| value.mean());
        let heat = TemperaturesAboutFlow::new(grid).measure(&run.snapshot());
        let layer = profile.layers()[0].translational_temperature.count();
        Ok((g.map(f64::to_bits), pressure, fields.iter().map(|cell| cell.count).sum::<u64>(), layer, heat))
    };
    for region in [region(0.0), region(10.0), Region::new(DVec2::ZERO, DVec2::new(20.0, 12.0))] {
        assert_eq!(measured(0.0, region)?, measured(1.0, region)?, "{region:?}");
    }
    Ok(())
}

#[test]
fn pairs_near_walls_are_refused() -> Result<(), Failure> {
    let drum = Container::around([("drum", Part::drum(DVec2::ZERO, 10.0)?)])?;
    let correlation = || PairCorrelation::new(3.0, 10);
    let at_wall = correlation()?.within(Region::new(DVec2::ZERO, DVec2::splat(6.0)))?;
    for correlation in [correlation()?, at_wall] {
        let failed = gas(&drum, 10.0)?.run_until(5.0, &mut Sampled::new(correlation, times()?));
        let message = told(failed.err());
        assert!(message.contains("region"), "{message:?}");
    }
    let inside = correlation()?.within(Region::new(DVec2::ZERO, DVec2::splat(4.0)))?;
    gas(&drum, 10.0)?.run_until(5.0, &mut Sampled::new(inside, times()?))?;
    // A region that begins at the floor has half of its shells in the ground.
    let floor = Container::closed(20.0, 20.0)?;
    let layer = correlation()?.within(Region::new(DVec2::new(5.0, 0.0), DVec2::new(15.0, 2.0)))?;
    assert!(gas(&floor, 20.0)?.run_until(5.0, &mut Sampled::new(layer, times()?)).is_err());
    Ok(())
}

#[test]
fn a_center_of_mass_on_a_seam_is_on_the_seam() -> Result<(), Failure> {
    let center = |container: Container, disks: &[Disk]| -> Result<DVec2, Failure> {
        let run = Simulation::builder(Elastic, container).disks(disks.to_vec()).build()?;
        Ok(run.measure(&CenterOfMass))
    };
    let pair = [disk(9.5, 5.0)?, disk(0.5, 5.0)?];
    let on_seam = center(Container::periodic(10.0, 10.0)?, &pair)?;
    assert!(on_seam.x.min(10.0 - on_seam.x).abs() < 1e-12 && (on_seam.y - 5.0).abs() < 1e-12, "{on_seam}");
    // With walls, it is the arithmetic mean, bit for bit; with periodic sides the height is.
    let heavy = [disk(9.0, 1.1)?.with_mass(3.0)?, disk(8.1, 7.3)?];
    let mean = |axis: usize| (heavy[0].position()[axis] * 3.0 + heavy[1].position()[axis]) / 4.0;
    assert_eq!(center(Container::closed(10.0, 10.0)?, &heavy)?, DVec2::new(mean(0), mean(1)));
    let sides = center(Container::closed(10.0, 10.0)?.with_periodic_sides()?, &heavy)?;
    assert_eq!(sides.y, mean(1));
    // The circular mean moves with the disks.
    let moved = [disk(1.0, 1.1)?.with_mass(3.0)?, disk(0.1, 7.3)?];
    let moved = center(Container::closed(10.0, 10.0)?.with_periodic_sides()?, &moved)?;
    assert!((moved.x + 8.0 - sides.x).abs() < 1e-12, "{moved} {sides}");
    // Evenly spread disks have no center.
    let even = [disk(2.5, 5.0)?, disk(7.5, 5.0)?];
    assert!(center(Container::periodic(10.0, 10.0)?, &even)?.x.is_nan());
    Ok(())
}

#[test]
fn disks_put_elsewhere_have_not_moved_there() -> Result<(), Failure> {
    let flying = disk(1.0, 1.0)?.with_velocity(DVec2::new(0.3, 0.4))?;
    let mut run = Simulation::builder(Elastic, Container::periodic(8.0, 8.0)?).disks([flying]).build()?;
    let mut displacement = MeanSquaredDisplacement::new(4, times()?)?;
    let first = measured_by(|snapshot: &Snapshot<'_>| snapshot.disks()[0].position());
    let mut correlation = TimeCorrelation::new(first, 1, times()?)?;
    for piece in 1..=20 {
        run.run_until(f64::from(piece) * 2.5, &mut (&mut displacement, &mut correlation))?;
        if piece % 4 == 0 {
            let by = |disk: &Disk| if disk.position().y < 4.0 { 0.7 } else { -0.7 };
            run.map_disks(|_, disk| disk.with_position(disk.position() + DVec2::new(0.0, by(&disk))))?;
        }
    }
    for (time, squared) in displacement.iter() {
        let expected = 0.25 * time * time;
        assert!((squared.mean() - expected).abs() < 1e-9, "{time}: {} not {expected}", squared.mean());
    }
    // A run in pieces with nothing put elsewhere keeps all pairs.
    let mut run = Simulation::builder(Elastic, Container::periodic(8.0, 8.0)?).disks([flying]).build()?;
    let mut pieces = MeanSquaredDisplacement::new(4, times()?)?;
    for piece in 1..=20 {
        run.run_until(f64::from(piece) * 2.5, &mut pieces)?;
    }
    assert_eq!(pieces.iter().nth(4).map(|(_, value)| value.samples()), Some(46));
    Ok(())
}

/// A disk is taken out, and put back elsewhere after a run without it.
#[test]
fn a_disk_that_comes_back_elsewhere_has_not_moved_there() -> Result<(), Failure> {
    let disks = [disk(1.0, 1.0)?.with_id(1)?, disk(3.0, 3.0)?.with_id(2)?];
    let mut run = Simulation::builder(Elastic, Container::periodic(8.0, 8.0)?).disks(disks).build()?;
    let mut displacement = MeanSquaredDisplacement::new(4, times()?)?;
    run.run_until(2.0, &mut displacement)?;
    let removed = run.remove(|_, disk| disk.id() == 2)?;
    run.run_until(2.0, &mut displacement)?;
    run.insert(
        removed.iter().map(|disk| disk.with_position(DVec2::splat(6.0))).collect::<Result<Vec<_>, _>>()?,
    )?;
    run.run_until(9.0, &mut displacement)?;
    assert!(displacement.iter().all(|(_, squared)| squared.mean() == 0.0));
    Ok(())
}

#[test]
fn two_systems_in_one_observer_are_refused_by_name() -> Result<(), Failure> {
    let drum = Container::around([("drum", Part::drum(DVec2::ZERO, 10.0)?)])?;
    let (mut one, mut other) = (gas(&drum, 10.0)?, gas(&drum, 10.0)?);
    let (mut change, mut series) = (EnergyChange::default(), Series::new(Temperatures, times()?));
    one.run_until(3.0, &mut (&mut change, &mut series))?;
    one.run_until(5.0, &mut (&mut change, &mut series))?;
    other.run_until(6.5, &mut ())?;
    let refusals = [other.run_until(7.0, &mut change).err(), other.run_until(7.0, &mut series).err()];
    for refusal in refusals {
        let message = told(refusal);
        assert!(message.contains("of the same system; take a new"), "{message:?}");
    }
    (change, series) = (EnergyChange::default(), Series::new(Temperatures, times()?));
    other.run_until(8.0, &mut (&mut change, &mut series))?;
    assert_eq!(series.times(), [7.0, 8.0]);
    // The same run from an earlier state is another one, too.
    let mut copy = other.clone();
    other.run_until(9.0, &mut change)?;
    assert!(copy.run_until(10.0, &mut change).is_err());
    Ok(())
}

#[test]
fn a_series_from_negative_times_may_be_cut_at_its_samples() -> Result<(), Failure> {
    let container = Container::closed(10.0, 10.0)?;
    for start in [-10.0, -7.0, -100.0, -3.3, -1e4] {
        for interval in [0.1, 0.3, 0.7, 1.0, 1.0 / 3.0] {
            let disks = [disk(2.0, 2.0)?.with_velocity(DVec2::new(1.0, 0.7))?];
            let run =
                || Simulation::builder(Elastic, container.clone()).disks(disks).starting_at(start).build();
            let (mut whole, mut pieces) = (run()?, run()?);
            let series = || -> Result<_, ParameterError> {
                Ok(Series::new(CenterOfMass, SampleTimes::every(interval)?))
            };
            let (mut expected, mut cut) = (series()?, series()?);
            let first = (start / interval).ceil() as i32;
            for beat in first..first + 60 {
                let end = (f64::from(beat) * interval).max(pieces.time());
                pieces.run_until(end, &mut cut)?;
            }
            whole.run_until(f64::from(first + 59) * interval, &mut expected)?;
            assert_eq!(cut.times(), expected.times(), "from {start} by {interval}");
        }
    }
    Ok(())
}

#[test]
fn a_replay_names_the_disks_that_an_inlet_let_in() -> Result<(), Failure> {
    let grain = disk(0.0, 0.0)?;
    let places = [DVec2::new(1.0, 8.0), DVec2::new(9.0, 9.0)];
    let run = |interval: f64| -> Result<_, Failure> {
        let container = Container::closed(10.0, 12.0)?;
        let mut run = Simulation::builder(Elastic, container).gravity(1.0).build()?;
        run.add_inlet(Inlet::new(places, [grain], SampleTimes::every(5.0)?, 7)?)?;
        let mut replay = Replay::new(run, interval)?;
        replay.run_until(40.0)?;
        Ok(replay)
    };
    let coarse = run(3.0)?;
    let collisions = coarse.collisions(0.0, 40.0)?;
    assert!(collisions.len() > 20);
    assert!(collisions.iter().all(|one| one.id > 0 && one.partner_id != Some(0)));
    let fine = run(0.05)?;
    assert_eq!(collisions, fine.collisions(0.0, 40.0)?);
    assert_eq!(coarse.last_collisions_of(1, 40.0, 99)?, fine.last_collisions_of(1, 40.0, 99)?);
    Ok(())
}

#[test]
fn an_open_line_has_an_area_too() -> Result<(), Failure> {
    let bowl = Part::new([Brick::arc(DVec2::new(5.0, 5.0), 5.0, PI, 2.0 * PI)?])?;
    let vessel = Container::closed(10.0, 10.0)?.with_part("bowl", bowl)?;
    let ratio = pressure_of(&vessel, 10.0, 50.0 + 12.5 * PI)?;
    assert!((ratio - 1.0).abs() < 0.015, "{ratio}");
    Ok(())
}
