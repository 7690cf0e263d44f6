//! A gas of elastic disks under a lid with a mass: force, pressure, equipartition, and fluctuations.

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{SampleTimes, Series, Snapshot, WallStress, from_fn};
use granular_edmd::statistics::BlockedMean;
use granular_edmd::wall::Piston;
use granular_edmd::{Disk, Simulation, initial};

use crate::{Outcome, agrees};

const DISKS: usize = 150;
const WIDTH: f64 = 12.0;
const MASS: f64 = 20.0;
/// Height of the container, at which the lid begins to sink.
const TOP: f64 = 400.0;
/// With periodic sides, the floor is wall 0 and the lid wall 1.
const LID: usize = 1;

/// Returns Henderson's compressibility factor of hard disks, and its logarithmic derivative (Henderson 1975).
fn henderson(packing: f64) -> (f64, f64) {
    let (above, below) = (1.0 + packing * packing / 8.0, 1.0 - packing);
    (above / (below * below), packing * (packing / 4.0 / above + 2.0 / below))
}

/// Returns the density at which disks of temperature 1 have this pressure.
fn density_at(pressure: f64) -> f64 {
    let of = |density: f64| density * henderson(0.25 * std::f64::consts::PI * density).0;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if of(middle) < pressure { low = middle } else { high = middle }
    }
    low
}

/// At six loads, from a dilute gas to a dense fluid. With periodic sides, the force of the lid is that of the
/// pressure in the bulk, far from lid and floor, on the whole width.
#[test]
fn a_lid_with_a_mass_floats_on_a_gas() -> Outcome {
    for pressure in [0.07, 0.2, 0.5, 1.0, 1.8, 2.6] {
        let force = pressure * WIDTH;
        let lid = Piston::new(MASS, [0.0, TOP - 9.0])?.with_force(force)?;
        // Near its mean height, so that it need not lose a swing to the gas first.
        let start = DISKS as f64 / (WIDTH * density_at(pressure));
        let lid = lid.with_start(TOP - start, 0.0)?;
        let container = Container::closed(WIDTH, TOP)?.with_periodic_sides()?.with_piston(Wall::Lid, lid)?;
        let disks = vec![Disk::new(DVec2::ZERO, 0.5)?; DISKS];
        let disks = initial::packed_at_random(&container, disks, start, 1)?;
        let disks = initial::with_maxwellian_velocities(disks, 1.0, 2)?;
        let mut run = Simulation::builder(Elastic, container).disks(disks).build()?;
        run.run_until(1000.0, &mut ())?;
        let look = from_fn(|snapshot: &Snapshot<'_>| {
            let kinetic = snapshot.mean(Disk::translational_energy);
            let height = snapshot.wall_point(LID).map_or(f64::NAN, |point| point.y);
            let speed = snapshot.wall_velocity(LID).map_or(f64::NAN, |velocity| velocity.y);
            // The middle third, far from the layers at lid and floor.
            let middle = |y: f64| y > height / 3.0 && y < 2.0 * height / 3.0;
            let inside = snapshot.disks().iter().filter(|disk| middle(disk.position().y)).count();
            [kinetic, height, speed, inside as f64 / (WIDTH * height / 3.0)]
        });
        let mut series = Series::new(look, SampleTimes::every(0.5)?);
        let mut push = WallStress::new(SampleTimes::every(100.0)?).with_wall(LID, WIDTH)?;
        let duration = 6000.0;
        run.run_until(1000.0 + duration, &mut (&mut series, &mut push))?;
        let values = series.values();
        let mean = |quantity: &dyn Fn(&[f64; 4]) -> f64| {
            values.iter().map(quantity).collect::<BlockedMean>().estimate()
        };
        let (temperature, height) = (mean(&|value| value[0]), mean(&|value| value[1]));
        let density = mean(&|value| value[3]).mean();
        // The impulse of the disks is that of the load, up to the momentum of the lid.
        let mean_force = push.pressure(LID).ok_or("the lid is watched")?.mean() * WIDTH;
        assert!((mean_force / force - 1.0).abs() < 4.0 * (MASS.sqrt() + 1.0) / (force * duration));
        // Equipartition: the lid has half a temperature.
        let lid = mean(&|value| MASS * value[2] * value[2]);
        let error = 4.0 * lid.standard_error().hypot(temperature.standard_error());
        assert!((lid.mean() - temperature.mean()).abs() < error, "{lid} {temperature}");
        // A density of 1 % error, times the slope of the pressure, up to 5 in the dense fluid.
        let (factor, slope) = henderson(0.25 * std::f64::consts::PI * density);
        let expected = density * temperature.mean() * factor;
        assert!(agrees(&format!("pressure under a lid, {pressure}"), pressure, expected, 0.03));
        // Fluctuations at constant enthalpy: ⟨δh²⟩ = T h/(F (1 + Z + dln Z/dln φ)), by the adiabatic
        // compressibility of all disks; the layers at lid and floor are a tenth of them.
        let square = mean(&|value| (value[1] - height.mean()).powi(2));
        let stiffness = force * (1.0 + factor + slope);
        let ratio = square.mean() * stiffness / (temperature.mean() * height.mean());
        let tolerance = 0.1 + 4.0 * square.standard_error() / square.mean();
        assert!(agrees(&format!("fluctuation of a lid, {pressure}"), ratio, 1.0, tolerance));
    }
    Ok(())
}
