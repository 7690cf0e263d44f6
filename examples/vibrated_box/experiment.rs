//! The run: it builds the box, follows it oscillation by oscillation, and keeps what the report needs.

use std::error::Error;
use std::time::Instant;

use granular_edmd::boundary::{Boundary, Container, Domain, Thermal, Wall};
use granular_edmd::collision::{CollisionRule, ContactDuration, Frictional};
use granular_edmd::initial::{self, PlacementError};
use granular_edmd::observable::{
    CenterOfMass, ConvectionOrder, Energies, EnergyChange, EnergyPerDisk, OrderParameters,
};
use granular_edmd::simulation::{Counters, RunError};
use granular_edmd::statistics::Estimate;
use granular_edmd::wall::{BiParabolic, Sinusoidal, Triangular};
use granular_edmd::{Disk, Simulation};
use indicatif::{ProgressBar, ProgressStyle};

use crate::arguments::{Arguments, Base, Sides};
use crate::common::command_line::{Failure, plain};
use crate::common::flow::Flow;

const RADIUS: f64 = 0.5;

/// The results of one run.
pub(crate) struct Outcome {
    pub(crate) samples: Vec<Sample>,
    /// Energy change of disk–disk collisions in the second half, with the error of correlated collisions.
    pub(crate) energy_change: Estimate,
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
    let mut record = Record::new(&simulation.boundary().domain(), arguments);
    let progress = progress_bar(arguments.oscillations);
    for oscillation in 1..=arguments.oscillations {
        record.follow(&mut simulation, oscillation, arguments).map_err(|error| stopped(&error))?;
        progress.inc(1);
    }
    progress.finish_and_clear();
    let disks = simulation.disks();
    Ok(Outcome {
        samples: record.samples,
        energy_change: record.energy_change.disks().estimate(),
        flow: record.flow,
        counters: *simulation.counters(),
        run_seconds: record.run_seconds,
        final_state_hash: hash(simulation.time(), &disks),
        disks,
    })
}

/// The record that is kept while the run goes on.
struct Record {
    samples: Vec<Sample>,
    energy_change: EnergyChange,
    flow: Flow,
    run_seconds: f64,
}

impl Record {
    fn new(domain: &Domain, arguments: &Arguments) -> Self {
        let flow = Flow::new(*domain, columns(arguments.width));
        Self { samples: Vec::new(), energy_change: EnergyChange::default(), flow, run_seconds: 0.0 }
    }

    /// Runs to the end of this oscillation and records it.
    fn follow<R: CollisionRule>(
        &mut self,
        simulation: &mut Simulation<R, Container>,
        oscillation: u64,
        arguments: &Arguments,
    ) -> Result<(), RunError> {
        let settled = oscillation > arguments.settled() * arguments.every;
        let end = oscillation as f64 * arguments.period();
        let start = Instant::now();
        simulation.run_until(end, &mut settled.then_some(&mut self.energy_change))?;
        self.run_seconds += start.elapsed().as_secs_f64();
        if settled {
            self.flow.add(&simulation.snapshot());
        }
        if oscillation.is_multiple_of(arguments.every) {
            self.samples.push(sample(simulation, oscillation));
        }
        Ok(())
    }
}

fn build<R: CollisionRule>(rule: R, arguments: &Arguments) -> Result<Simulation<R, Container>, Failure> {
    let container = container(arguments).map_err(|error| unusable_base(error.as_ref(), arguments))?;
    let disks = initial::lattice(&container, arguments.disks as usize, RADIUS);
    let disks = disks.map_err(|error| no_room(&error, arguments))?;
    let temperature = 0.5 * arguments.base_speed() * arguments.base_speed();
    let disks = initial::with_maxwellian_velocities(disks, temperature, arguments.seed);
    Simulation::builder(rule, container)
        .disks(disks.map_err(Failure::usage)?)
        .gravity(arguments.gravity)
        .seed(arguments.seed)
        .build()
        .map_err(Failure::usage)
}

fn container(arguments: &Arguments) -> Result<Container, Box<dyn Error>> {
    let Arguments { width, amplitude, omega, .. } = *arguments;
    let mut container = match arguments.height.0 {
        Some(height) => Container::closed(width, height)?,
        None => Container::open(width)?,
    };
    if arguments.sides == Sides::Periodic {
        container = container.with_periodic_sides();
    }
    let container = match arguments.base {
        Base::BiParabolic => container.with_motion(Wall::Floor, BiParabolic::new(amplitude, omega)?),
        Base::Sinusoidal => container.with_motion(Wall::Floor, Sinusoidal::new(amplitude, omega)?),
        Base::Triangular => container.with_motion(Wall::Floor, Triangular::new(amplitude, omega)?),
        Base::Thermal(temperature) => container.with_temperature(Wall::Floor, Thermal::new(temperature)?),
    };
    Ok(container?)
}

fn no_room(error: &PlacementError, arguments: &Arguments) -> Failure {
    let Arguments { disks, height, .. } = arguments;
    let width = plain(arguments.width);
    match error {
        PlacementError::NoRoom { placed, .. } => Failure::usage(format_args!(
            "--disks {disks}: the start needs a square lattice, and a box of --width {width} --height {height} has \
             room for {placed}"
        )),
        _ => Failure::usage(error),
    }
}

fn unusable_base(error: &dyn Error, arguments: &Arguments) -> Failure {
    let (amplitude, omega) = (plain(arguments.amplitude), plain(arguments.omega));
    Failure::usage(format_args!("--base {} --amplitude {amplitude} --omega {omega}: {error}", arguments.base))
}

fn stopped(error: &RunError) -> Failure {
    match error {
        RunError::Stalled { .. } => Failure::run(format_args!("{error}; see --contact-duration")),
        _ => Failure::run(error),
    }
}

fn sample<R: CollisionRule>(simulation: &mut Simulation<R, Container>, oscillation: u64) -> Sample {
    let (order, center, energies) = simulation.measure(&(OrderParameters, CenterOfMass, Energies));
    Sample { oscillation, time: simulation.time(), order, center_of_mass_height: center.y, energies }
}

/// Returns the number of columns of the flow's grid. Cells have about seven diameters: there are fewer if the
/// box is narrow, and they are larger if it is wide.
fn columns(width: f64) -> usize {
    (width / 7.0).round().clamp(4.0, 24.0) as usize
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
