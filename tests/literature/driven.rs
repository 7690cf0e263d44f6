//! Gases that are driven in the bulk, against kinetic theory and direct simulation.

use std::f64::consts::PI;

use granular_edmd::boundary::Container;
use granular_edmd::collision::{CollisionRule, Frictional, Rough, Smooth};
use granular_edmd::glam::DVec2;
use granular_edmd::kinetic::DirectSimulation;
use granular_edmd::observable::{EnergyChange, SampleTimes, Snapshot, on_sample};
use granular_edmd::simulation::{BoxedRule, Driving, Limits, WhiteNoise};
use granular_edmd::{Disk, Simulation, initial};
use oracles::run_directly;

use crate::gas::{collision_rate, periodic_gas};
use crate::{Outcome, agrees, measured};

type Means = Result<[f64; 3], Box<dyn std::error::Error>>;

/// Sums of squares and fourth powers of speeds, and of squares of spins, over disks and samples.
#[derive(Default)]
struct Moments {
    disks: f64,
    squares: f64,
    fourths: f64,
    spins: f64,
}

impl Moments {
    fn add(&mut self, disks: &[Disk]) {
        for disk in disks {
            let square = disk.velocity().length_squared();
            self.disks += 1.0;
            self.squares += square;
            self.fourths += square * square;
            self.spins += disk.moment_of_inertia() * disk.angular_velocity().powi(2);
        }
    }

    /// Returns the temperature, the fourth cumulant, and the ratio of the temperatures.
    fn means(&self) -> [f64; 3] {
        let square = self.squares / self.disks;
        [
            0.5 * square,
            self.fourths / self.disks / (2.0 * square * square) - 1.0,
            self.spins / self.disks / (0.5 * square),
        ]
    }
}

/// Returns the means of `count` driven disks at this packing fraction, over this number of mean free times
/// at temperature 1, by events.
fn by_events<R: CollisionRule>(rule: R, noise: f64, count: usize, packing: f64, times: f64) -> Means {
    let rate = collision_rate(packing);
    let mut gas = periodic_gas(count, packing, rule, 1)?;
    let mut noise = WhiteNoise::new(noise * rate, SampleTimes::every(0.1 / rate)?, 2)?;
    gas.run_driven(&Limits::until(gas.time() + 30.0 / rate), &mut noise, &mut ())?;
    let mut moments = Moments::default();
    let (mut lost, energy, fed) = (EnergyChange::default(), energy_of(&gas.disks()), noise.energy());
    // Samples lie in the middle between two kicks, where the temperature has its mean.
    let middles = SampleTimes::every(0.5 / rate)?.starting_at(0.05 / rate)?;
    let mut sample = on_sample(middles, |snapshot: &Snapshot<'_>| moments.add(snapshot.disks()));
    let limits = Limits::until(gas.time() + times / rate);
    gas.run_driven(&limits, &mut noise, &mut (&mut lost, &mut sample))?;
    // What is fed and not lost is kept, to rounding.
    let fed = noise.energy() - fed;
    let kept = energy_of(&gas.disks()) - energy;
    let lost = lost.disks().sum();
    assert!((fed + lost - kept).abs() < 1e-9 * fed, "{fed} {lost} {kept}");
    Ok(moments.means())
}

/// Returns the means of a gas without correlations, in the same units.
fn by_direct_simulation(
    rule: impl CollisionRule + Send + Sync + 'static,
    noise: f64,
    count: usize,
    times: f64,
) -> Means {
    let disks = vec![Disk::new(DVec2::ZERO, 0.5)?; count];
    let disks = initial::without_drift(initial::with_maxwellian_velocities(disks, 1.0, 1)?)?;
    // The unit of time is a mean free time at temperature 1.
    let mut gas = DirectSimulation::new(Box::new(rule) as BoxedRule, disks, 0.5 / PI.sqrt(), 3)?;
    let mut noise = WhiteNoise::new(noise, SampleTimes::every(0.1)?, 4)?;
    let mut moments = Moments::default();
    for step in 1..=(10.0 * times) as u32 {
        run_directly(&mut gas, 0.1 * (f64::from(step) - 0.5))?;
        if step > 300 && step.is_multiple_of(5) {
            moments.add(gas.disks());
        }
        run_directly(&mut gas, 0.1 * f64::from(step))?;
        noise.kick(gas.disks_mut())?;
    }
    Ok(moments.means())
}

fn energy_of(disks: &[Disk]) -> f64 {
    disks.iter().map(|disk| disk.translational_energy() + disk.rotational_energy()).sum()
}

/// Returns the fourth cumulant of smooth disks under white noise (van Noije & Ernst 1998, in two dimensions),
/// and the temperature at which they lose a noise of 1 for each mean free time at temperature 1.
fn theory(restitution: f64) -> [f64; 2] {
    let r = restitution;
    let cumulant = 16.0 * (1.0 - r) * (1.0 - 2.0 * r * r)
        / (73.0 + 2.0 * 56.0 - 48.0 * r - 105.0 * r + 30.0 * (1.0 - r) * r * r);
    let loss = 0.5 * (1.0 - r * r) * (1.0 + 3.0 / 16.0 * cumulant);
    [loss.powf(-2.0 / 3.0), cumulant]
}

/// The steady temperature of smooth disks is that of theory, by both roads.
#[test]
fn driven_disks_have_the_temperature_of_their_noise() -> Outcome {
    for restitution in [0.9, 0.6] {
        let rule = Smooth::from_restitution(restitution)?;
        let [expected, _] = theory(restitution);
        // 200 disks over 300 mean free times: the energy, which relaxes in some ten of them, scatters by
        // 0.1, so its mean by 2 %. The theory is good to 1 %. Noise makes long waves, which add 1 %.
        let [events, ..] = by_events(rule, 1.0, 200, 0.02, 300.0)?;
        assert!(agrees(&format!("T by events, {restitution}"), events, expected, 0.06));
        let [direct, ..] = by_direct_simulation(rule, 1.0, 4000, 100.0)?;
        assert!(agrees(&format!("T by direct simulation, {restitution}"), direct, expected, 0.02));
    }
    Ok(())
}

/// The fourth cumulant of smooth disks under noise is that of van Noije and Ernst.
#[test]
#[ignore = "a minute"]
fn driven_disks_have_the_fourth_cumulant_of_van_noije_and_ernst() -> Outcome {
    for restitution in [0.9, 0.6, 0.3] {
        let rule = Smooth::from_restitution(restitution)?;
        let [_, expected] = theory(restitution);
        measured(&format!("expected a_2, {restitution}"), expected);
        let [_, direct, _] = by_direct_simulation(rule, 1.0, 20_000, 150.0)?;
        measured(&format!("a_2 by direct simulation, {restitution}"), direct);
        let [_, events, _] = by_events(rule, 1.0, 500, 0.01, 1000.0)?;
        measured(&format!("a_2 by events, {restitution}"), events);
        // A million independent squares of speeds know a_2 to 0.002. The theory, to first order in a_2, is
        // good to some hundredths of 1 + a_2 at the smallest restitution.
        assert!((direct - expected).abs() < 0.006 && (events - expected).abs() < 0.01);
    }
    Ok(())
}

/// Rough disks whose velocities alone are driven turn with T_rot/T = η/(1 − 2η), η = (1 + β)/6, since their
/// spins gain as much as they lose (Luding, Huthmann, McNamara & Zippelius 1998).
#[test]
fn rough_disks_share_what_they_are_driven_with() -> Outcome {
    for tangential in [0.0, 0.5] {
        let rule = Rough::from_restitution(0.9, tangential)?;
        let eta = (1.0 + tangential) / 6.0;
        let expected = eta / (1.0 - 2.0 * eta);
        // The scatter of 200 disks and 300 mean free times is 1 %. Theory is of Maxwellian spins.
        let [.., events] = by_events(rule, 1.0, 200, 0.02, 300.0)?;
        assert!(agrees(&format!("T_rot/T by events, {tangential}"), events, expected, 0.06));
        let [.., direct] = by_direct_simulation(rule, 1.0, 4000, 100.0)?;
        assert!(agrees(&format!("T_rot/T by direct simulation, {tangential}"), direct, expected, 0.05));
    }
    Ok(())
}

/// Frictional disks have no closed form here; both roads give the same ratio and cumulant, dilute.
#[test]
#[ignore = "a minute"]
fn frictional_disks_have_no_correlations_when_dilute() -> Outcome {
    for friction in [0.1, 0.3, 1.0] {
        let rule = Frictional::from_inelasticity(0.05, 0.05, friction)?;
        let [_, a_2, ratio] = by_direct_simulation(rule, 1.0, 20_000, 150.0)?;
        let [_, also, events] = by_events(rule, 1.0, 500, 0.01, 1000.0)?;
        measured(&format!("a_2 by direct simulation, friction {friction}"), a_2);
        measured(&format!("a_2 by events, friction {friction}"), also);
        assert!(agrees(&format!("T_rot/T by events, friction {friction}"), events, ratio, 0.03));
        assert!((also - a_2).abs() < 0.01);
    }
    Ok(())
}

/// Noise keeps the momentum.
#[test]
fn noise_keeps_the_momentum() -> Outcome {
    let container = Container::periodic(20.0, 20.0)?;
    let disks = initial::scattered(&container, 60, 0.5, 20.0, 1)?;
    let masses = (1..).map(f64::from);
    let disks = disks.into_iter().zip(masses).map(|(disk, mass)| disk.with_mass(mass));
    let disks = disks.collect::<Result<Vec<_>, _>>()?;
    let mut run = Simulation::builder(Smooth::from_restitution(0.7)?, container).disks(disks).build()?;
    let mut noise = WhiteNoise::new(1.0, SampleTimes::every(0.1)?, 1)?.with_rotational_noise(0.5)?;
    run.run_driven(&Limits::until(20.0), &mut noise, &mut ())?;
    let momentum: DVec2 = run.disks().iter().map(|disk| disk.mass() * disk.velocity()).sum();
    assert!(momentum.length() < 1e-9, "{momentum}");
    // Smooth disks keep all of their spin: ½ I ξ_r² t on average, with I = m/8. It scatters by a fifth.
    let spin: f64 = run.disks().iter().map(Disk::rotational_energy).sum();
    assert!(agrees("rotational energy", spin, 0.5 * 0.5 * 20.0 * 1830.0 / 8.0, 0.5));
    Ok(())
}
