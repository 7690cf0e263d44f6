//! Measures of collisions, counted anew.

use granular_edmd::Kind;
use granular_edmd::observable::{
    Arrivals, BetweenKinds, Collision, CollisionCounts, CollisionHistograms, EnergyChange,
    EnergyChangeProfile, Partner, Sampled, WallStress,
};

use super::areas::is_with;
use super::log::Log;
use super::systems::{OTHER, Setting, every};
use super::{Cell, far, told};

#[expect(clippy::trivially_copy_pass_by_ref, reason = "it is a filter of references")]
fn is_of_disks(collision: &&Collision) -> bool {
    matches!(collision.partner, Partner::Disk(_))
}

/// Returns the number and the mean energy change of some collisions.
fn change<'a>(collisions: impl Iterator<Item = &'a Collision>) -> [f64; 2] {
    let (count, sum) = collisions.fold((0.0, 0.0), |(n, sum), one| (n + 1.0, sum + one.energy_change));
    [count, if count > 0.0 { sum / count } else { 0.0 }]
}

pub(super) fn energy_change(setting: &Setting) -> Cell {
    let mut measured = EnergyChange::default();
    let Log { collisions, .. } = setting.run(&mut measured)?;
    let of = |mean: &granular_edmd::statistics::BlockedMean| {
        [mean.count() as f64, if mean.count() > 0 { mean.mean() } else { 0.0 }]
    };
    let disks = far(&of(measured.disks()), &change(collisions.iter().filter(is_of_disks)));
    let floor = change(collisions.iter().filter(|one| is_with(one.partner, 0)));
    Ok(disks.max(far(&of(measured.wall("floor")), &floor)))
}

pub(super) fn energy_change_between_kinds(setting: &Setting) -> Cell {
    let mut measured = BetweenKinds::new(Kind::DEFAULT, OTHER, EnergyChange::default());
    let log = setting.run(&mut measured)?;
    let is_mixed = |one: &&Collision| {
        let [first, second] = one.contact.kinds();
        (first == OTHER) != (second == OTHER) && (first == Kind::DEFAULT || second == Kind::DEFAULT)
    };
    let truth = change(log.collisions.iter().filter(is_of_disks).filter(is_mixed));
    let mean = measured.inner().disks();
    let mean = [mean.count() as f64, if mean.count() > 0 { mean.mean() } else { 0.0 }];
    Ok(far(&mean, &truth))
}

pub(super) fn energy_change_profile(setting: &Setting) -> Cell {
    let (low, high) = (setting.region.min.y, setting.region.max.y);
    let profile = EnergyChangeProfile::new(low, high, 4).map_err(told)?;
    let mut profile = Sampled::new(profile, every(1.0));
    let log = setting.run(&mut profile)?;
    let step = (high - low) / 4.0;
    let mut worst: f64 = 0.0;
    for (number, layer) in profile.layers().iter().enumerate() {
        let bottom = low + step * number as f64;
        let is_inside = |height: f64| height >= bottom && height < bottom + step;
        let in_layer = log.collisions.iter().filter(is_of_disks).filter(|one| is_inside(one.position.y));
        let disks: Vec<_> = log
            .samples()
            .flat_map(|state| &state.disks)
            .filter(|disk| is_inside(disk.position().y))
            .collect();
        if disks.is_empty() {
            assert_eq!(layer.translational_temperature.count(), 0);
            continue;
        }
        let energy: f64 = disks.iter().map(|disk| 0.5 * disk.mass() * disk.velocity().length_squared()).sum();
        let [count, mean] = change(in_layer);
        let own = &layer.energy_change;
        let own = [own.count() as f64, if own.count() > 0 { own.mean() } else { 0.0 }];
        let temperature = [layer.translational_temperature.mean()];
        worst = worst.max(far(&own, &[count, mean])).max(far(&temperature, &[energy / disks.len() as f64]));
    }
    Ok(worst)
}

pub(super) fn collision_counts(setting: &Setting) -> Cell {
    let mut counts = CollisionCounts::default();
    let Log { collisions, .. } = setting.run(&mut counts)?;
    let disks = collisions.iter().filter(is_of_disks).count();
    let floor = collisions.iter().filter(|one| is_with(one.partner, 0)).count();
    let all = [counts.disk_collisions(), counts.wall_collisions(), counts.collisions_with_wall("floor")];
    let truth = [disks, collisions.len() - disks, floor];
    Ok(far(&all.map(|count| count as f64), &truth.map(|count| count as f64)))
}

pub(super) fn collision_histograms(setting: &Setting) -> Cell {
    let mut histograms = CollisionHistograms::new(4.0, 4.0, 8).map_err(told)?;
    let log = setting.run(&mut histograms)?;
    let mut counts = [[0.0; 8]; 2];
    for collision in log.collisions.iter().filter(is_of_disks) {
        for (counts, value) in
            counts.iter_mut().zip([collision.contact.closing_speed(), collision.impulse.normal()])
        {
            if (0.0..4.0).contains(&value) {
                counts[(2.0 * value) as usize] += 1.0;
            }
        }
    }
    let measured = [histograms.closing_speed(), histograms.impulse()]
        .map(|histogram| histogram.bins().map(|bin| bin.count as f64).collect::<Vec<f64>>());
    Ok(far(&measured[0], &counts[0]).max(far(&measured[1], &counts[1])))
}

pub(super) fn arrivals(setting: &Setting) -> Cell {
    let mut arrivals = Arrivals::at(["floor"], every(1.0));
    let log = setting.run(&mut arrivals)?;
    let truth: Vec<f64> = log
        .intervals()
        .map(|(_, collisions)| collisions.iter().filter(|one| is_with(one.partner, 0)).count() as f64)
        .collect();
    let counts: Vec<f64> = arrivals.counts().iter().map(|&count| count as f64).collect();
    Ok(far(&counts, &truth))
}

pub(super) fn wall_stress(setting: &Setting) -> Cell {
    const LENGTH: f64 = 7.0;
    let mut stress = WallStress::new(every(1.0)).with_wall("floor", LENGTH).map_err(told)?;
    let log = setting.run(&mut stress)?;
    let (mut impulse, mut intervals) = ([0.0; 2], 0.0);
    for (_, collisions) in log.intervals() {
        for collision in collisions.iter().filter(|one| is_with(one.partner, 0)) {
            impulse[0] += collision.impulse.normal();
            impulse[1] -= collision.impulse.tangential();
        }
        intervals += 1.0;
    }
    let measured = [stress.pressure("floor"), stress.shear("floor")]
        .map(|mean| mean.map_or(f64::NAN, |mean| mean.mean()));
    Ok(far(&measured, &impulse.map(|sum| sum / (LENGTH * intervals))))
}
