//! The flags of the example.

use std::f64::consts::TAU;
use std::fmt::{self, Display, Formatter};

use clap::{Parser, ValueEnum};

use gallery::command_line::{Failure, non_negative, positive, whole};
use gallery::results::Results;

/// Frictional, inelastic disks in a box with a vibrating base: convection rolls, or none.
///
/// Lengths are in disk diameters, masses in disk masses, times in any unit that gravity and ω share. Prints a
/// summary and writes a picture (disks, mean flow, series), the series as a table, and with --json all
/// numbers. An oscillation lasts 2π/ω, also over a thermal base. Means are over the second half of the run.
#[derive(Debug, Clone, Parser)]
pub(crate) struct Arguments {
    /// Number of disks.
    #[arg(long, default_value_t = 1000, value_parser = whole::<1_000_000>)]
    pub(crate) disks: u64,
    /// Moment of inertia of a disk, in units of m R²: 0.5 if it is homogeneous, 1 for a ring.
    #[arg(long, default_value_t = 0.5, value_parser = positive)]
    pub(crate) inertia: f64,
    /// Width of the box, in diameters.
    #[arg(long, default_value_t = 60.0, value_parser = positive)]
    pub(crate) width: f64,
    /// Height of the lid, in diameters.
    #[arg(long, default_value_t = 150.0, value_parser = positive)]
    pub(crate) height: f64,
    /// Removes the lid.
    #[arg(long, conflicts_with = "height")]
    pub(crate) open: bool,
    /// Joins the sides: a disk that leaves on one side enters on the other.
    #[arg(long)]
    pub(crate) periodic: bool,
    /// Gravity.
    #[arg(long, default_value_t = 0.015_625, value_parser = non_negative)]
    pub(crate) gravity: f64,
    /// Inelasticity q = (1 - r)/2 along the normal, in [0, 0.5].
    #[arg(long, default_value_t = 0.0, value_parser = non_negative)]
    pub(crate) inelasticity: f64,
    /// Inelasticity along the tangent, in [0, 1]; equal to the normal one unless given.
    #[arg(long, value_parser = non_negative)]
    pub(crate) tangential_inelasticity: Option<f64>,
    /// Static friction κ.
    #[arg(long, default_value_t = 0.03, value_parser = non_negative)]
    pub(crate) friction: f64,
    /// Dynamic friction, at most the static one; equal to it unless given.
    #[arg(long, value_parser = non_negative)]
    pub(crate) dynamic_friction: Option<f64>,
    /// Friction of all walls, static and dynamic; the disks' unless given.
    #[arg(long, value_parser = non_negative)]
    pub(crate) wall_friction: Option<f64>,
    /// Inelasticity of all walls, normal and tangential; the disks' unless given.
    #[arg(long, value_parser = non_negative)]
    pub(crate) wall_inelasticity: Option<f64>,
    /// Inelasticity of the base along the normal; the walls' unless given.
    #[arg(long, value_parser = non_negative)]
    pub(crate) base_inelasticity: Option<f64>,
    /// Inelasticity of the base along the tangent; the walls' unless given.
    #[arg(long, value_parser = non_negative)]
    pub(crate) base_tangential_inelasticity: Option<f64>,
    /// Kind of base.
    #[arg(long, value_enum, default_value = "bi-parabolic")]
    pub(crate) base: Base,
    /// Amplitude A of a base that moves; 0.1 unless given.
    #[arg(long, value_parser = positive)]
    amplitude: Option<f64>,
    /// Angular frequency ω of the base.
    #[arg(long, default_value_t = 10.0, value_parser = positive)]
    pub(crate) omega: f64,
    /// Temperature of a thermal base; 1 unless given.
    #[arg(long, value_parser = positive)]
    temperature: Option<f64>,
    /// Contact duration, 0 for none; unless given, 1e-4 of the time in which a disk with the speed of the
    /// base moves by its diameter.
    #[arg(long, value_parser = non_negative)]
    contact_duration: Option<f64>,
    /// Length of the run, in oscillations.
    #[arg(long, default_value_t = 3000, value_parser = whole::<1_000_000_000>)]
    oscillations: u64,
    /// Oscillations between two samples.
    #[arg(long, default_value_t = 10, value_parser = whole::<1_000_000_000>)]
    pub(crate) every: u64,
    /// Seed of the initial velocities and of a thermal base.
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    /// Runs for 300 oscillations at most.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    pub(crate) results: Results,
}

/// The base, which drives the disks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Base {
    /// Pieces of parabolas, as in the paper.
    BiParabolic,
    Sinusoidal,
    /// Constant speed up and down.
    Triangular,
    /// At rest, with a temperature.
    Thermal,
}

impl Base {
    const fn name(self) -> &'static str {
        match self {
            Self::BiParabolic => "bi-parabolic",
            Self::Sinusoidal => "sinusoidal",
            Self::Triangular => "triangular",
            Self::Thermal => "thermal",
        }
    }
}

impl Arguments {
    /// Checks the flags against each other.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        let (every, oscillations, thermal) = (self.every, self.oscillations(), self.base == Base::Thermal);
        let late = format!("--every {every}: no sample is taken in {oscillations} oscillations");
        let mistakes = [
            (every > oscillations, &*late),
            (self.gravity == 0.0 && self.open, "--gravity 0 --open: without gravity the box needs a lid"),
            (thermal && self.amplitude.is_some(), "--amplitude: a thermal base does not move"),
            (!thermal && self.temperature.is_some(), "--temperature: only --base thermal has one"),
            (thermal && self.has_own_base(), "--base-inelasticity: a thermal base draws velocities anew"),
        ];
        let made = mistakes.into_iter().find(|(made, _)| *made);
        made.map_or(Ok(()), |(_, message)| Err(Failure::usage(message)))
    }

    /// Returns true if the base has another inelasticity than the walls.
    pub(crate) fn has_own_base(&self) -> bool {
        self.base_inelasticity.or(self.base_tangential_inelasticity).is_some()
    }

    /// Returns the length of the run, in oscillations.
    pub(crate) fn oscillations(&self) -> u64 {
        if self.quick { self.oscillations.min(300) } else { self.oscillations }
    }

    /// Returns the duration of an oscillation.
    pub(crate) fn period(&self) -> f64 {
        TAU / self.omega
    }

    pub(crate) fn amplitude(&self) -> f64 {
        self.amplitude.unwrap_or(0.1)
    }

    pub(crate) fn temperature(&self) -> f64 {
        self.temperature.unwrap_or(1.0)
    }

    /// Returns the height that is measured and drawn: up to the lid, or five times the width.
    pub(crate) fn shown(&self) -> f64 {
        if self.open { 5.0 * self.width } else { self.height }
    }

    /// Returns the scale of the speeds that the base gives to disks.
    pub(crate) fn base_speed(&self) -> f64 {
        if self.base == Base::Thermal { self.temperature().sqrt() } else { self.amplitude() * self.omega }
    }

    /// Returns the contact duration; 0 for none.
    pub(crate) fn contact_duration(&self) -> f64 {
        self.contact_duration.unwrap_or(1e-4 / self.base_speed())
    }
}

/// Describes the system in one line.
impl Display for Arguments {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        let Self { width, height, base, omega, gravity, inelasticity, friction, .. } = self;
        let top = if self.open { "open above".to_owned() } else { format!("{height} high") };
        let sides = if self.periodic { ", periodic sides" } else { "" };
        write!(formatter, "box {width} wide, {top}{sides}; {} base, ", base.name())?;
        match base {
            Base::Thermal => write!(formatter, "T₀ = {}", self.temperature())?,
            _ => write!(formatter, "A = {}, ω = {omega}", self.amplitude())?,
        }
        write!(formatter, "; g = {gravity}, q = {inelasticity}, κ = {friction}")
    }
}
