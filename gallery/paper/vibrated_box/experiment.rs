//! The run: it builds the box, lets it settle for half of the time, and measures in the other half.

use std::error::Error;
use std::time::Instant;

use granular_edmd::boundary::Thermal;
use granular_edmd::collision::RulesByKind;
use granular_edmd::observable::{ConvectionOrder, DenseLayer, EnergyChange, HeightProfile};
use granular_edmd::prelude::*;
use granular_edmd::simulation::BoxedRule;
use granular_edmd::statistics::BlockedMean;
use granular_edmd::wall::Triangular;
use granular_edmd_study::analysis::{StateCriteria, thermal_noise};

use crate::arguments::{Arguments, Base};
use gallery::command_line::Failure;
use gallery::{flow, progress::Progress};

/// The quantities of a sample, and their values.
type Quantities = (OrderParameters, CenterOfMass, Energies);
pub(crate) type Sample = <Quantities as Observable>::Value;

/// Largest number of oscillations between two samples of the fields. In the paper's box, a disk has one or
/// two collisions in this time, so additional samples would see most velocities again.
const FRESH: u64 = 5;

/// Number of samples of the height profile, which only shows where the layer is densest.
const PROFILES: u64 = 50;

/// The results of one run.
pub(crate) struct Outcome {
    /// The box at the end.
    pub(crate) simulation: Simulation<BoxedRule, Container>,
    pub(crate) seconds: f64,
    /// Samples of the whole run.
    pub(crate) series: Series<Quantities>,
    /// Energy changes of collisions in the second half.
    pub(crate) energy_change: EnergyChange,
    /// Mean fields in the second half.
    pub(crate) fields: Sampled<Fields>,
    /// Standard deviation of the order parameters in a gas without flow, and the name of the flow.
    pub(crate) noise: f64,
    pub(crate) flow: String,
}

/// Does the run that the flags describe.
pub(crate) fn run(arguments: &Arguments) -> Result<Outcome, Failure> {
    let at = |oscillation: u64| oscillation as f64 * arguments.period();
    let (middle, end) = (at(arguments.oscillations() / 2), at(arguments.oscillations()));
    let mut simulation = build(arguments).map_err(Failure::usage)?;
    let times = SampleTimes::every(at(arguments.every))?;
    let mut series = Series::new(Quantities::default(), times);
    let profile = HeightProfile::new(0.0, arguments.shown(), arguments.shown().ceil() as usize)?;
    let apart = arguments.every.max(arguments.oscillations() / (2 * PROFILES));
    let mut profile = Sampled::new(profile, SampleTimes::every(at(apart))?);
    let (mut energy_change, mut fields) = (EnergyChange::default(), grid(arguments)?);
    let mut progress = Progress::of("run").until(end);

    let start = Instant::now();
    simulation.run_until(middle, &mut (&mut series, &mut progress))?;
    let mut second_half = (&mut energy_change, &mut fields, &mut profile);
    simulation.run_until(end, &mut (&mut series, &mut progress, &mut second_half))?;
    let seconds = start.elapsed().as_secs_f64();
    let temperature = mean(settled(&series), |(.., energy)| energy.translational).mean();
    let noise = thermal_noise(temperature, 1.0, simulation.disks().len())?;
    let flow = name_of_flow(settled(&series), noise, profile.densest_layer(), arguments)?;
    Ok(Outcome { simulation, seconds, series, energy_change, fields, noise, flow })
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
    let container = if arguments.periodic { container.with_periodic_sides()? } else { container };
    let container = if arguments.has_own_base() {
        let [normal, tangential] = wall_inelasticities(arguments);
        let normal = arguments.base_inelasticity.unwrap_or(normal);
        let tangential = arguments.base_tangential_inelasticity.unwrap_or(tangential);
        container
            .with_rule(Wall::Floor, with_duration(arguments, wall_rule(arguments, normal, tangential)?)?)?
    } else {
        container
    };
    Ok(match arguments.base {
        Base::BiParabolic => container.with_motion(Wall::Floor, BiParabolic::new(amplitude, omega)?)?,
        Base::Sinusoidal => container.with_motion(Wall::Floor, Sinusoidal::new(amplitude, omega)?)?,
        Base::Triangular => container.with_motion(Wall::Floor, Triangular::new(amplitude, omega)?)?,
        Base::Thermal => container.with_temperature(Wall::Floor, Thermal::new(arguments.temperature())?)?,
    })
}

/// Returns one rule for collisions of disks, and one for collisions with walls.
fn rule(arguments: &Arguments) -> Result<BoxedRule, ParameterError> {
    let Arguments { inelasticity, friction, .. } = *arguments;
    let tangential = arguments.tangential_inelasticity.unwrap_or(inelasticity);
    let dynamic = arguments.dynamic_friction.unwrap_or(friction);
    let disks =
        Frictional::from_inelasticity(inelasticity, tangential, friction)?.with_dynamic_friction(dynamic)?;
    let [normal, tangential] = wall_inelasticities(arguments);
    let walls = wall_rule(arguments, normal, tangential)?;
    with_duration(arguments, RulesByKind::new(disks).with(Kind::DEFAULT, Kind::WALL, walls))
}

/// Returns the inelasticities of the walls, along the normal and along the tangent.
fn wall_inelasticities(arguments: &Arguments) -> [f64; 2] {
    let normal = arguments.inelasticity;
    let tangential = arguments.tangential_inelasticity.unwrap_or(normal);
    [normal, tangential].map(|disks| arguments.wall_inelasticity.unwrap_or(disks))
}

fn wall_rule(arguments: &Arguments, normal: f64, tangential: f64) -> Result<Frictional, ParameterError> {
    let Arguments { friction, wall_friction, .. } = *arguments;
    let dynamic = arguments.dynamic_friction.unwrap_or(friction);
    let [at_rest, sliding] = [friction, dynamic].map(|disks| wall_friction.unwrap_or(disks));
    Frictional::from_inelasticity(normal, tangential, at_rest)?.with_dynamic_friction(sliding)
}

fn with_duration(
    arguments: &Arguments,
    rule: impl CollisionRule + Send + Sync + 'static,
) -> Result<BoxedRule, ParameterError> {
    let duration = arguments.contact_duration();
    Ok(if duration > 0.0 { Box::new(ContactDuration::new(rule, duration)?) } else { Box::new(rule) })
}

/// Returns a grid of about seven diameters a cell: fewer columns if the box is narrow, larger cells if it is
/// wide.
fn grid(arguments: &Arguments) -> Result<Sampled<Fields>, ParameterError> {
    let columns = (arguments.width / 7.0).round().clamp(4.0, 24.0);
    let times = SampleTimes::every(arguments.every.min(FRESH) as f64 * arguments.period())?;
    flow::on_squares(DVec2::ZERO, DVec2::new(arguments.width, arguments.shown()), columns as usize, times)
}

/// Returns the samples of the second half.
fn settled(series: &Series<Quantities>) -> &[Sample] {
    &series.values()[series.values().len() / 2..]
}

fn mean(samples: &[Sample], quantity: fn(&Sample) -> f64) -> Estimate {
    samples.iter().map(quantity).collect::<BlockedMean>().estimate()
}

/// Names the flow of these samples.
fn name_of_flow(
    samples: &[Sample],
    noise: f64,
    layer: Option<DenseLayer>,
    arguments: &Arguments,
) -> Result<String, ParameterError> {
    let order = |(order, ..): &Sample| match order {
        // Without side walls, a pair of rolls drifts from one order parameter to the other.
        _ if arguments.periodic => ConvectionOrder::new(0.0, order.one_roll.hypot(order.two_rolls)),
        _ => *order,
    };
    let order: Vec<_> = samples.iter().map(order).collect();
    let found =
        StateCriteria::default().with_base_speed(arguments.base_speed())?.classify(&order, noise, layer)?;
    Ok(if arguments.periodic { found.regime().to_string() } else { found.state().to_string() })
}

impl Outcome {
    /// Returns the mean of a quantity in the second half.
    pub(crate) fn mean(&self, quantity: fn(&Sample) -> f64) -> Estimate {
        mean(settled(&self.series), quantity)
    }

    /// Returns the collisions of two disks in a second.
    pub(crate) fn speed(&self) -> f64 {
        self.simulation.counters().disk_collisions as f64 / self.seconds
    }

    /// Returns a hash of the last state, which depends on every bit of it.
    pub(crate) fn hash(&self) -> String {
        let numbers = |disk: &Disk| {
            let (position, velocity) = (disk.position(), disk.velocity());
            [position.x, position.y, velocity.x, velocity.y, disk.angle(), disk.angular_velocity()]
        };
        let (disks, time) = (self.simulation.disks(), self.simulation.time());
        let numbers = disks.iter().flat_map(numbers).chain([time]);
        let bytes: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
        blake3::hash(&bytes).to_hex()[..32].to_owned()
    }
}
