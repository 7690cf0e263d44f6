//! The run: it builds the box, follows it oscillation by oscillation, and keeps what the report needs.

use std::time::Instant;

use granular_edmd::boundary::{Boundary, Container, Thermal, Wall};
use granular_edmd::collision::{CollisionRule, ContactDuration, Frictional};
use granular_edmd::initial::{self, PlacementError};
use granular_edmd::observable::{
    CenterOfMass, ConvectionOrder, Energies, EnergyChange, EnergyPerDisk, OrderParameters, RunningMean,
};
use granular_edmd::simulation::{Counters, RunError};
use granular_edmd::wall::{BiParabolic, Sinusoidal, Triangular};
use granular_edmd::{Disk, Simulation};
use indicatif::{ProgressBar, ProgressStyle};

use crate::arguments::{Arguments, Base, Sides};
use crate::common::command_line::Failure;
use crate::common::flow::Flow;

const RADIUS: f64 = 0.5;

/// What one run gave.
pub(crate) struct Outcome {
    pub(crate) samples: Vec<Sample>,
    /// Energy change of disk–disk collisions in the second half.
    pub(crate) energy_change: RunningMean,
    /// Mean flow in the second half.
    pub(crate) flow: Flow,
    pub(crate) disks: Vec<Disk>,
    pub(crate) counters: Counters,
    pub(crate) run_seconds: f64,
    pub(crate) final_state_hash: String,
}

/// The box at the end of an oscillation.
pub(crate) struct Sample {
    pub(crate) oscillation: u64,
    pub(crate) time: f64,
    pub(crate) order: ConvectionOrder,
    pub(crate) center_of_mass_height: f64,
    pub(crate) energies: EnergyPerDisk,
}

/// Runs what the flags ask for.
pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let rule = Frictional::new(arguments.inelasticity, arguments.friction).map_err(Failure::usage)?;
    match arguments.contact_duration() {
        0.0 => simulate(rule, arguments),
        duration => simulate(ContactDuration::new(rule, duration).map_err(Failure::usage)?, arguments),
    }
}

fn simulate<R: CollisionRule>(rule: R, arguments: &Arguments) -> Result<Outcome, Failure> {
    let mut simulation = build(rule, arguments)?;
    let mut samples = Vec::new();
    let mut energy_change = EnergyChange::default();
    let mut flow = Flow::new(simulation.boundary().domain(), columns(arguments.width));
    let progress = progress_bar(arguments.oscillations);
    let start = Instant::now();
    for oscillation in 1..=arguments.oscillations {
        let end = oscillation as f64 * arguments.period();
        if oscillation > arguments.settled() * arguments.every {
            simulation.run_until(end, &mut energy_change).map_err(stopped)?;
            flow.add(&simulation.snapshot());
        } else {
            simulation.run_until(end, &mut ()).map_err(stopped)?;
        }
        if oscillation.is_multiple_of(arguments.every) {
            samples.push(sample(&mut simulation, oscillation));
        }
        progress.inc(1);
    }
    let run_seconds = start.elapsed().as_secs_f64();
    progress.finish_and_clear();
    Ok(Outcome {
        samples,
        energy_change: *energy_change.disks(),
        flow,
        disks: simulation.disks(),
        counters: *simulation.counters(),
        run_seconds,
        final_state_hash: hash(simulation.time(), &simulation.disks()),
    })
}

fn build<R: CollisionRule>(rule: R, arguments: &Arguments) -> Result<Simulation<R, Container>, Failure> {
    let container = container(arguments)?;
    let disks = initial::lattice(&container, arguments.disks as usize, RADIUS);
    let disks = disks.map_err(|error| no_room(&error, arguments))?;
    let temperature = arguments.base_speed() * arguments.base_speed();
    let disks = initial::with_maxwellian_velocities(disks, temperature, arguments.seed);
    Simulation::builder(rule, container)
        .disks(disks.map_err(Failure::usage)?)
        .gravity(arguments.gravity)
        .seed(arguments.seed)
        .build()
        .map_err(Failure::usage)
}

fn container(arguments: &Arguments) -> Result<Container, Failure> {
    let container = match arguments.height.0 {
        Some(height) => Container::closed(arguments.width, height),
        None => Container::open(arguments.width),
    };
    let mut container = container.map_err(Failure::usage)?;
    if arguments.sides == Sides::Periodic {
        container = container.with_periodic_sides();
    }
    let (amplitude, omega) = (arguments.amplitude, arguments.omega);
    let driven = match arguments.base {
        Base::BiParabolic => {
            container.with_motion(Wall::Floor, BiParabolic::new(amplitude, omega).map_err(Failure::usage)?)
        }
        Base::Sinusoidal => {
            container.with_motion(Wall::Floor, Sinusoidal::new(amplitude, omega).map_err(Failure::usage)?)
        }
        Base::Triangular => {
            container.with_motion(Wall::Floor, Triangular::new(amplitude, omega).map_err(Failure::usage)?)
        }
        Base::Thermal(temperature) => {
            container.with_temperature(Wall::Floor, Thermal::new(temperature).map_err(Failure::usage)?)
        }
    };
    driven.map_err(Failure::usage)
}

fn no_room(error: &PlacementError, arguments: &Arguments) -> Failure {
    let Arguments { disks, width, height, .. } = arguments;
    match error {
        PlacementError::NoRoom { placed, .. } => Failure::usage(format_args!(
            "--disks {disks}: the start needs a square lattice, and a box of --width {width} --height {height} has \
             room for {placed}"
        )),
        _ => Failure::usage(error),
    }
}

fn stopped(error: RunError) -> Failure {
    match error {
        RunError::Stalled { .. } => Failure::run(format_args!("{error}; see --contact-duration")),
        _ => Failure::run(error),
    }
}

fn sample<R: CollisionRule>(simulation: &mut Simulation<R, Container>, oscillation: u64) -> Sample {
    let (order, center, energies) = simulation.measure(&(OrderParameters, CenterOfMass, Energies));
    Sample { oscillation, time: simulation.time(), order, center_of_mass_height: center.y, energies }
}

/// Columns of the flow's grid: cells of about five diameters, fewer if the box is narrow, larger if it is wide.
fn columns(width: f64) -> usize {
    (width / 5.0).clamp(4.0, 24.0) as usize
}

/// Shows how far the run is, if standard error is a terminal.
fn progress_bar(oscillations: u64) -> ProgressBar {
    let bar = ProgressBar::new(oscillations);
    let template = "{bar:40.cyan/blue} {human_pos}/{human_len} oscillations, {eta} left";
    ProgressStyle::with_template(template).map_or(bar.clone(), |style| bar.with_style(style))
}

/// A name for the state to its last bit.
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
