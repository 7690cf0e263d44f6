//! Observables of states, computed anew for each sample.

use std::f64::consts::TAU;

use granular_edmd::Disk;
use granular_edmd::boundary::Domain;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    CenterOfMass, Energies, Grid, HexaticOrder, Observable, OfKind, OrderParameters, Sampled, Series,
    Snapshot, Temperatures, TemperaturesAboutFlow, VelocityDistribution, measured_by,
};

use super::log::State;
use super::systems::{OTHER, Setting, every};
use super::{Cell, far};

/// Compares a series of numbers with those of the states, in which `truth` finds them.
fn series<Q: Observable>(
    setting: &Setting,
    observable: Q,
    numbers: impl Fn(&Q::Value) -> Vec<f64>,
    truth: impl Fn(&State) -> Vec<f64>,
) -> Cell {
    let mut series = Series::new(observable, every(1.0));
    let log = setting.run(&mut series)?;
    let times = log.samples().map(|state| state.time);
    assert!(series.times().iter().copied().eq(times), "{}: the times of a series", setting.name);
    let pairs = series.values().iter().zip(log.samples());
    Ok(pairs.map(|(value, state)| far(&numbers(value), &truth(state))).fold(0.0, f64::max))
}

pub(super) fn numbers_of_disks(setting: &Setting) -> Cell {
    let count = measured_by(|snapshot: &Snapshot<'_>| snapshot.len() as f64);
    series(setting, count, |count| vec![*count], |state| vec![state.disks.len() as f64])
}

/// The center, or in a periodic direction the place about which the disks are balanced on the circle.
pub(super) fn center_of_mass(setting: &Setting) -> Cell {
    let domain = setting.domain();
    let mut series = Series::new(CenterOfMass, every(1.0));
    let log = setting.run(&mut series)?;
    let mut worst: f64 = 0.0;
    for (center, state) in series.values().iter().zip(log.samples()) {
        let mass: f64 = state.disks.iter().map(Disk::mass).sum();
        let about = |term: &dyn Fn(DVec2) -> f64| -> f64 {
            state.disks.iter().map(|disk| disk.mass() * term(disk.position())).sum::<f64>() / mass
        };
        for (axis, period) in [domain.periods().x, domain.periods().y].into_iter().enumerate() {
            if period == 0.0 {
                worst = worst.max((about(&|place| place[axis]) - center[axis]).abs());
                continue;
            }
            let angle = |place: DVec2| TAU * (place[axis] - center[axis]) / period;
            let (sine, cosine) = (about(&|place| angle(place).sin()), about(&|place| angle(place).cos()));
            worst = worst.max((sine / cosine).abs()).max(if cosine > 0.0 { 0.0 } else { 1.0 });
        }
    }
    Ok(worst)
}

pub(super) fn energies(setting: &Setting) -> Cell {
    let (pull, domain) = (setting.gravity().acceleration(), setting.domain());
    let truth = |state: &State| {
        let translational = state.mean(|disk| 0.5 * disk.mass() * disk.velocity().length_squared());
        let rotational = state.mean(|disk| 0.5 * disk.moment_of_inertia() * disk.angular_velocity().powi(2));
        let potential = state.mean(|disk| -disk.mass() * pull.dot(domain.unwrapped(disk)));
        vec![translational, rotational, potential]
    };
    series(setting, Energies, |e| vec![e.translational, e.rotational, e.potential], truth)
}

fn temperatures_of(state: &State, is_counted: impl Fn(&Disk) -> bool) -> Vec<f64> {
    let disks: Vec<&Disk> = state.disks.iter().filter(|disk| is_counted(disk)).collect();
    let mean =
        |term: &dyn Fn(&Disk) -> f64| disks.iter().map(|disk| term(disk)).sum::<f64>() / disks.len() as f64;
    vec![
        mean(&|disk| disk.mass() * disk.velocity().x.powi(2)),
        mean(&|disk| disk.mass() * disk.velocity().y.powi(2)),
        mean(&|disk| disk.moment_of_inertia() * disk.angular_velocity().powi(2)),
    ]
}

pub(super) fn temperatures(setting: &Setting) -> Cell {
    let numbers = |t: &granular_edmd::observable::Temperature| vec![t.horizontal, t.vertical, t.rotational];
    series(setting, Temperatures, numbers, |state| temperatures_of(state, |_| true))
}

pub(super) fn temperatures_of_a_kind(setting: &Setting) -> Cell {
    let numbers = |t: &granular_edmd::observable::Temperature| vec![t.horizontal, t.vertical, t.rotational];
    let truth = |state: &State| temperatures_of(state, |disk| disk.kind() == OTHER);
    series(setting, OfKind::new(OTHER, Temperatures), numbers, truth)
}

/// Four cells; disks alone in a cell have no temperature.
pub(super) fn temperatures_about_flow(setting: &Setting) -> Cell {
    let region = setting.region;
    let grid = Grid::new(region, 2, 2).map_err(|error| error.to_string())?;
    let half = 0.5 * (region.max - region.min);
    let truth = |state: &State| {
        let (mut sums, mut freedom) = ([0.0; 3], 0.0);
        for cell in 0..4 {
            let cell_of = |disk: &Disk| {
                let at = (disk.position() - region.min) / half;
                let is_inside = at.cmpge(DVec2::ZERO).all() && at.cmplt(DVec2::splat(2.0)).all();
                is_inside.then(|| at.x.floor() as usize + 2 * at.y.floor() as usize)
            };
            let own: Vec<&Disk> = state.disks.iter().filter(|disk| cell_of(disk) == Some(cell)).collect();
            if own.len() < 2 {
                continue;
            }
            let mass: f64 = own.iter().map(|disk| disk.mass()).sum();
            let flow = own.iter().map(|disk| disk.mass() * disk.velocity()).sum::<DVec2>() / mass;
            let inertia: f64 = own.iter().map(|disk| disk.moment_of_inertia()).sum();
            let spin = own.iter().map(|disk| disk.moment_of_inertia() * disk.angular_velocity()).sum::<f64>()
                / inertia;
            for disk in &own {
                let velocity = disk.velocity() - flow;
                sums[0] += disk.mass() * velocity.x * velocity.x;
                sums[1] += disk.mass() * velocity.y * velocity.y;
                sums[2] += disk.moment_of_inertia() * (disk.angular_velocity() - spin).powi(2);
            }
            freedom += own.len() as f64 - 1.0;
        }
        sums.map(|sum| sum / freedom).to_vec()
    };
    let numbers = |t: &granular_edmd::observable::Temperature| vec![t.horizontal, t.vertical, t.rotational];
    series(setting, TemperaturesAboutFlow::new(grid), numbers, truth)
}

pub(super) fn order_parameters(setting: &Setting) -> Cell {
    let Domain { left, right, .. } = setting.domain();
    let truth = |state: &State| {
        let angle = |disk: &Disk| TAU * (disk.position().x - left) / (right - left);
        let one = state.mean(|disk| disk.velocity().y * angle(disk).sin());
        vec![one, -state.mean(|disk| disk.velocity().y * angle(disk).cos())]
    };
    series(setting, OrderParameters, |order| vec![order.one_roll, order.two_rolls], truth)
}

/// All pairs, with all images of one of the two.
pub(super) fn hexatic_order(setting: &Setting) -> Cell {
    const RANGE: f64 = 1.3;
    let periods = setting.domain().periods();
    let truth = |state: &State| {
        let (mut local, mut global, mut pairs) = (0.0, DVec2::ZERO, 0.0);
        for (index, disk) in state.disks.iter().enumerate() {
            let (mut order, mut count) = (DVec2::ZERO, 0.0);
            for (other, partner) in state.disks.iter().enumerate() {
                for image in 0..9 {
                    let shift = DVec2::new(f64::from(image % 3 - 1), f64::from(image / 3 - 1)) * periods;
                    let is_new = (periods.x > 0.0 || image % 3 == 1) && (periods.y > 0.0 || image / 3 == 1);
                    let way = partner.position() + shift - disk.position();
                    if is_new && other != index && way.length() <= RANGE {
                        order += DVec2::from_angle(6.0 * way.y.atan2(way.x));
                        count += 1.0;
                    }
                }
            }
            order /= f64::max(count, 1.0);
            local += order.length();
            global += order;
            pairs += count;
        }
        let disks = state.disks.len() as f64;
        vec![local / disks, global.length() / disks, pairs / disks]
    };
    let order = HexaticOrder::new(RANGE).map_err(|error| error.to_string())?;
    series(setting, order, |order| vec![order.local, order.global, order.coordination], truth)
}

/// Counts of the scaled horizontal component, and the mean squares that scale it.
pub(super) fn velocity_distribution(setting: &Setting) -> Cell {
    let distribution = VelocityDistribution::new(2.0, 8).map_err(|error| error.to_string())?;
    let mut distribution = Sampled::new(distribution, every(1.0));
    let log = setting.run(&mut distribution)?;
    let mut counts = [0.0; 8];
    for state in log.samples() {
        let thermal = (state.mean(|disk| disk.mass() * disk.velocity().length_squared()) / 1.0).sqrt();
        for disk in &state.disks {
            let scaled = disk.mass().sqrt() * disk.velocity().x / thermal;
            let bin = ((scaled + 2.0) / 0.5).floor();
            if (0.0..8.0).contains(&bin) {
                counts[bin as usize] += 1.0;
            }
        }
    }
    let measured: Vec<f64> = distribution.horizontal().bins().map(|bin| bin.count as f64).collect();
    Ok(far(&measured, &counts))
}
