//! Work and fluctuations of moving walls: Jarzynski's equality, and a free piston between two gases.

use granular_edmd::boundary::{Container, Part, Wall};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::initial;
use granular_edmd::observable::{FreeWall, SampleTimes, Series};
use granular_edmd::random::{Stream, generator, normal, uniform};
use granular_edmd::statistics::RunningMean;
use granular_edmd::wall::{Piston, Tabulated};
use granular_edmd::{Disk, Simulation};

use crate::{Outcome, agrees};

type Failure = Box<dyn std::error::Error>;

/// Returns the work on disks of diameter 1 and of these masses, in a row between floor and lid, while the lid
/// moves and changes the free length from one number to another. The disks start at temperature 1.
fn work(masses: &[f64], [from, to]: [f64; 2], duration: f64, index: u64) -> Result<f64, Failure> {
    let mut random = generator(1, Stream::Custom(3), index);
    let count = masses.len() as f64;
    let lid = Tabulated::from_to(0.0, from - to, duration)?;
    let container = Container::closed(3.0, from + count)?.with_motion(Wall::Lid, lid)?;
    let mut places: Vec<f64> = masses.iter().map(|_| from * uniform(&mut random)).collect();
    places.sort_by(f64::total_cmp);
    let mut disks = Vec::new();
    for (number, (place, &mass)) in (0..).map(f64::from).zip(places.iter().zip(masses)) {
        let velocity = normal(&mut random) / mass.sqrt() * DVec2::Y;
        let disk = Disk::new(DVec2::new(1.5, place + number + 0.5), 0.5 * (1.0 - 1e-9))?;
        disks.push(disk.with_mass(mass)?.with_velocity(velocity)?);
    }
    let energy = |disks: &[Disk]| disks.iter().map(Disk::translational_energy).sum::<f64>();
    let before = energy(&disks);
    let mut run = Simulation::builder(Elastic, container).disks(disks).build()?;
    run.run_until(duration, &mut ())?;
    Ok(energy(&run.disks()) - before)
}

/// Jarzynski's equality (1997), ⟨exp(-W/T)⟩ = exp(-ΔF/T), which is the ratio of the free lengths to the power
/// of the number of disks: however fast the lid moves, forth and back.
#[test]
fn the_work_of_a_lid_obeys_jarzynski() -> Outcome {
    let (one, three): (&[f64], &[f64]) = (&[1.0], &[1.0, 2.0, 3.0]);
    for (masses, lengths) in [(one, [9.0, 7.0]), (three, [9.0, 8.0])] {
        for (way, [from, to]) in [("forth", lengths), ("back", [lengths[1], lengths[0]])] {
            let works: Result<Vec<f64>, _> =
                (0..20_000).map(|run| work(masses, [from, to], 5.0, run)).collect();
            let works = works?;
            let mean: RunningMean = works.iter().map(|work| (-work).exp()).collect();
            let expected = (to / from).powf(masses.len() as f64);
            let name = format!("exp(-W/T), {} {way}", masses.len());
            let error = mean.standard_error() / expected;
            // The mean work is another number: the lid does not move slowly.
            let lost = works.iter().sum::<f64>() / works.len() as f64 + expected.ln();
            println!("  error {error:.4}, lost {lost}");
            assert!(error < 0.03 && lost > 0.05, "{error} {lost}");
            assert!(agrees(&name, mean.mean(), expected, 4.0 * error));
        }
    }
    Ok(())
}

/// Length and height of the box of the two gases, and the radius of their disks.
const BOX: [f64; 3] = [20.0, 5.0, 0.1];

/// Returns the mean and the variance of the position of a piston between two gases in equilibrium: the
/// density is that of the areas to the powers of the numbers of disks, each less what pairs of disks exclude.
fn position([left, right]: [f64; 2]) -> [f64; 2] {
    let [length, height, radius] = BOX;
    let log = |count: f64, area: f64| {
        let excluded = 2.0 * std::f64::consts::PI * radius * radius;
        count * area.ln() - excluded * count * (count - 1.0) / area
    };
    let clear = height - 2.0 * radius;
    let sums = (1..4000).fold([0.0; 3], |[zero, one, two], step| {
        let x = 2.0 * radius + (length - 4.0 * radius) * f64::from(step) / 4000.0;
        let areas = [x - 2.0 * radius, length - x - 2.0 * radius].map(|free| free * clear);
        let weight = (log(left, areas[0]) + log(right, areas[1]) - 70.0).exp();
        [zero + weight, one + weight * x, two + weight * x * x]
    });
    let mean = sums[1] / sums[0];
    [mean, sums[2] / sums[0] - mean * mean]
}

/// A partition of mass 2 between gases of 6 and 12 disks, far from equilibrium at first: its mean position,
/// the variance of the position and its mean energy are those of the microcanonical ensemble, in which the
/// energy is shared by all 2N + 1 degrees of freedom.
#[test]
fn a_piston_between_two_gases_fluctuates_as_in_the_microcanonical_ensemble() -> Outcome {
    let ([length, height, radius], mass) = (BOX, 2.0);
    let wall = Part::polyline([(10.0, 0.0), (10.0, height)].map(DVec2::from))?;
    let wall = wall.with_piston(DVec2::X, Piston::new(mass, [-9.7, 9.7])?)?;
    let container = Container::closed(length, height)?.with_part("piston", wall)?;
    let row = |from: f64, count: u32| {
        (0..count).map(move |number| {
            let (x, y) = (from + f64::from(number / 4) * 2.0, 0.7 + 1.2 * f64::from(number % 4));
            Disk::new(DVec2::new(x, y), radius)
        })
    };
    let disks = row(2.0, 6).chain(row(12.0, 12)).collect::<Result<Vec<_>, _>>()?;
    let disks: Result<Vec<_>, _> = disks.into_iter().map(|disk| disk.with_mass(1.0)).collect();
    let disks = initial::with_maxwellian_velocities(disks?, 1.0, 5)?;
    let energy: f64 = disks.iter().map(Disk::translational_energy).sum();
    let mut run = Simulation::builder(Elastic, container).disks(disks).build()?;
    run.run_until(1000.0, &mut ())?;
    let mut series = Series::new(FreeWall::named("piston"), SampleTimes::every(1.0)?);
    run.run_until(30_000.0, &mut series)?;
    let [mean, variance] = position([6.0, 12.0]);
    let place = series.mean(|wall| 10.0 + wall.displacement.x)?;
    let square = series.mean(|wall| (10.0 + wall.displacement.x - mean).powi(2))?;
    let heat = series.mean(|wall| mass * wall.velocity.x.powi(2))?;
    let expected = 2.0 * energy / (2.0 * 18.0 + 1.0);
    for (name, found, expected) in
        [("X", place, mean), ("variance of X", square, variance), ("MV^2", heat, expected)]
    {
        let error = found.standard_error() / expected;
        println!("  {found}");
        assert!(found.is_converged() && error < 0.05, "{found}");
        // The second virial coefficient leaves 1e-3.
        assert!(agrees(name, found.mean(), expected, 0.002 + 4.0 * error));
    }
    Ok(())
}
