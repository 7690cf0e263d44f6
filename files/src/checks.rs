//! Checks of the disks of a file against each other and against their box.

use super::found::Settings;
use super::overlap::{self, Overlap};
use super::{ReadError, State};
use granular_edmd::Disk;
use granular_edmd::boundary::Domain;

/// Largest overlap that a simulation still counts as touching, relative to the sum of the radii.
const TOUCHING: f64 = 1e-10;

/// Checks the disks of a state, with the lines from which they were read.
///
/// Disks outside of periodic sides are moved into the box. If the settings say so, radii shrink until no
/// disks overlap; otherwise none may overlap by more than the tolerance.
pub(super) fn settle(state: &mut State, lines: &[usize], settings: &Settings) -> Result<(), ReadError> {
    let accepted = settings.tolerance.unwrap_or_default().max(TOUCHING);
    if let Some(domain) = state.domain {
        for (disk, &line) in state.disks.iter_mut().zip(lines) {
            fit(disk, &domain, line)?;
            state.wrapped += usize::from(enter(disk, &domain, accepted, line)?);
        }
    }
    let least = if settings.shrinks { TOUCHING } else { accepted };
    let Some(found) = overlap::deepest(&state.disks, state.domain.as_ref(), least) else { return Ok(()) };
    let Overlap { pair: [a, b], depth, share, count, is_counted } = found;
    let is_small = share <= DEEPEST && settings.tolerance.is_none_or(|tolerance| share <= tolerance);
    if !(settings.shrinks && is_small && is_counted) {
        let [line, other] = [lines[a].max(lines[b]), lines[a].min(lines[b])];
        let advice = advice(share, settings);
        return Err(ReadError::Overlap { line, other, depth, share, count, advice });
    }
    for (disk, &line) in state.disks.iter_mut().zip(lines) {
        *disk = disk
            .with_radius(disk.radius() * (1.0 - share))
            .map_err(|source| ReadError::Disk { line, source })?;
    }
    state.shrunk = share;
    Ok(())
}

/// Deepest overlap for which radii shrink, as a share of the sum of the radii.
const DEEPEST: f64 = 0.5;

/// Returns the settings that accept overlaps as deep as this.
fn advice(share: f64, settings: &Settings) -> &'static str {
    match (settings.tolerance, settings.shrinks) {
        _ if share > DEEPEST => "two disks lie nearly at the same place",
        (_, false) => "set a tolerance or shrink the radii to accept them",
        (Some(_), true) => "a larger tolerance accepts them",
        (None, true) => "there are too many of them to shrink radii",
    }
}

/// Checks that no id appears twice. Ids that count from 0 are raised by 1, since the id 0 means that a disk
/// has no id.
pub(super) fn number(disks: &mut [Disk], lines: &[usize]) -> Result<bool, ReadError> {
    let mut order: Vec<usize> = (0..disks.len()).collect();
    order.sort_by_key(|&index| disks[index].id());
    if let Some(pair) = order.windows(2).find(|pair| disks[pair[0]].id() == disks[pair[1]].id()) {
        let (first, line, id) = (lines[pair[0]], lines[pair[1]], disks[pair[0]].id());
        return Err(ReadError::Doubled { line, first, what: format!("the disk {id}") });
    }
    let has_zero = order.first().is_some_and(|&index| disks[index].id() == 0);
    if has_zero {
        for (disk, &line) in disks.iter_mut().zip(lines) {
            *disk = disk.with_id(disk.id() + 1).map_err(|source| ReadError::Disk { line, source })?;
        }
    }
    Ok(has_zero)
}

/// Checks that a disk does not overlap its own images.
fn fit(disk: &Disk, domain: &Domain, line: usize) -> Result<(), ReadError> {
    let (width, periods) = (2.0 * disk.radius(), domain.periods().to_array());
    let is_narrow = |period: &f64| *period > 0.0 && width > period * (1.0 + TOUCHING);
    let Some(period) = periods.into_iter().find(is_narrow) else { return Ok(()) };
    let requirement = format!("at most {period}, a period of the box");
    Err(ReadError::unexpected(line, "the diameter of the disk", requirement, width.to_string()))
}

/// Numbers of periods that a disk can have passed.
pub(super) const IMAGES: std::ops::RangeInclusive<f64> = -2_147_483_648.0..=2_147_483_647.0;

/// Moves a disk into its box by whole periods, and returns whether it was outside.
fn enter(disk: &mut Disk, domain: &Domain, accepted: f64, line: usize) -> Result<bool, ReadError> {
    if domain.contains(disk.position(), TOUCHING * disk.radius()) {
        return Ok(false);
    }
    let place = domain.wrapped(disk.position());
    let outside = ReadError::Outside { line, x: disk.position().x, y: disk.position().y };
    if !domain.contains(place, accepted * disk.radius()) {
        return Err(outside);
    }
    let periods = domain.periods();
    let passed = |axis: usize| {
        let moved = disk.position()[axis] - place[axis];
        let passed = if periods[axis] > 0.0 { (moved / periods[axis]).round() } else { 0.0 };
        let image = f64::from(disk.image()[axis]) + passed;
        IMAGES.contains(&image).then_some(image as i32)
    };
    let (Some(right), Some(up)) = (passed(0), passed(1)) else { return Err(outside) };
    let moved = disk.with_position(place).map_err(|source| ReadError::Disk { line, source })?;
    let was_outside = [right, up] != disk.image();
    *disk = moved.with_image([right, up]);
    Ok(was_outside)
}
