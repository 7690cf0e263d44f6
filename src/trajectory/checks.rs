//! Checks of the disks of a file among each other and against their box.

use std::collections::HashMap;

use super::overlap::{self, Overlap};
use super::settings::Settings;
use super::{ReadError, State};
use crate::boundary::Domain;
use crate::disk::TOUCHING;
use crate::{Disk, ParameterError};

/// A disk of a file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub(super) line: usize,
    pub(super) id: Option<u64>,
    pub(super) disk: Disk,
}

/// Puts the disks into a state, with their ids, if no id appears twice, none is outside the box, and none
/// overlaps another by more than the settings accept.
pub(super) fn settle(
    mut entries: Vec<Entry>,
    settings: &Settings,
    state: &mut State,
) -> Result<(), ReadError> {
    number(&mut entries, state)?;
    if let Some(domain) = state.domain {
        for entry in &mut entries {
            state.wrapped += usize::from(enter(entry, &domain, settings)?);
        }
    }
    let disks: Vec<Disk> = entries.iter().map(|entry| entry.disk).collect();
    let accepted = settings.tolerance.unwrap_or_default().max(TOUCHING);
    let found =
        overlap::deepest(&disks, state.domain.as_ref(), if settings.shrinks { TOUCHING } else { accepted });
    let limit = match settings.tolerance {
        None if settings.shrinks => 1.0,
        _ => accepted,
    };
    state.disks = match found {
        None => disks,
        Some(Overlap { share, is_counted: true, .. }) if settings.shrinks && share < limit.min(1.0) => {
            state.shrunk = share;
            let shrunk = entries.iter().map(|entry| shrunk(&entry.disk, share).map_err(entry.refused()));
            shrunk.collect::<Result<_, _>>()?
        }
        Some(Overlap { pair: [a, b], depth, share, count, .. }) => {
            let lines = [entries[a].line, entries[b].line];
            let [line, other] = [lines[0].max(lines[1]), lines[0].min(lines[1])];
            return Err(ReadError::Overlap { line, other, depth, share, count });
        }
    };
    Ok(())
}

impl Entry {
    /// Returns a function that adds the line to an error.
    fn refused(&self) -> impl FnOnce(ParameterError) -> ReadError + use<> {
        let line = self.line;
        move |source| ReadError::Disk { line, source }
    }
}

/// Gives the disks the ids of the file, which must differ. Ids from 0 on become ids from 1 on, for a disk
/// without an id has the id 0.
fn number(entries: &mut [Entry], state: &mut State) -> Result<(), ReadError> {
    let mut lines = HashMap::new();
    let first = u64::from(entries.iter().any(|entry| entry.id == Some(0)));
    for entry in entries {
        let Some(id) = entry.id else { continue };
        if let Some(first) = lines.insert(id, entry.line) {
            return Err(ReadError::Doubled { line: entry.line, first, what: format!("the disk {id}") });
        }
        entry.disk = entry.disk.with_id(id + first).map_err(entry.refused())?;
    }
    if first > 0 {
        state.notes.push("ids begin with 0 in the file, and are greater by 1 here".to_owned());
    }
    Ok(())
}

/// Moves a disk into its box by whole periods, and returns whether it was outside.
fn enter(entry: &mut Entry, domain: &Domain, settings: &Settings) -> Result<bool, ReadError> {
    let disk = entry.disk;
    let slack = disk.radius() * settings.tolerance.unwrap_or_default().max(TOUCHING);
    if domain.contains(disk.position(), slack) {
        return Ok(false);
    }
    let place = domain.wrapped(disk.position());
    let outside = ReadError::Outside { line: entry.line, x: disk.position().x, y: disk.position().y };
    if !domain.contains(place, slack) {
        return Err(outside);
    }
    let periods = domain.periods();
    let passed = |axis: usize| {
        let moved = disk.position()[axis] - place[axis];
        let passed = if periods[axis] > 0.0 { (moved / periods[axis]).round() } else { 0.0 };
        let image = f64::from(disk.image()[axis]) + passed;
        (image.abs() < f64::from(i32::MAX)).then_some(image as i32)
    };
    let (Some(right), Some(up)) = (passed(0), passed(1)) else { return Err(outside) };
    let moved = disk.with_position(place).map_err(entry.refused())?;
    entry.disk = moved.with_image([right, up]);
    Ok(true)
}

/// Returns a disk whose radius is smaller by this share.
fn shrunk(disk: &Disk, share: f64) -> Result<Disk, ParameterError> {
    Disk::new(disk.position(), disk.radius() * (1.0 - share))?
        .with_velocity(disk.velocity())?
        .with_angle(disk.angle())?
        .with_angular_velocity(disk.angular_velocity())?
        .with_mass(disk.mass())?
        .with_inertia_factor(disk.inertia_factor())?
        .with_id(disk.id())
        .map(|small| small.with_kind(disk.kind()).with_image(disk.image()))
}
