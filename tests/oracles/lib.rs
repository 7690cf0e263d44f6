//! Brute force: all pairs of disks, with each image of a periodic domain, areas by many chords or points,
//! steps along polynomials, long random series, and gases without correlations.

use granular_edmd::boundary::{Domain, Region};
use granular_edmd::collision::{Encounter, collide};
use granular_edmd::glam::DVec2;
use granular_edmd::kinetic::{DirectSimulation, Maxwellian, MonteCarlo};
use granular_edmd::roots::first_descent_of_quartic;
use granular_edmd::simulation::BoxedRule;
use granular_edmd::statistics::Estimate;
use granular_edmd::{Disk, ParameterError};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Depth of an overlap that is rounding, relative to the distance at which the disks touch, in a domain that
/// is at most some hundred times as wide.
const ROUNDING: f64 = 1e-9;

/// Returns the depth of an overlap that is rounding, for the distance at which two of the disks touch.
///
/// A few small disks in a wide domain have wide cells, so their collisions are predicted from afar. Squares
/// of distances r then have errors of some 1e-16 r², and the touch at the distance d one of 1e-16 r²/d.
pub fn rounding(disks: &[Disk]) -> impl Fn(f64) -> f64 + use<> {
    let farthest = disks.iter().map(|disk| disk.position().length_squared()).fold(0.0, f64::max);
    move |touching| ROUNDING * touching + f64::EPSILON * farthest / touching
}

/// Returns the deepest overlap of any two disks, relative to the distance at which they touch.
pub fn deepest_overlap(domain: &Domain, disks: &[Disk]) -> f64 {
    let depth = |[a, b]: [&Disk; 2]| {
        let distance = domain.separation(a.position(), b.position()).length();
        1.0 - distance / (a.radius() + b.radius())
    };
    pairs(disks).map(depth).fold(f64::NEG_INFINITY, f64::max)
}

/// Returns the first pair of disks that overlaps within this time by more than rounding, and how deep. All
/// disks fall alike.
pub fn meeting(domain: &Domain, disks: &[Disk], passed: f64) -> Option<([Disk; 2], f64)> {
    let allowed = rounding(disks);
    pairs(disks).find_map(|[a, b]| {
        let touching = a.radius() + b.radius();
        let depth = touching - nearest_within(domain, a, b, passed);
        (depth >= allowed(touching)).then_some(([*a, *b], depth))
    })
}

fn pairs(disks: &[Disk]) -> impl Iterator<Item = [&Disk; 2]> {
    disks.iter().enumerate().flat_map(|(k, a)| disks[..k].iter().map(move |b| [a, b]))
}

/// Returns the least distance of two disks in this time, at any image.
fn nearest_within(domain: &Domain, a: &Disk, b: &Disk, passed: f64) -> f64 {
    let (place, velocity) = (b.position() - a.position(), b.velocity() - a.velocity());
    let along = |period: f64| if period > 0.0 { -1..=1 } else { 0..=0 };
    let (columns, rows) = (along(domain.periods().x), along(domain.periods().y));
    let images = columns.flat_map(|x| rows.clone().map(move |y| DVec2::new(x.into(), y.into())));
    let distance = |image: DVec2| {
        let place = place + image * domain.periods();
        let nearest =
            (-place.dot(velocity) / velocity.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, passed);
        (place + velocity * nearest).length()
    };
    images.map(distance).fold(f64::INFINITY, f64::min)
}

/// Returns the area of a disk between two heights, by many chords.
pub fn area_between(disk: &Disk, domain: &Domain, low: f64, high: f64) -> f64 {
    const CHORDS: u32 = 4000;
    let period = domain.periods().y;
    let mut area = 0.0;
    for chord in 0..CHORDS {
        let height = disk.radius() * (2.0 * (f64::from(chord) + 0.5) / f64::from(CHORDS) - 1.0);
        let mut place = disk.position().y + height;
        if period > 0.0 {
            place = domain.bottom + (place - domain.bottom).rem_euclid(period);
        }
        if place >= low && place < high {
            let width = 2.0 * (disk.radius().powi(2) - height * height).sqrt();
            area += width * 2.0 * disk.radius() / f64::from(CHORDS);
        }
    }
    area
}

/// Returns the area of a rectangle that is free, by many points. Each row is shifted, since rows that are
/// alike would count too many or too few points along a slanted wall.
pub fn free_area(region: &Region, is_free: &dyn Fn(DVec2) -> bool) -> f64 {
    const LINES: u32 = 450;
    let at = |k: u32, shift: f64| (f64::from(k) + shift) / f64::from(LINES);
    let size = region.max - region.min;
    let point = |row: u32, column: u32| {
        let share = DVec2::new(at(column, (0.618_034 * f64::from(row)).fract()), at(row, 0.5));
        is_free(region.min + size * share)
    };
    let free = (0..LINES).map(|row| (0..LINES).filter(|&column| point(row, column)).count()).sum::<usize>();
    size.x * size.y * free as f64 / f64::from(LINES * LINES)
}

/// An autoregressive series of variance 1 and this correlation of neighbors.
pub struct Autoregressive {
    generator: Xoshiro256PlusPlus,
    correlation: f64,
    state: f64,
}

impl Autoregressive {
    /// Creates the series of a seed.
    pub fn new(seed: u64, correlation: f64) -> Self {
        let mut series = Self { generator: Xoshiro256PlusPlus::seed_from_u64(seed), correlation, state: 0.0 };
        series.state = normal(&mut series.generator);
        series
    }
}

/// Returns the sum of 12 uniform numbers less 6: its variance is 1, and its fourth moment 3 % low.
fn normal(generator: &mut Xoshiro256PlusPlus) -> f64 {
    let mut uniform = || (generator.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    (0..12).map(|_| uniform()).sum::<f64>() - 6.0
}

impl Iterator for Autoregressive {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        let kick = normal(&mut self.generator) * (1.0 - self.correlation * self.correlation).sqrt();
        self.state = self.correlation * self.state + kick;
        Some(self.state)
    }
}

/// Returns the mean energy change of 200 000 collisions of two disks in contact, from the energies of the
/// disks themselves, weighted with the rate of the collision. Their velocities are thermal, at temperature 1.
///
/// # Errors
/// If the temperature of the spins is negative.
pub fn mean_over_colliding_disks(
    rule: &BoxedRule,
    pair: [Disk; 2],
    rotational_temperature: f64,
    seed: u64,
) -> Result<f64, ParameterError> {
    let generator = &mut Xoshiro256PlusPlus::seed_from_u64(seed);
    let energy = |disk: &Disk| disk.translational_energy() + disk.rotational_energy();
    let (mut rate, mut change) = (0.0, 0.0);
    for _ in 0..200_000 {
        let [first, second] = pair.map(|disk| thermal(disk, rotational_temperature, generator));
        let (first, second) = (first?, second?);
        let Encounter { first: one, second: other, contact, .. } = collide(rule, &first, &second);
        let weight = contact.closing_speed().max(0.0);
        rate += weight;
        change += weight * (energy(&one) + energy(&other) - energy(&first) - energy(&second));
    }
    Ok(change / rate)
}

fn thermal(
    disk: Disk,
    rotational_temperature: f64,
    generator: &mut Xoshiro256PlusPlus,
) -> Result<Disk, ParameterError> {
    let velocity = DVec2::new(normal(generator), normal(generator)) / disk.mass().sqrt();
    let spin = normal(generator) * (rotational_temperature / disk.moment_of_inertia()).sqrt();
    disk.with_velocity(velocity)?.with_angular_velocity(spin)
}

/// Estimates the mean energy change: the library's generic code, compiled here.
pub fn mean_energy_change(monte_carlo: &MonteCarlo, rule: &BoxedRule, gas: &Maxwellian) -> Estimate {
    monte_carlo.mean_energy_change(rule, gas)
}

/// Runs a gas without correlations until this time: the library's generic code, compiled here.
///
/// # Errors
/// As [`DirectSimulation::run_until`].
pub fn run_directly(gas: &mut DirectSimulation<BoxedRule>, time: f64) -> Result<(), ParameterError> {
    gas.run_until(time)
}

/// Returns the value of a polynomial, given by its coefficients from the constant term up.
fn value(coefficients: &[f64; 5], time: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * time + c)
}

fn derivative(&[_, c1, c2, c3, c4]: &[f64; 5]) -> [f64; 5] {
    [c1, 2.0 * c2, 3.0 * c3, 4.0 * c4, 0.0]
}

/// Returns the sum of the magnitudes of all terms at this time. The rounding of the value is a fraction of
/// it.
fn size(coefficients: &[f64; 5], time: f64) -> f64 {
    value(&coefficients.map(f64::abs), time)
}

/// Steps along the gap and asserts that the answer misses no fall through zero, and that the gap is closed
/// there.
///
/// # Panics
/// If it misses one, or the gap is open there.
pub fn check_quartic(coefficients: &[f64; 5], end: f64) -> Option<f64> {
    let found = first_descent_of_quartic(coefficients, end);
    let rounding = |time: f64| 1e-12 * size(coefficients, time);
    let level = coefficients[0].min(0.0);
    let (mut has_opened, last) = (false, found.unwrap_or(end));
    for k in 1..4000 {
        let time = last * f64::from(k) / 4000.0;
        let gap = value(coefficients, time);
        has_opened |= gap > rounding(time);
        let least = if has_opened { 0.0 } else { level };
        assert!(
            gap > least - 2.0 * rounding(time),
            "{coefficients:?}: missed before {time}, found {found:?}"
        );
    }
    if let Some(time) = found {
        let least = if has_opened { 0.0 } else { level };
        assert!((0.0..=end).contains(&time), "{coefficients:?}: {time}");
        assert!(
            (value(coefficients, time) - least).abs() <= rounding(time),
            "{coefficients:?}: open at {time}"
        );
        // At a double zero the slope is lost to the rounding of the place.
        let rate = value(&derivative(coefficients), time);
        let steep = size(&derivative(coefficients), time);
        assert!(rate <= 1e-6 * steep, "{coefficients:?}: it rises at {time}, by {rate}");
    }
    found
}
