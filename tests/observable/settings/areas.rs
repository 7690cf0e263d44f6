//! Measures that divide by an area: profiles, fields, pairs and stresses.

use std::f64::consts::PI;

use granular_edmd::boundary::Region;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    Fields, Grid, HeightProfile, PairCorrelation, Partner, Sampled, Stress, StressTensor,
};

use oracles::area_between;

use super::systems::{Setting, every};
use super::{Cell, far, told};

/// Layers of height 1, with the areas of the disks between two heights by many chords.
pub(super) fn height_profile(setting: &Setting) -> Cell {
    let (low, high) = (setting.region.min.y, setting.region.max.y);
    let mut profile = Sampled::new(HeightProfile::new(low, high, 5).map_err(told)?, every(1.0));
    let log = setting.run(&mut profile)?;
    let (domain, step) = (setting.domain(), (high - low) / 5.0);
    let mut worst: f64 = 0.0;
    for (layer, (_, measured)) in profile.iter().enumerate() {
        let bottom = low + step * layer as f64;
        let mut area = 0.0;
        for disk in log.samples().flat_map(|state| &state.disks) {
            area += area_between(disk, &domain, bottom, bottom + step);
        }
        let region = Region::new(DVec2::new(domain.left, bottom), DVec2::new(domain.right, bottom + step));
        let free = setting.mean_area(&region, log.samples()) * log.samples().count() as f64;
        worst = worst.max(far(&[measured], &[area / free]));
    }
    Ok(worst)
}

/// Cells that walls cut in many ways.
pub(super) fn fields(setting: &Setting) -> Cell {
    let grid = Grid::new(setting.region, 3, 4).map_err(told)?;
    let mut fields = Sampled::new(Fields::new(grid), every(1.0));
    let log = setting.run(&mut fields)?;
    let (size, samples) = (grid.cell_size(), log.samples().count() as f64);
    let mut worst: f64 = 0.0;
    for cell in fields.iter() {
        let region = Region::new(cell.center - 0.5 * size, cell.center + 0.5 * size);
        let is_inside = |place: DVec2| place.cmpge(region.min).all() && place.cmplt(region.max).all();
        let own: Vec<_> =
            log.samples().flat_map(|state| &state.disks).filter(|disk| is_inside(disk.position())).collect();
        let free = samples * setting.mean_area(&region, log.samples());
        if own.is_empty() {
            worst = worst.max(cell.number_density);
            continue;
        }
        let area: f64 = own.iter().map(|disk| PI * disk.radius().powi(2)).sum();
        let mass: f64 = own.iter().map(|disk| disk.mass()).sum();
        let flow = own.iter().map(|disk| disk.mass() * disk.velocity()).sum::<DVec2>() / mass;
        let about = |axis: usize| -> f64 {
            own.iter().map(|disk| disk.mass() * (disk.velocity()[axis] - flow[axis]).powi(2)).sum()
        };
        let temperature = 0.5 * (about(0) + about(1)) / own.len() as f64;
        let measured =
            [cell.number_density, cell.packing_fraction, cell.velocity.x, cell.translational_temperature];
        worst = worst.max(far(&measured, &[own.len() as f64 / free, area / free, flow.x, temperature]));
    }
    Ok(worst)
}

/// All pairs around the disks in the bulk, over the pairs that a gas of as many disks without correlations
/// would have.
pub(super) fn pair_correlation(setting: &Setting) -> Cell {
    let correlation =
        PairCorrelation::new(1.5, 6).and_then(|pairs| pairs.within(setting.bulk)).map_err(told)?;
    let mut correlation = Sampled::new(correlation, every(1.0));
    let log = setting.run(&mut correlation)?;
    let (domain, Region { min, max, .. }) = (setting.domain(), setting.bulk);
    let is_inside = |place: DVec2| place.cmpge(min).all() && place.cmplt(max).all();
    let (mut pairs, mut expected, samples) = ([0.0; 6], [0.0; 4], log.samples().count() as f64);
    for state in log.samples() {
        let all = state.disks.len() as f64;
        let centers = state.disks.iter().filter(|disk| is_inside(disk.position())).count() as f64;
        for disk in state.disks.iter().filter(|disk| is_inside(disk.position())) {
            for other in state.disks.iter().filter(|other| other.id() != disk.id()) {
                let distance = domain.separation(disk.position(), other.position()).length();
                if distance < 1.5 {
                    pairs[(distance / 0.25) as usize] += 1.0 / samples;
                }
            }
        }
        let terms = [centers, centers * (1.0 - 1.0 / all), all * (all - 1.0), all];
        expected.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term / samples);
    }
    let [centers, partners, in_pairs, all] = expected;
    let density = partners / ((max.x - min.x) * (max.y - min.y)) * in_pairs / (all * (all - 1.0));
    let truth: Vec<f64> = pairs
        .iter()
        .enumerate()
        .map(|(bin, pairs)| {
            let shell = PI * 0.0625 * (2.0 * bin as f64 + 1.0);
            pairs / (centers * density * shell)
        })
        .collect();
    let measured: Vec<f64> = correlation.iter().map(|(_, value)| value.mean()).collect();
    Ok(far(&measured, &truth))
}

/// The momentum that disks carry and collisions transfer, over the free area, in whole intervals.
pub(super) fn stress(setting: &Setting) -> Cell {
    let is_open = setting.domain().top.is_infinite();
    let mut stress = Stress::new(every(1.0));
    if is_open {
        stress = stress.within(setting.bulk).map_err(told)?;
    }
    let log = setting.run(&mut stress)?;
    let is_inside = |place: DVec2| {
        !is_open || (place.cmpge(setting.bulk.min).all() && place.cmplt(setting.bulk.max).all())
    };
    let region = if is_open { setting.bulk } else { whole(setting) };
    let rest = setting.mean_area(&region, log.samples().take(1));
    let (mut sum, mut count) = ([0.0; 4], 0.0);
    for (state, collisions) in log.intervals() {
        let area = if setting.walls_move { setting.free_area(&region, state) } else { rest };
        let mut add = |one: DVec2, other: DVec2| {
            let parts = [one.x * other.x, one.x * other.y, one.y * other.x, one.y * other.y];
            sum.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part / area);
        };
        for disk in state.disks.iter().filter(|disk| is_inside(disk.position())) {
            add(disk.mass() * disk.velocity(), disk.velocity());
        }
        for collision in collisions {
            const STEPS: u32 = 1000;
            let way = collision.normal * collision.distance;
            let inside = (0..STEPS)
                .filter(|&step| {
                    let share = (f64::from(step) + 0.5) / f64::from(STEPS);
                    is_inside(collision.partner_position() + share * way)
                })
                .count();
            let tangential = collision.normal.perp() * collision.impulse.tangential();
            let kick = collision.normal * collision.impulse.normal() + tangential;
            add(kick, way * (inside as f64 / f64::from(STEPS)));
        }
        count += 1.0;
    }
    let StressTensor { xx, xy, yx, yy, pressure, .. } = stress.tensor();
    let [a, b, c, d] = sum.map(|sum| sum / count);
    // The shear is a small difference of large terms.
    let (measured, truth) = ([xx, yy, pressure].map(|part| part.mean()), [a, d, 0.5 * (a + d)]);
    let shear = [xy.mean() - b, yx.mean() - c].map(|error| (error / pressure.mean()).abs());
    Ok(far(&measured, &truth).max(shear[0]).max(shear[1]))
}

fn whole(setting: &Setting) -> Region {
    let domain = setting.domain();
    Region::new(DVec2::new(domain.left, domain.bottom), DVec2::new(domain.right, domain.top))
}

/// Returns whether a collision is one with this wall.
pub(super) fn is_with(partner: Partner, wall: usize) -> bool {
    partner == Partner::Wall(wall)
}
