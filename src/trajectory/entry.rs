//! Disks of a file, with the numbers of their lines.

use glam::DVec2;

use super::ReadError;
use super::lines::{number, whole};
use super::overlap;
use crate::boundary::Domain;
use crate::disk::TOUCHING;
use crate::{Disk, Kind, ParameterError};

/// A column of a file, which gives one property of a disk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Field {
    Id,
    Kind,
    X,
    Y,
    VelocityX,
    VelocityY,
    Angle,
    AngularVelocity,
    Radius,
    Mass,
    InertiaFactor,
    ImageX,
    ImageY,
    /// A third component, which must be 0.
    Zero,
    /// A column that no property of a disk belongs to.
    Other,
}

impl Field {
    /// Columns by their names in tables.
    pub(super) const NAMED: [(&'static str, Self); 13] = [
        ("id", Self::Id),
        ("kind", Self::Kind),
        ("x", Self::X),
        ("y", Self::Y),
        ("vx", Self::VelocityX),
        ("vy", Self::VelocityY),
        ("angle", Self::Angle),
        ("angular_velocity", Self::AngularVelocity),
        ("radius", Self::Radius),
        ("mass", Self::Mass),
        ("inertia_factor", Self::InertiaFactor),
        ("image_x", Self::ImageX),
        ("image_y", Self::ImageY),
    ];

    fn name(self) -> &'static str {
        let named = Self::NAMED.iter().find(|(_, field)| *field == self);
        named.map_or("third component", |(name, _)| name)
    }
}

/// The columns of the disks in a file.
#[derive(Debug)]
pub(super) struct Columns(Vec<Field>);

impl Columns {
    /// Checks that the columns are enough for a disk, and that none appears twice.
    pub(super) fn new(fields: Vec<Field>, line: usize) -> Result<Self, ReadError> {
        for needed in [Field::X, Field::Y, Field::Radius] {
            if !fields.contains(&needed) {
                return Err(ReadError::missing(line, format!("the column `{}`", needed.name())));
            }
        }
        for (_, field) in Field::NAMED {
            if fields.iter().filter(|&&other| other == field).count() > 1 {
                let what = format!("the column `{}`", field.name());
                return Err(ReadError::Doubled { line, first: line, what });
            }
        }
        Ok(Self(fields))
    }

    /// Reads a disk from the cells of its line.
    pub(super) fn entry<'a>(
        &self,
        cells: impl Iterator<Item = &'a str>,
        line: usize,
    ) -> Result<Entry, ReadError> {
        let cells: Vec<&str> = cells.collect();
        if cells.len() != self.0.len() {
            let (requirement, found) = (format!("{}, one for each column", self.0.len()), cells.len());
            return Err(ReadError::unexpected(line, "the number of values", requirement, found.to_string()));
        }
        let mut draft = Draft::default();
        self.0.iter().zip(cells).try_for_each(|(&field, cell)| draft.set(field, cell, line))?;
        draft.entry(line)
    }
}

/// A disk that is being read.
#[derive(Debug, Default)]
pub(super) struct Draft {
    pub(super) id: Option<u64>,
    pub(super) kind: Kind,
    pub(super) position: DVec2,
    pub(super) velocity: DVec2,
    pub(super) angle: f64,
    pub(super) angular_velocity: f64,
    pub(super) radius: f64,
    pub(super) mass: Option<f64>,
    pub(super) inertia_factor: Option<f64>,
    pub(super) image: [i32; 2],
}

impl Draft {
    fn set(&mut self, field: Field, cell: &str, line: usize) -> Result<(), ReadError> {
        let name = field.name();
        let target = match field {
            Field::Id => {
                self.id = Some(whole(name, cell, line)?);
                return Ok(());
            }
            Field::Kind => {
                self.kind = Kind::new(whole(name, cell, line)?);
                return Ok(());
            }
            Field::ImageX | Field::ImageY => {
                self.image[usize::from(field == Field::ImageY)] = whole(name, cell, line)?;
                return Ok(());
            }
            Field::Zero => return flat(cell, line),
            Field::Other => return Ok(()),
            Field::X => &mut self.position.x,
            Field::Y => &mut self.position.y,
            Field::VelocityX => &mut self.velocity.x,
            Field::VelocityY => &mut self.velocity.y,
            Field::Angle => &mut self.angle,
            Field::AngularVelocity => &mut self.angular_velocity,
            Field::Radius => &mut self.radius,
            Field::Mass => self.mass.get_or_insert_default(),
            Field::InertiaFactor => self.inertia_factor.get_or_insert_default(),
        };
        *target = number(name, cell, line)?;
        Ok(())
    }

    pub(super) fn entry(self, line: usize) -> Result<Entry, ReadError> {
        let id = self.id;
        let disk = self.disk().map_err(|source| ReadError::Disk { line, source })?;
        Ok(Entry { line, id, disk })
    }

    fn disk(self) -> Result<Disk, ParameterError> {
        let disk = Disk::new(self.position, self.radius)?
            .with_velocity(self.velocity)?
            .with_angle(self.angle)?
            .with_angular_velocity(self.angular_velocity)?
            .with_mass(self.mass.unwrap_or(1.0))?
            .with_inertia_factor(self.inertia_factor.unwrap_or(Disk::HOMOGENEOUS_INERTIA_FACTOR))?
            .with_id(self.id.unwrap_or(0))?;
        Ok(disk.with_kind(self.kind).with_image(self.image))
    }
}

/// Checks that a component out of the plane of the disks is 0.
pub(super) fn flat(cell: &str, line: usize) -> Result<(), ReadError> {
    if number("third component", cell, line)? == 0.0 {
        return Ok(());
    }
    Err(ReadError::unexpected(line, "the third component", "0, for disks lie in a plane", cell))
}

/// A disk of a file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub(super) line: usize,
    pub(super) id: Option<u64>,
    pub(super) disk: Disk,
}

impl Entry {
    /// Returns the disks in the order of their ids, if no id appears twice, no disk is outside the box, and
    /// none overlaps another.
    pub(super) fn checked(mut entries: Vec<Self>, domain: Option<&Domain>) -> Result<Vec<Disk>, ReadError> {
        entries.sort_by_key(|entry| entry.id);
        for pair in entries.windows(2) {
            let [first, second] = [pair[0].line.min(pair[1].line), pair[0].line.max(pair[1].line)];
            if let Some(id) = pair[0].id.filter(|&id| pair[1].id == Some(id)) {
                return Err(ReadError::Doubled { line: second, first, what: format!("the disk {id}") });
            }
        }
        let disks: Vec<Disk> = entries.iter().map(|entry| entry.disk).collect();
        if let Some(out) = domain.and_then(|domain| entries.iter().find(|entry| entry.is_outside(domain))) {
            let DVec2 { x, y } = out.disk.position();
            return Err(ReadError::Outside { line: out.line, x, y });
        }
        match overlap::first(&disks, domain) {
            None => Ok(disks),
            Some((a, b, depth)) => {
                let (line, other) =
                    (entries[a].line.max(entries[b].line), entries[a].line.min(entries[b].line));
                Err(ReadError::Overlap { line, other, depth })
            }
        }
    }

    /// Returns true if the center is outside a box by more than rounding.
    fn is_outside(&self, domain: &Domain) -> bool {
        !domain.contains(self.disk.position(), TOUCHING * self.disk.radius())
    }
}
