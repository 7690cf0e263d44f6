//! The states of the points, from records, and the transitions between them.

use std::error::Error;
use std::path::Path;

use granular_edmd::ParameterError;
use granular_edmd_study::analysis::{ConvectiveRegime, StateCriteria};
use granular_edmd_study::vibrated_box::VibratedBox;
use granular_edmd_study::{Leg, Record, Study};

use crate::picture::{Crossing, State};
use crate::plane::{PlaneTransition, plane_transitions};
use gallery::results;

/// The state seen at a point of the plane, on the way up or down.
pub(crate) struct Point {
    pub(crate) friction: f64,
    pub(crate) inelasticity: f64,
    pub(crate) leg: Option<Leg>,
    pub(crate) regime: ConvectiveRegime,
    /// Fractions of the samples with no, one and two rolls.
    weights: [f64; 3],
    one_roll: f64,
    two_rolls: f64,
    noise: f64,
    /// Largest packing fraction of the height profile, and the least one below it.
    packing: (f64, f64),
    height: f64,
    samples: usize,
    outcome: &'static str,
}

impl Point {
    /// Returns the point of a record, or `None` if the record has no samples.
    fn of(record: &Record<VibratedBox>) -> Result<Option<Self>, ParameterError> {
        let Some(layer) = record.densest_layer() else { return Ok(None) };
        let noise = record.thermal_noise();
        let found = StateCriteria::default().classify(&record.order(), noise, Some(layer))?;
        Ok(Some(Self {
            friction: record.experiment().friction,
            inelasticity: record.experiment().inelasticity,
            leg: record.leg(),
            regime: found.regime(),
            weights: [0, 1, 2].map(|rolls| found.weight_of_rolls(rolls)),
            one_roll: record.mean(|sample| sample.one_roll.abs()).mean(),
            two_rolls: record.mean(|sample| sample.two_rolls).mean(),
            noise,
            packing: (layer.packing_fraction, layer.least_below),
            height: record.mean(|sample| sample.height).mean(),
            samples: record.samples().len(),
            outcome: record.outcome().name(),
        }))
    }
}

/// Returns the points of all finished values.
pub(crate) fn points(studies: &[Study<VibratedBox>]) -> Result<Vec<Point>, Box<dyn Error>> {
    let mut points = Vec::new();
    for record in studies.iter().flat_map(Study::records) {
        points.extend(Point::of(&record?)?);
    }
    Ok(points)
}

/// Returns the points of the transition lines.
pub(crate) fn lines(states: &[State]) -> Result<Vec<PlaneTransition>, ParameterError> {
    plane_transitions(states.iter().map(|state| (state.friction, state.inelasticity, state.regime)))
}

/// Reads the states of a table that [`write_points`] has written.
pub(crate) fn read(table: &Path) -> Result<Vec<State>, Box<dyn Error>> {
    let read = || -> Result<Vec<State>, Box<dyn Error>> {
        let rows = csv::Reader::from_path(table)?.into_deserialize().map(|row| {
            let (_, friction, inelasticity, leg, name): (f64, f64, f64, String, String) = row?;
            let regime = ConvectiveRegime::ALL.iter().copied().find(|regime| regime.to_string() == name);
            let regime = regime.ok_or_else(|| format!("there is no state “{name}”"))?;
            Ok(State { friction, inelasticity, regime, down: leg == Leg::Down.to_string() })
        });
        rows.collect()
    };
    read().map_err(|error| format!("{}: {error}", table.display()).into())
}

/// Returns the points in the form that the picture needs.
pub(crate) fn drawn(points: &[Point]) -> Vec<State> {
    let state = |point: &Point| State {
        friction: point.friction,
        inelasticity: point.inelasticity,
        regime: point.regime,
        down: point.leg == Some(Leg::Down),
    };
    points.iter().map(state).collect()
}

/// Returns the points of the lines in the form that the picture needs.
pub(crate) fn crossings(lines: &[PlaneTransition]) -> Vec<Crossing> {
    let crossing = |&PlaneTransition { line, friction, inelasticity, between, rising }: &PlaneTransition| {
        Crossing { line, friction, inelasticity, rising, between }
    };
    lines.iter().map(crossing).collect()
}

/// Writes `points.csv`.
pub(crate) fn write_points(points: &[Point], gravity: f64, folder: &Path) -> Result<(), Box<dyn Error>> {
    let mut table = results::table(&folder.join("points.csv"))?;
    table.write_record([
        "gravity",
        "friction",
        "inelasticity",
        "leg",
        "regime",
        "weight_no_roll",
        "weight_one_roll",
        "weight_two_rolls",
        "one_roll_magnitude",
        "two_rolls",
        "thermal_noise",
        "densest_packing",
        "least_packing_below",
        "height",
        "samples",
        "outcome",
    ])?;
    for point in points {
        let Point { friction, inelasticity, regime, weights, one_roll, two_rolls, noise, .. } = point;
        let leg = point.leg.map(|leg| leg.to_string());
        let place = (gravity, friction, inelasticity, leg, regime.to_string());
        let measured = [*one_roll, *two_rolls, *noise, point.packing.0, point.packing.1, point.height];
        let measured = measured.map(|value| format!("{value:.4}"));
        let weights = weights.map(|weight| format!("{:.3}", weight.abs()));
        table.serialize((place, weights, measured, point.samples, point.outcome))?;
    }
    Ok(table.flush()?)
}

/// Writes `transitions.csv`, which the example `table1` reads.
pub(crate) fn write_lines(
    lines: &[PlaneTransition],
    gravity: f64,
    folder: &Path,
) -> Result<(), Box<dyn Error>> {
    let mut table = results::table(&folder.join("transitions.csv"))?;
    table.write_record([
        "gravity",
        "line",
        "friction",
        "inelasticity",
        "rising",
        "first_friction",
        "first_inelasticity",
        "second_friction",
        "second_inelasticity",
    ])?;
    for at in lines {
        let name = at.line.to_string();
        let round = |value: f64| format!("{value:.6}");
        let between = at.between.map(|(friction, inelasticity)| [friction, inelasticity].map(round));
        table.serialize((gravity, name, round(at.friction), round(at.inelasticity), at.rising, between))?;
    }
    Ok(table.flush()?)
}
