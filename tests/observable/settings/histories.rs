//! Measures of pairs of times: displacements, correlations.

use std::collections::BTreeMap;

use granular_edmd::Disk;
use granular_edmd::boundary::Region;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Crossings, MeanSquaredDisplacement, TimeCorrelation, Velocities};

use super::log::{Log, Occasion};
use super::systems::{Setting, every};
use super::{Cell, far, told};

/// Largest number of intervals between two samples.
const LAGS: usize = 4;

/// End of the last whole interval.
const LAST: f64 = 36.0;

/// Values of the disks, by their ids.
type Values = BTreeMap<u64, DVec2>;

/// Returns groups of consecutive samples between which no disk was put elsewhere, with the displacements of
/// the disks since the start, and their velocities.
fn groups(setting: &Setting, log: &Log) -> Vec<Vec<[Values; 2]>> {
    let domain = setting.domain();
    let (mut groups, mut ways, mut before) = (vec![Vec::new()], Values::new(), Values::new());
    let mut last = Occasion::Start;
    for state in &log.states {
        let mut was_put_elsewhere = false;
        for disk in &state.disks {
            let step = before
                .get(&disk.id())
                .map_or(DVec2::ZERO, |&place| domain.separation(place, disk.position()));
            was_put_elsewhere |= step.length() > 1e-9;
            *ways.entry(disk.id()).or_default() += step;
        }
        if state.occasion == Occasion::Start && last == Occasion::End && was_put_elsewhere {
            groups.push(Vec::new());
        }
        last = state.occasion;
        before = state.disks.iter().map(|disk| (disk.id(), disk.position())).collect();
        if state.is_sampled() {
            let here: Values = state.disks.iter().map(|disk| (disk.id(), ways[&disk.id()])).collect();
            let velocities = state.disks.iter().map(|disk| (disk.id(), disk.velocity())).collect();
            if let Some(group) = groups.last_mut() {
                group.push([here, velocities]);
            }
        }
    }
    groups
}

/// Returns the mean over pairs of samples of the mean over the disks that are in both, for each lag.
fn means(groups: &[Vec<[Values; 2]>], which: usize, pair: impl Fn(DVec2, DVec2) -> f64) -> Vec<f64> {
    let mean = |lag: usize| {
        let pairs = groups.iter().flat_map(|group| group.iter().zip(group.iter().skip(lag)));
        let values: Vec<f64> = pairs
            .filter_map(|(earlier, later)| {
                let common = earlier[which]
                    .iter()
                    .filter_map(|(id, &value)| Some(pair(value, *later[which].get(id)?)));
                let all: Vec<f64> = common.collect();
                (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
            })
            .collect();
        values.iter().sum::<f64>() / values.len() as f64
    };
    (0..=LAGS).map(mean).collect()
}

pub(super) fn displacements(setting: &Setting) -> Cell {
    let mut displacement = MeanSquaredDisplacement::new(LAGS, every(1.0)).map_err(told)?;
    let log = setting.run(&mut displacement)?;
    let truth = means(&groups(setting, &log), 0, DVec2::distance_squared);
    let measured: Vec<f64> = displacement.iter().map(|(_, value)| value.mean()).collect();
    Ok(far(&measured, &truth))
}

pub(super) fn correlations(setting: &Setting) -> Cell {
    let mut correlation = TimeCorrelation::new(Velocities, LAGS, every(1.0)).map_err(told)?;
    let log = setting.run(&mut correlation)?;
    let truth = means(&groups(setting, &log), 1, DVec2::dot);
    let measured: Vec<f64> = correlation.iter().map(|(_, value)| value.mean()).collect();
    Ok(far(&measured, &truth))
}

/// Crossings of a line through the middle of the bulk, by small steps along each free flight.
pub(super) fn crossings(setting: &Setting) -> Cell {
    const STEPS: u32 = 200;
    let Region { min, max, .. } = setting.bulk;
    let height = 0.5 * (min.y + max.y) + 0.01;
    let line = [DVec2::new(min.x, height), DVec2::new(max.x, height)];
    let mut crossings = Crossings::new(line, every(1.0)).map_err(told)?;
    let log = setting.run(&mut crossings)?;
    let (domain, pull) = (setting.domain(), setting.gravity().acceleration());
    let middle = 0.5 * (line[0] + line[1]);
    let seen = |place: DVec2| domain.separation(middle, place);
    let mut counts = [0.0; 2];
    // A flight from a place at a time on, with a velocity, up to another time.
    let mut follow = |(from, place, velocity): (f64, DVec2, DVec2), until: f64| {
        let at = |step: u32| {
            let wait = (until - from) * f64::from(step) / f64::from(STEPS);
            seen(place + (velocity + 0.5 * pull * wait) * wait)
        };
        for step in 0..STEPS {
            let (one, other) = (at(step), at(step + 1));
            let is_near = one.y.abs().max(other.y.abs()) < 1.0;
            if is_near
                && (one.y > 0.0) != (other.y > 0.0)
                && (0.5 * (one.x + other.x)).abs() < 0.5 * (max.x - min.x)
            {
                counts[usize::from(one.y > 0.0)] += 1.0;
            }
        }
    };
    let mut flights: BTreeMap<u64, (f64, DVec2, DVec2)> = BTreeMap::new();
    let mut done = 0;
    for state in log.states.iter().filter(|state| state.time <= LAST) {
        for collision in &log.collisions[done..state.collisions] {
            for (partner, id) in collision.ids.into_iter().enumerate().filter(|(_, id)| *id > 0) {
                let place = if partner == 0 { collision.position } else { collision.partner_position() };
                let next = (collision.time, place, collision.velocities[partner]);
                if let Some(flight) = flights.insert(id, next) {
                    follow(flight, collision.time);
                }
            }
        }
        done = state.collisions;
        for disk in &state.disks {
            if let Some(flight) = flights.get(&disk.id()) {
                follow(*flight, state.time);
            }
        }
        let fly = |disk: &Disk| (disk.id(), (state.time, disk.position(), disk.velocity()));
        flights = state.disks.iter().map(fly).collect();
    }
    let sum = |counts: &[u64]| counts.iter().sum::<u64>() as f64;
    Ok(far(&[sum(crossings.forward()), sum(crossings.backward())], &counts))
}
