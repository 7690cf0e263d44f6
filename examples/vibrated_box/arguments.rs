//! The flags of the example.

use std::f64::consts::TAU;
use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use clap::{Parser, ValueEnum};
use granular_edmd::collision::Frictional;

use crate::common::command_line::{non_negative, plain, positive, whole};

/// Frictional, inelastic disks in a box with a vibrating base: convection rolls, or none.
///
/// Lengths are in disk diameters, masses in disk masses, times in any unit that gravity and ω share. Prints a
/// summary and writes a picture (disks, mean flow, series) and the series as a table. An oscillation lasts
/// 2π/ω, also over a thermal base.
#[derive(Debug, Clone, Parser)]
#[command(name = "vibrated_box", allow_negative_numbers = true)]
pub(crate) struct Arguments {
    /// Number of disks.
    #[arg(long, default_value_t = 1000, value_parser = whole::<1_000_000>)]
    pub(crate) disks: u64,
    /// Width of the box, in diameters.
    #[arg(long, default_value_t = 60.0, value_parser = positive)]
    pub(crate) width: f64,
    /// Height of the lid, in diameters, or `none`.
    #[arg(long, default_value_t = Height(Some(150.0)))]
    pub(crate) height: Height,
    /// Gravity.
    #[arg(long, default_value_t = 0.015_625, value_parser = non_negative)]
    pub(crate) gravity: f64,
    /// Inelasticity q = (1 - r)/2, normal and tangential, in [0, 0.5].
    #[arg(long, default_value_t = 0.0, value_parser = inelasticity)]
    pub(crate) inelasticity: f64,
    /// Friction κ, static and dynamic.
    #[arg(long, default_value_t = 0.03, value_parser = non_negative)]
    pub(crate) friction: f64,
    /// Amplitude A of the base.
    #[arg(long, default_value_t = 0.1, value_parser = positive)]
    pub(crate) amplitude: f64,
    /// Angular frequency ω of the base.
    #[arg(long, default_value_t = 10.0, value_parser = positive)]
    pub(crate) omega: f64,
    /// Length of the run, in oscillations.
    #[arg(long, default_value_t = 3000, value_parser = whole::<1_000_000_000>)]
    pub(crate) oscillations: u64,
    /// Oscillations from sample to sample.
    #[arg(long, default_value_t = 10, value_parser = whole::<1_000_000_000>)]
    pub(crate) every: u64,
    /// Seed of the first velocities and of a thermal base.
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    /// Base: `bi-parabolic`, `sinusoidal`, `triangular`, or `thermal:T0` (fixed, of the temperature T0).
    #[arg(long, default_value_t = Base::BiParabolic)]
    pub(crate) base: Base,
    /// Sides of the box.
    #[arg(long, value_enum, default_value_t = Sides::Walls)]
    pub(crate) sides: Sides,
    /// Contact duration of the TC model, 0 for none; unless given, 1e-4 of the time in which a disk with the
    /// speed of the base, A ω (or √T0 over a thermal base), moves by its diameter.
    #[arg(long, value_parser = non_negative)]
    pub(crate) contact_duration: Option<f64>,
    /// Folder for `vibrated_box.png` and `vibrated_box.csv`.
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub(crate) out: PathBuf,
    /// Writes the results as one JSON object to this file, or to standard output for `-`. Means are over the
    /// second half of the samples, `mean_energy_change` over all disk–disk collisions of that time; its
    /// standard error knows that they are correlated, and is a lower bound unless
    /// `mean_energy_change_converged`. Counts, the largest overlap, `run_seconds` and `collisions_per_second`
    /// (disk–disk) are those of the whole run.
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
}

impl Arguments {
    /// Returns the duration of an oscillation.
    pub(crate) fn period(&self) -> f64 {
        TAU / self.omega
    }

    /// Returns the scale of the speeds that the base gives to disks.
    pub(crate) fn base_speed(&self) -> f64 {
        match self.base {
            Base::Thermal(temperature) => temperature.sqrt(),
            _ => self.amplitude * self.omega,
        }
    }

    /// Returns the contact duration of the TC model; 0 for none.
    pub(crate) fn contact_duration(&self) -> f64 {
        self.contact_duration.unwrap_or(1e-4 / self.base_speed())
    }

    /// Returns the number of samples that the run takes.
    pub(crate) fn samples(&self) -> u64 {
        self.oscillations / self.every
    }

    /// Returns the number of the sample after which means are taken.
    pub(crate) fn settled(&self) -> u64 {
        self.samples() / 2
    }

    /// Tells whether results on standard output would disturb the JSON there.
    pub(crate) fn json_to_standard_output(&self) -> bool {
        self.json.as_ref().is_some_and(|path| path.as_os_str() == "-")
    }
}

fn inelasticity(text: &str) -> Result<f64, String> {
    let value = non_negative(text)?;
    Frictional::new(value, 0.0).map(|_| value).map_err(|error| format!("must be {}", error.requirement()))
}

/// The height of the lid, if there is one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Height(pub(crate) Option<f64>);

impl FromStr for Height {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "none" {
            return Ok(Self(None));
        }
        positive(text).map(|height| Self(Some(height))).map_err(|error| format!("{error}, or `none`"))
    }
}

impl fmt::Display for Height {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(height) => formatter.write_str(&plain(height)),
            None => formatter.write_str("none"),
        }
    }
}

/// The base, which drives the disks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Base {
    BiParabolic,
    Sinusoidal,
    Triangular,
    Thermal(f64),
}

impl FromStr for Base {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "bi-parabolic" => Ok(Self::BiParabolic),
            "sinusoidal" => Ok(Self::Sinusoidal),
            "triangular" => Ok(Self::Triangular),
            _ => match text.strip_prefix("thermal:") {
                Some(temperature) => {
                    let temperature = positive(temperature);
                    temperature.map(Self::Thermal).map_err(|error| format!("the temperature {error}"))
                }
                None => Err("must be bi-parabolic, sinusoidal, triangular or thermal:T0".to_owned()),
            },
        }
    }
}

impl fmt::Display for Base {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BiParabolic => formatter.write_str("bi-parabolic"),
            Self::Sinusoidal => formatter.write_str("sinusoidal"),
            Self::Triangular => formatter.write_str("triangular"),
            Self::Thermal(temperature) => write!(formatter, "thermal:{temperature}"),
        }
    }
}

/// The sides of the box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Sides {
    /// Walls with the friction and inelasticity of the disks.
    Walls,
    /// A disk that leaves on one side enters on the other.
    Periodic,
}

impl Sides {
    /// Returns the word for the sides.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Walls => "walls",
            Self::Periodic => "periodic",
        }
    }
}
