//! The run: it builds the box, lets it settle for half of the time, and measures in the other half.

use std::error::Error;
use std::time::Instant;

use granular_edmd::observable::Fields;
use granular_edmd::prelude::*;
use granular_edmd::simulation::Counters;

use crate::arguments::{Arguments, Base};
use crate::common::command_line::Failure;
use crate::common::{flow, progress::Progress};

/// The results of one run.
pub(crate) struct Outcome {
    /// Samples of the whole run.
    pub(crate) series: Series<(OrderParameters, CenterOfMass, Energies)>,
    /// Energy change of collisions of two disks in the second half, with the error of correlated collisions.
    pub(crate) energy_change: Estimate,
    /// Mean flow in the second half.
    pub(crate) fields: Fields,
    pub(crate) disks: Vec<Disk>,
    pub(crate) counters: Counters,
    pub(crate) run_seconds: f64,
    pub(crate) final_state_hash: String,
}

/// Runs what the flags ask for.
pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let mut simulation = build(arguments).map_err(Failure::usage)?;
    let at = |oscillation: u64| oscillation as f64 * arguments.period();
    let (settled, end) = (at(arguments.oscillations() / 2), at(arguments.oscillations()));
    let mut series =
        Series::new((OrderParameters, CenterOfMass, Energies), SampleTimes::every(at(arguments.every))?);
    let (mut energy_change, mut fields) = (EnergyChange::default(), grid(arguments)?);
    let mut progress = Progress::of("run").until(end);

    let start = Instant::now();
    simulation.run_until(settled, &mut (&mut series, &mut progress))?;
    simulation.run_until(end, &mut ((&mut series, &mut progress), (&mut energy_change, &mut fields)))?;
    Ok(Outcome {
        run_seconds: start.elapsed().as_secs_f64(),
        series,
        energy_change: energy_change.disks().estimate(),
        fields,
        counters: *simulation.counters(),
        final_state_hash: hash(simulation.time(), &simulation.disks()),
        disks: simulation.disks(),
    })
}

fn build(arguments: &Arguments) -> Result<Simulation<BoxedRule, Container>, Box<dyn Error>> {
    let container = container(arguments)?;
    let disks = initial::lattice(&container, arguments.disks as usize, 0.5)?.into_iter();
    let disks =
        disks.map(|disk| disk.with_inertia_factor(arguments.inertia)).collect::<Result<Vec<_>, _>>()?;
    let temperature = 0.5 * arguments.base_speed() * arguments.base_speed();
    let disks = initial::with_maxwellian_velocities(disks, temperature, arguments.seed)?;
    let builder = Simulation::builder(rule(arguments)?, container).disks(disks);
    Ok(builder.gravity(arguments.gravity).seed(arguments.seed).build()?)
}

fn container(arguments: &Arguments) -> Result<Container, Box<dyn Error>> {
    let Arguments { width, height, omega, .. } = *arguments;
    let amplitude = arguments.amplitude();
    let container = if arguments.open { Container::open(width)? } else { Container::closed(width, height)? };
    let container = if arguments.periodic { container.with_periodic_sides() } else { container };
    Ok(match arguments.base {
        Base::BiParabolic => container.with_motion(Wall::Floor, BiParabolic::new(amplitude, omega)?)?,
        Base::Sinusoidal => container.with_motion(Wall::Floor, Sinusoidal::new(amplitude, omega)?)?,
        Base::Triangular => container.with_motion(Wall::Floor, Triangular::new(amplitude, omega)?)?,
        Base::Thermal => container.with_temperature(Wall::Floor, Thermal::new(arguments.temperature())?)?,
    })
}

/// Returns one rule for collisions of disks, and one for those with walls.
fn rule(arguments: &Arguments) -> Result<BoxedRule, ParameterError> {
    let Arguments { inelasticity, friction, wall_inelasticity, wall_friction, .. } = *arguments;
    let tangential = arguments.tangential_inelasticity.unwrap_or(inelasticity);
    let disks = Frictional::from_inelasticity(inelasticity, tangential)?
        .with_friction(friction, arguments.dynamic_friction.unwrap_or(friction))?;
    let mut rules = RulesByKind::new(disks);
    if wall_friction.or(wall_inelasticity).is_some() {
        let inelasticity = wall_inelasticity.unwrap_or(inelasticity);
        let walls = Frictional::new(inelasticity, wall_friction.unwrap_or(friction))?;
        rules = rules.with(Kind::DEFAULT, Kind::WALL, walls);
    }
    let duration = arguments.contact_duration();
    Ok(if duration > 0.0 { Box::new(ContactDuration::new(rules, duration)?) } else { Box::new(rules) })
}

/// Returns a grid of about seven diameters a cell: fewer columns if the box is narrow, larger cells if it is
/// wide. An open box is shown to five times its width.
fn grid(arguments: &Arguments) -> Result<Fields, ParameterError> {
    let columns = (arguments.width / 7.0).round().clamp(4.0, 24.0);
    let height = if arguments.open { 5.0 * arguments.width } else { arguments.height };
    let times = SampleTimes::every(arguments.period())?;
    flow::on_squares(DVec2::ZERO, DVec2::new(arguments.width, height), columns as usize, times)
}

/// Returns a name for the state, which depends on its last bit.
fn hash(time: f64, disks: &[Disk]) -> String {
    let numbers = |disk: &Disk| {
        let (position, velocity) = (disk.position(), disk.velocity());
        [position.x, position.y, velocity.x, velocity.y, disk.angle(), disk.angular_velocity()]
    };
    let bytes: Vec<u8> = disks.iter().flat_map(numbers).chain([time]).flat_map(f64::to_le_bytes).collect();
    blake3::hash(&bytes).to_hex()[..32].to_owned()
}
