//! The run: it builds the box, lets it settle for half of the time, and measures in the other half.

use std::error::Error;
use std::time::Instant;

use granular_edmd::observable::Fields;
use granular_edmd::prelude::*;
use granular_edmd::simulation::Counters;
use indicatif::{ProgressBar, ProgressStyle};

use crate::arguments::{Arguments, Base};
use crate::common::command_line::Failure;
use crate::common::flow;

const RADIUS: f64 = 0.5;

/// Height of the grid of the flow, where there is no lid: in widths of the box.
const OPEN_HEIGHT: f64 = 5.0;

/// What is sampled over the whole run.
pub(crate) type Samples = Series<(OrderParameters, CenterOfMass, Energies)>;

/// The results of one run.
pub(crate) struct Outcome {
    pub(crate) series: Samples,
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
    let period = arguments.period();
    let (end, settled) = (arguments.oscillations() as f64 * period, arguments.oscillations() / 2);
    let times = |every: u64| SampleTimes::every(every as f64 * period).map_err(Failure::usage);
    let observables = (OrderParameters, CenterOfMass, Energies);
    let mut series = Series::new(observables, times(arguments.every)?);
    let mut fields = grid(arguments, times(1)?).map_err(Failure::usage)?;
    let mut energy = EnergyChange::default();
    let bar = progress_bar(arguments.oscillations());
    let mut progress = on_sample(times(1)?, |_: &Snapshot<'_>| bar.inc(1));

    let start = Instant::now();
    let first = simulation.run_until(settled as f64 * period, &mut (&mut series, &mut progress));
    let second =
        |_| simulation.run_until(end, &mut ((&mut series, &mut progress), (&mut energy, &mut fields)));
    first.and_then(second).map_err(|error| stopped(&error))?;
    let run_seconds = start.elapsed().as_secs_f64();
    bar.finish_and_clear();
    let disks = simulation.disks();
    Ok(Outcome {
        series,
        energy_change: energy.disks().estimate(),
        fields,
        counters: *simulation.counters(),
        run_seconds,
        final_state_hash: hash(simulation.time(), &disks),
        disks,
    })
}

fn build(
    arguments: &Arguments,
) -> Result<Simulation<ContactDuration<Frictional>, Container>, Box<dyn Error>> {
    let rule = Frictional::from_inelasticity(
        arguments.inelasticity,
        arguments.tangential_inelasticity.unwrap_or(arguments.inelasticity),
    )?;
    let dynamic = arguments.dynamic_friction.unwrap_or(arguments.friction);
    let rule = rule.with_friction(arguments.friction, dynamic)?;
    let rule = ContactDuration::new(rule, arguments.contact_duration())?;
    let container = container(arguments)?;
    let disks = initial::lattice(&container, arguments.disks as usize, RADIUS)?;
    let disks: Result<Vec<Disk>, _> =
        disks.into_iter().map(|disk| disk.with_inertia_factor(arguments.inertia)).collect();
    let temperature = 0.5 * arguments.base_speed() * arguments.base_speed();
    let disks = initial::with_maxwellian_velocities(disks?, temperature, arguments.seed)?;
    let builder = Simulation::builder(rule, container).disks(disks);
    Ok(builder.gravity(arguments.gravity).seed(arguments.seed).build()?)
}

fn container(arguments: &Arguments) -> Result<Container, Box<dyn Error>> {
    let Arguments { width, height, amplitude, omega, .. } = *arguments;
    let mut container =
        if arguments.open { Container::open(width)? } else { Container::closed(width, height)? };
    if arguments.periodic {
        container = container.with_periodic_sides();
    }
    if arguments.wall_friction.or(arguments.wall_inelasticity).is_some() {
        let inelasticity = arguments.wall_inelasticity.unwrap_or(arguments.inelasticity);
        let rule = Frictional::new(inelasticity, arguments.wall_friction.unwrap_or(arguments.friction))?;
        let rule = ContactDuration::new(rule, arguments.contact_duration())?;
        for wall in [Wall::Floor, Wall::Lid, Wall::Left, Wall::Right] {
            // A box may lack a lid, or sides.
            if container.index(wall).is_some() {
                container = container.with_rule(wall, rule)?;
            }
        }
    }
    Ok(match arguments.base {
        Base::BiParabolic => container.with_motion(Wall::Floor, BiParabolic::new(amplitude, omega)?)?,
        Base::Sinusoidal => container.with_motion(Wall::Floor, Sinusoidal::new(amplitude, omega)?)?,
        Base::Triangular => container.with_motion(Wall::Floor, Triangular::new(amplitude, omega)?)?,
        Base::Thermal => container.with_temperature(Wall::Floor, Thermal::new(arguments.temperature)?)?,
    })
}

/// Returns a grid of about seven diameters a cell: fewer columns if the box is narrow, larger cells if it is
/// wide.
fn grid(arguments: &Arguments, times: SampleTimes) -> Result<Fields, ParameterError> {
    let columns = (arguments.width / 7.0).round().clamp(4.0, 24.0);
    let height = if arguments.open { OPEN_HEIGHT * arguments.width } else { arguments.height };
    flow::on_squares(DVec2::ZERO, DVec2::new(arguments.width, height), columns as usize, times)
}

fn stopped(error: &RunError) -> Failure {
    match error {
        RunError::Stalled { .. } => Failure::run(format_args!("{error}; see --contact-duration")),
        _ => Failure::run(error),
    }
}

/// Shows how far the run is, if standard error is a terminal.
fn progress_bar(oscillations: u64) -> ProgressBar {
    let bar = ProgressBar::new(oscillations);
    let template = "{bar:40.cyan/blue} {human_pos}/{human_len} oscillations, {eta} left";
    ProgressStyle::with_template(template).map_or(bar.clone(), |style| bar.with_style(style))
}

/// Returns a name for the state, which depends on its last bit.
fn hash(time: f64, disks: &[Disk]) -> String {
    let mut hasher = blake3::Hasher::new();
    for disk in disks {
        let (position, velocity) = (disk.position(), disk.velocity());
        let numbers = [position.x, position.y, velocity.x, velocity.y, disk.angle(), disk.angular_velocity()];
        for number in numbers {
            hasher.update(&number.to_le_bytes());
        }
    }
    hasher.update(&time.to_le_bytes());
    hasher.finalize().to_hex()[..32].to_owned()
}
