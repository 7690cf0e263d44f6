//! Ramps of studies of the vibrated box, read from their tables.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use granular_edmd::observable::DenseLayer;
use granular_edmd::statistics::RunningMean;
use granular_edmd_study::Plan;
use granular_edmd_study::analysis::{ConvectiveRegime, Transition, TransitionLine, transitions};
use granular_edmd_study::vibrated_box::VibratedBox;

use crate::phase_diagram;

/// Friction between the two branches of the lines: the loss is largest near it.
const LARGEST_LOSS: f64 = 0.35;

/// Names of the walls.
pub(crate) const AS_THE_DISKS: &str = "walls as the disks";
pub(crate) const ELASTIC_WALLS: &str = "elastic frictional walls";

/// A row of a table of values; columns that are not named here are left out.
#[derive(serde::Deserialize)]
struct Row {
    ramp: usize,
    value: u32,
    leg: String,
    friction: Option<f64>,
    inelasticity: Option<f64>,
    state: String,
    translational_energy: f64,
    rotational_energy: f64,
    /// The tables of short ramps lack this column and the next two.
    #[serde(default)]
    thermal_noise: f64,
    #[serde(default)]
    densest_packing: f64,
    #[serde(default)]
    densest_height: f64,
}

/// The state at one value of a ramp.
#[derive(Debug, Clone)]
pub(crate) struct Observation {
    /// The number of the value in the ramp.
    pub(crate) value: u32,
    pub(crate) friction: f64,
    pub(crate) inelasticity: f64,
    pub(crate) leg: String,
    pub(crate) regime: ConvectiveRegime,
    /// Rotational over translational temperature of all disks.
    pub(crate) temperature_ratio: f64,
    /// Standard deviation of the order parameters in a gas at rest.
    pub(crate) noise: f64,
    /// The densest layer. The tables do not show what lies below it; below a compact layer, that is always a
    /// gas.
    pub(crate) layer: DenseLayer,
}

/// The observations of one ramp, in friction or in inelasticity, with its bisected values.
#[derive(Debug, Clone)]
pub(crate) struct Ramp {
    /// The folder of the study, and its name.
    pub(crate) folder: PathBuf,
    pub(crate) study: String,
    /// The box at the first value.
    pub(crate) experiment: VibratedBox,
    /// Oscillations of each value.
    pub(crate) oscillations: u64,
    /// True if friction grows, false if inelasticity does.
    pub(crate) along_friction: bool,
    pub(crate) observations: Vec<Observation>,
}

/// Means over the collisions of a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Local {
    /// Energy change over the temperature of the layer.
    pub(crate) energy_change: f64,
    /// Rotational over translational temperature of the layer.
    pub(crate) temperature_ratio: f64,
}

/// A transition on a ramp, seen from below and from above, with the means over the values next to it.
#[derive(Debug, Clone)]
pub(crate) struct Crossing {
    pub(crate) line: TransitionLine,
    /// True if the loss grows along the ramp: everywhere but on ramps in friction beyond the largest loss.
    pub(crate) rising: bool,
    pub(crate) friction: f64,
    pub(crate) inelasticity: f64,
    /// True if the transition was met on a ramp in friction.
    pub(crate) along_friction: bool,
    /// Half the distance between the values between which the transition lies; for frictions, between their
    /// logarithms.
    pub(crate) half_width: f64,
    pub(crate) temperature_ratio: f64,
    pub(crate) local: Option<Local>,
}

impl Crossing {
    /// Returns the same crossing at both ends of the interval in which it must lie.
    pub(crate) fn ends(&self) -> [Self; 2] {
        [-self.half_width, self.half_width].map(|by| {
            let mut end = self.clone();
            if self.along_friction {
                end.friction *= by.exp();
            } else {
                end.inelasticity += by;
            }
            end
        })
    }

    /// Returns the crossing as a point of the phase diagram.
    pub(crate) fn in_the_plane(&self) -> phase_diagram::Crossing {
        phase_diagram::Crossing {
            line: self.line,
            friction: self.friction,
            inelasticity: self.inelasticity,
            rising: self.rising,
            between: self.ends().map(|end| (end.friction, end.inelasticity)),
        }
    }
}

/// Reads the ramps of a study, or of all studies in a folder, in the order of their names.
pub(crate) fn read(folder: &Path) -> Result<Vec<Ramp>, Box<dyn Error>> {
    let is_study = |study: &Path| study.join("values.csv").is_file();
    let mut studies = gallery::runs::entries(folder)?;
    studies.push(folder.to_owned());
    studies.retain(|study| is_study(study));
    studies.sort();
    let ramps: Vec<Vec<Ramp>> = studies
        .iter()
        .map(|study| study_of(study).map_err(|error| format!("{}: {error}", study.display()).into()))
        .collect::<Result<_, Box<dyn Error>>>()?;
    if ramps.is_empty() {
        return Err(format!("{} has no tables of ramps", folder.display()).into());
    }
    Ok(ramps.into_iter().flatten().collect())
}

fn study_of(folder: &Path) -> Result<Vec<Ramp>, Box<dyn Error>> {
    let plan = Plan::<VibratedBox>::from_toml(&fs::read_to_string(folder.join("plan.toml"))?)?;
    let fixed = plan.experiment(0, 0)?;
    let rows: Vec<Row> =
        csv::Reader::from_path(folder.join("values.csv"))?.deserialize().collect::<Result<_, _>>()?;
    let along_friction = plan.ramp().is_some_and(|ramp| ramp.parameter() == "friction");
    let mut ramps: Vec<(usize, Ramp)> = Vec::new();
    for row in rows {
        let observation = Observation {
            value: row.value,
            friction: row.friction.unwrap_or(fixed.friction),
            inelasticity: row.inelasticity.unwrap_or(fixed.inelasticity),
            leg: row.leg,
            regime: regime(&row.state)?,
            temperature_ratio: 2.0 * row.rotational_energy / row.translational_energy,
            noise: row.thermal_noise,
            layer: DenseLayer::new(row.densest_height, row.densest_packing, 0.0),
        };
        match ramps.last_mut().filter(|(index, _)| *index == row.ramp) {
            Some((_, ramp)) => ramp.observations.push(observation),
            None => ramps.push((
                row.ramp,
                Ramp {
                    folder: folder.to_owned(),
                    study: folder.file_name().unwrap_or_default().to_string_lossy().into_owned(),
                    experiment: fixed.clone(),
                    oscillations: plan.protocol().cycles(),
                    along_friction,
                    observations: vec![observation],
                },
            )),
        }
    }
    Ok(ramps.into_iter().map(|(_, ramp)| ramp).collect())
}

fn regime(name: &str) -> Result<ConvectiveRegime, String> {
    // Tables of version 0.2 and before say "conductive".
    let name = if name == "conductive" { "no roll" } else { name };
    let found = ConvectiveRegime::ALL.iter().copied().find(|regime| regime.to_string() == name);
    found.ok_or_else(|| format!("`{name}` is no state"))
}

impl Ramp {
    pub(crate) const fn gravity(&self) -> f64 {
        self.experiment.gravity
    }

    /// Returns a name of the walls.
    pub(crate) fn walls(&self) -> &'static str {
        match (self.experiment.wall_inelasticity, self.experiment.base_inelasticity) {
            (Some(0.0), _) => ELASTIC_WALLS,
            (_, Some(0.0)) => "elastic frictional base",
            _ => AS_THE_DISKS,
        }
    }

    /// Returns a name of the place of a crossing on its line, the same for all seeds.
    pub(crate) fn place(&self, at: &Crossing) -> String {
        let (parameter, fixed) =
            if self.along_friction { ("inelasticity", at.inelasticity) } else { ("friction", at.friction) };
        format!("{parameter} {fixed}, rising {}", at.rising)
    }

    /// Returns the transitions on this ramp.
    ///
    /// Each leg is examined alone, since bisected values are visited on one leg only. Coexistence begins
    /// where the first of the legs shows it, and ends where the last of them does; the other transitions lie
    /// in the middle of what the legs show. Middles of frictions are taken from their logarithms.
    pub(crate) fn crossings(&self) -> Result<Vec<Crossing>, Box<dyn Error>> {
        let mut seen = Vec::new();
        for leg in ["up", "down"] {
            let of_leg = self.observations.iter().filter(|seen| seen.leg == leg);
            seen.extend(transitions(of_leg.map(|seen| (self.value(seen), seen.regime)))?);
        }
        // A ramp that goes from one roll straight to the collapse has no transition to two rolls.
        let has_two_rolls = self.observations.iter().any(|seen| seen.regime == ConvectiveRegime::TwoRolls);
        let is_there = |line: &TransitionLine| {
            has_two_rolls || !matches!(line, TransitionLine::OneTwoBeginning | TransitionLine::OneTwoEnd)
        };
        let sides =
            TransitionLine::ALL.into_iter().filter(is_there).flat_map(|line| [(line, true), (line, false)]);
        Ok(sides.filter_map(|(line, rising)| self.crossing(line, rising, &seen)).collect())
    }

    fn value(&self, seen: &Observation) -> f64 {
        if self.along_friction { seen.friction.ln() } else { seen.inelasticity }
    }

    /// Returns whether the loss falls along the ramp here: in friction beyond its largest loss.
    fn is_beyond(&self, value: f64) -> bool {
        self.along_friction && value > LARGEST_LOSS.ln()
    }

    fn crossing(&self, line: TransitionLine, rising: bool, seen: &[Transition]) -> Option<Crossing> {
        let is_it =
            |at: &&Transition| at.line == line && at.rising == rising && self.is_beyond(at.value) != rising;
        let ends = seen.iter().filter(is_it).map(|at| [at.value - at.error, at.value + at.error]);
        let ends: Vec<[f64; 2]> = ends.collect();
        let lowest = ends.iter().copied().min_by(|a, b| a[0].total_cmp(&b[0]))?;
        let highest = ends.iter().copied().max_by(|a, b| a[1].total_cmp(&b[1]))?;
        let [from, to] = match (line, rising) {
            (TransitionLine::OneTwoBeginning, true) | (TransitionLine::OneTwoEnd, false) => lowest,
            (TransitionLine::OneTwoEnd, true) | (TransitionLine::OneTwoBeginning, false) => highest,
            _ => [lowest[0], highest[1]],
        };
        Some(self.between(line, rising, from, to))
    }

    fn between(&self, line: TransitionLine, rising: bool, from: f64, to: f64) -> Crossing {
        let (middle, half_width) = (0.5 * (from + to), 0.5 * (to - from));
        let first = &self.observations[0];
        let (friction, inelasticity) =
            if self.along_friction { (middle.exp(), first.inelasticity) } else { (first.friction, middle) };
        // The values on both sides have this distance, up to rounding.
        let is_near = |seen: &&Observation| (self.value(seen) - middle).abs() <= half_width * (1.0 + 1e-9);
        let near: Vec<&Observation> = self.observations.iter().filter(is_near).collect();
        let mean =
            |of: fn(&Observation) -> f64| near.iter().map(|seen| of(seen)).collect::<RunningMean>().mean();
        Crossing {
            line,
            rising,
            friction,
            inelasticity,
            along_friction: self.along_friction,
            half_width,
            temperature_ratio: mean(|seen| seen.temperature_ratio),
            local: None,
        }
    }
}
