//! The disks of a table, with each quantity from the columns that determine it.

use std::f64::consts::PI;

use granular_edmd::boundary::Domain;
use granular_edmd::glam::DVec2;
use granular_edmd::{Disk, Kind, ParameterError};

use super::checks::{IMAGES, number, settle};
use super::column::Quantity::{
    self, Angle, AngularVelocity, Density, Diameter, Id, Image, InertiaFactor, Mass, Momentum, Name,
    Orientation, Position, Radius, Scaled, Type, Unwrapped, UnwrappedScaled, Velocity,
};
use super::column::plain;
use super::table::Table;
use super::table::{RADIUS_IGNORED, Settings};
use super::{ReadError, State, table};

/// Largest relative difference of two columns that hold the same quantity in few digits.
const ALIKE: f64 = 1e-4;

/// Largest component out of the plane, relative to the largest component in the plane.
const FLAT: f64 = 1e-9;

/// Returns the state that a table holds.
pub(super) fn state(table: Table, settings: &Settings) -> Result<State, ReadError> {
    let frame = table.binary_frame;
    state_of(table, settings).map_err(|error| match frame {
        Some(frame) => ReadError::Frame { frame, source: Box::new(error) },
        None => error,
    })
}

fn state_of(mut table: Table, settings: &Settings) -> Result<State, ReadError> {
    scale(&mut table, settings.scale);
    let mut disks = disks(&table, settings)?;
    if table.has(Id, 0) && number(&mut disks, &table.lines)? {
        table.notes.push("ids begin with 0 in the file, and are greater by 1 here".to_owned());
    }
    if table.domain.is_none()
        && table.has(Position, 0)
        && [0, 1].iter().any(|&axis| table.has(Unwrapped, axis))
    {
        table.notes.push("unwrapped positions are ignored, since the file has no box".to_owned());
    }
    let notes = given(&table, settings, &disks);
    table.notes.extend(notes);
    let is_numbered = table.has(Quantity::Kind, 0) || table.has(Type, 0);
    let ordered = table::ordered(&table).filter(|_| !is_numbered).unwrap_or_default();
    let ordered: Vec<String> = ordered.into_iter().map(str::to_owned).collect();
    let kind_names = if is_numbered { std::mem::take(&mut table.kind_names) } else { ordered };
    if !kind_names.is_empty() {
        table.notes.push(format!("kinds are numbered by name: {}", numbered(&kind_names)));
    }
    let ignored = table.ignored();
    if !ignored.is_empty() {
        table.notes.push(format!("ignored: {}", ignored.join(", ")));
    }
    let (domain, time, gravity) = (table.domain, table.time, table.gravity);
    let notes = std::mem::take(&mut table.notes);
    let mut state = State { disks, domain, time, gravity, kind_names, shrunk: 0.0, notes };
    let settings = with_rounding(settings, table.rounding, &state.disks);
    let lines = std::mem::take(&mut table.lines);
    drop(table);
    settle(&mut state, &lines, &settings)?;
    Ok(state)
}

/// Largest number of names of kinds in a note.
const MOST_NAMES: usize = 8;

/// Returns the names of kinds with their numbers; if there are many kinds, only the first ones.
fn numbered(kind_names: &[String]) -> String {
    let names = kind_names.iter().enumerate().take(MOST_NAMES);
    let mut names: Vec<String> = names.map(|(number, name)| format!("{name} {number}")).collect();
    if kind_names.len() > MOST_NAMES {
        names.push(format!("and {} others", kind_names.len() - MOST_NAMES));
    }
    names.join(", ")
}

/// Multiplies the lengths of a table's box and gravity by a factor.
fn scale(table: &mut Table, factor: f64) {
    for domain in [&mut table.domain, &mut table.extent].into_iter().flatten() {
        for edge in [&mut domain.left, &mut domain.right, &mut domain.bottom, &mut domain.top] {
            *edge *= factor;
        }
    }
    table.gravity = table.gravity.map(|gravity| (factor * gravity.acceleration()).into());
    table.rounding *= factor;
}

/// Returns the factor of a value if all lengths are multiplied by `length`.
fn factor(quantity: Quantity, length: f64, is_of_lammps: bool) -> f64 {
    match quantity {
        Position | Unwrapped | Velocity | Momentum | Radius | Diameter => length,
        Density if is_of_lammps => 1.0 / (length * length * length),
        Density => 1.0 / (length * length),
        _ => 1.0,
    }
}

/// Returns notes about settings that the file makes useless, and about masses that nobody gave.
fn given(table: &Table, settings: &Settings, disks: &[Disk]) -> Vec<String> {
    let [has_radii, has_masses] =
        [[Radius, Diameter], [Mass, Density]].map(|pair| pair.iter().any(|&it| table.has(it, 0)));
    let radii = || disks.iter().map(Disk::radius);
    let (least, most) = (radii().fold(f64::INFINITY, f64::min), radii().fold(0.0, f64::max));
    let notes = [
        (settings.radius.is_some() && has_radii && table.binary_frame.is_none(), RADIUS_IGNORED),
        (
            settings.density.is_some() && has_masses,
            "the density that was given is ignored, since the file has masses",
        ),
        (
            settings.density.is_none() && !has_masses && most > least && table.binary_frame.is_none(),
            "all masses are 1, since the file has none; a density (with_density, --density) gives them by size",
        ),
    ];
    notes.into_iter().filter(|(is_so, _)| *is_so).map(|(_, note)| note.to_owned()).collect()
}

/// Returns the settings with a tolerance for positions of few digits, if nothing else is set.
fn with_rounding(settings: &Settings, rounding: f64, disks: &[Disk]) -> Settings {
    let smallest = disks.iter().map(Disk::radius).fold(f64::INFINITY, f64::min);
    let of_rounding = (rounding > 0.0 && !settings.shrinks).then_some(rounding / smallest);
    Settings { tolerance: settings.tolerance.or(of_rounding), ..settings.clone() }
}

/// Returns the disks of a table, in its order.
fn disks(table: &Table, settings: &Settings) -> Result<Vec<Disk>, ReadError> {
    let either = |quantities: &[Quantity], axis| quantities.iter().any(|&quantity| table.has(quantity, axis));
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        if !either(&[Position, Scaled, Unwrapped, UnwrappedScaled], axis) {
            return Err(ReadError::missing(table.line, format!("the column `{name}`")));
        }
    }
    if !either(&[Radius, Diameter], 0) && settings.radius.is_none() {
        let is_size = |name: &&str| ["area", "feret"].contains(&plain(name).as_str());
        let names: Vec<&str> =
            table.columns.iter().map(|column| column.name.as_str()).filter(is_size).collect();
        let known = if names.is_empty() { String::new() } else { format!(", from {}", names.join(" or ")) };
        let what = format!("the column `radius`, or one radius for all{known} (with_radius, --radius),");
        return Err(ReadError::missing(table.line, what));
    }
    if either(&[Momentum], 0) && !either(&[Mass, Density], 0) && settings.density.is_none() {
        let what = "a column of masses, or a density (with_density, --density), for the momenta";
        return Err(ReadError::missing(table.line, what));
    }
    check_plane(table, settings)?;
    let kinds = table::kinds_of_names(table)?;
    let mut disks = Vec::with_capacity(table.lines.len());
    for (values, line) in table.rows() {
        let row = Row { slots: slots(table, values, settings.scale, line)?, table, settings, line };
        disks.push(row.disk(row.kind(&kinds)?)?);
    }
    Ok(disks)
}

/// The values of a row: the components of each quantity.
type Slots = [[Option<f64>; 4]; Image as usize + 1];

/// Returns the values of a row, indexed by slot, or an error if two columns contradict each other.
fn slots(table: &Table, values: &[f64], length: f64, line: usize) -> Result<Slots, ReadError> {
    let mut slots = Slots::default();
    for ((column, (quantity, component)), &value) in table.known().zip(values) {
        let value = value * factor(quantity, length, table.is_of_lammps);
        let Some(other) = slots[quantity as usize][component].replace(value) else { continue };
        if quantity == Name && other != value {
            let names = [other, value].map(|index| table.names()[index as usize]);
            return Err(contradiction(&column.name, &names.join(" and "), line));
        }
        // Whole numbers have no rounding.
        let is_whole = matches!(quantity, Id | Quantity::Kind | Type | Image);
        if is_whole && other != value {
            return Err(contradiction(&column.name, &format!("{other} and {value}"), line));
        }
        agree(&column.name, other, value, 0.0, line)?;
    }
    Ok(slots)
}

/// Returns the first of two values if they agree, or an error if they contradict each other.
fn agree(what: &str, one: f64, other: f64, scale: f64, line: usize) -> Result<f64, ReadError> {
    let most = ALIKE * one.abs().max(other.abs()).max(scale);
    if (one - other).abs() <= most || one.to_bits() == other.to_bits() {
        return Ok(one);
    }
    Err(contradiction(what, &format!("{one} and {other}"), line))
}

/// Creates the error of columns that contradict each other.
fn contradiction(what: &str, found: &str, line: usize) -> ReadError {
    ReadError::unexpected(line, what, "the same in all columns that give it", found)
}

/// Checks that the disks lie in one plane, move in it, and turn in it.
fn check_plane(table: &Table, settings: &Settings) -> Result<(), ReadError> {
    let largest = |quantities: &[Quantity], axes: &[usize]| {
        let slots =
            quantities.iter().flat_map(|quantity| axes.iter().filter_map(|&axis| quantity.slot(axis)));
        slots.flat_map(|slot| table.values(slot)).map(|(value, _)| value.abs()).fold(0.0, f64::max)
    };
    let size = largest(&[Radius, Diameter], &[0]).max(settings.radius.unwrap_or_default());
    let turning = largest(&[AngularVelocity], &[2]);
    let is_out = |height: f64, scale| !height.is_finite() || height.abs() > FLAT * scale;
    for (quantity, axis, scale, is_place) in [
        (Position, 2, size, true),
        (Scaled, 2, 1.0, true),
        (Unwrapped, 2, size, true),
        (UnwrappedScaled, 2, 1.0, true),
        (Velocity, 2, largest(&[Velocity], &[0, 1]), false),
        (Momentum, 2, largest(&[Momentum], &[0, 1]), false),
        (AngularVelocity, 0, turning, false),
        (AngularVelocity, 1, turning, false),
        (Orientation, 0, 1.0, false),
        (Orientation, 1, 1.0, false),
    ] {
        let values = || quantity.slot(axis).into_iter().flat_map(|slot| table.values(slot));
        let plane = values().next().filter(|_| is_place).map_or(0.0, |(value, _)| value);
        if let Some((value, line)) = values().find(|(value, _)| is_out(value - plane, scale)) {
            let [lie, stay] =
                ["the same for all disks, which lie in a plane", "0, for disks move in a plane"];
            let requirement = if is_place { lie } else { stay };
            let name = table.known().find(|(_, slot)| Some(*slot) == quantity.slot(axis));
            let name = name.map_or("", |(column, _)| &column.name);
            let requirement = format!("{requirement}{}", table.advice);
            return Err(ReadError::unexpected(line, name, requirement, value.to_string()));
        }
    }
    Ok(())
}

/// A row of a table.
struct Row<'a> {
    slots: Slots,
    table: &'a Table,
    settings: &'a Settings,
    line: usize,
}

impl Row<'_> {
    fn get(&self, quantity: Quantity, component: usize) -> Option<f64> {
        self.slots[quantity as usize][component]
    }

    /// Returns the first of two values if they agree, or the only one that is present.
    fn either(
        &self,
        what: &str,
        one: Option<f64>,
        other: Option<f64>,
        scale: f64,
    ) -> Result<Option<f64>, ReadError> {
        match (one, other) {
            (Some(one), Some(other)) => agree(what, one, other, scale, self.line).map(Some),
            _ => Ok(one.or(other)),
        }
    }

    fn disk(&self, kind: Kind) -> Result<Disk, ReadError> {
        let (radius, mass) = self.size()?;
        let [(x, right), (y, up)] = [self.place(0)?, self.place(1)?];
        let velocity = DVec2::new(self.velocity(0, mass)?, self.velocity(1, mass)?);
        let (angle, turning) = (self.angle()?, self.get(AngularVelocity, 2).unwrap_or_default());
        let inertia = self.get(InertiaFactor, 0).unwrap_or(Disk::HOMOGENEOUS_INERTIA_FACTOR);
        let disk = || -> Result<Disk, ParameterError> {
            Disk::new(DVec2::new(x, y), radius)?
                .with_velocity(velocity)?
                .with_angle(angle)?
                .with_angular_velocity(turning)?
                .with_mass(mass)?
                .with_inertia_factor(inertia)?
                .with_id(self.get(Id, 0).map_or(0, |id| id as u64))
        };
        let disk = disk().map_err(|source| ReadError::Disk { line: self.line, source })?;
        Ok(disk.with_kind(kind).with_image([right, up]))
    }

    /// Returns the radius and the mass.
    fn size(&self) -> Result<(f64, f64), ReadError> {
        let half = self.get(Diameter, 0).map(|diameter| 0.5 * diameter);
        let radius = self.either("radius", self.get(Radius, 0), half, 0.0)?.or(self.settings.radius);
        let radius = radius.unwrap_or_default();
        let area = PI * radius * radius;
        let by_density = self.get(Density, 0).map(|density| {
            if self.table.is_of_lammps { sphere_mass(density, radius) } else { density * area }
        });
        let mass = self.either("mass", self.get(Mass, 0), by_density, 0.0)?;
        let mass = mass.or_else(|| self.settings.density.map(|density| density * area));
        Ok((radius, mass.unwrap_or(1.0)))
    }

    /// Returns a coordinate, and the number of periods that the disk has crossed along this axis.
    fn place(&self, axis: usize) -> Result<(f64, i32), ReadError> {
        let name = ["x", "y"][axis];
        let along = |domain: Domain| match axis {
            0 => (domain.left, domain.width(), domain.periods().x),
            _ => (domain.bottom, domain.height(), domain.periods().y),
        };
        let (low, length, _) = self.table.extent.or(self.table.domain).map(along).unwrap_or_default();
        let is_known = length > 0.0 && length.is_finite();
        let scaled = |quantity| match self.get(quantity, axis) {
            Some(_) if !is_known => Err(ReadError::missing(self.line, "the box of scaled positions")),
            share => Ok(share.map(|share| low + share * length)),
        };
        let scale = if is_known { length } else { 0.0 };
        let here = self.either(name, self.get(Position, axis), scaled(Scaled)?, scale)?;
        let far = self.either(name, self.get(Unwrapped, axis), scaled(UnwrappedScaled)?, scale)?;
        let image = self.get(Image, axis);
        let period = self.table.domain.map_or(0.0, |domain| along(domain).2);
        let (place, image) = match (here, far) {
            (Some(here), Some(far)) if self.table.domain.is_some() => {
                let passed = if period > 0.0 { ((far - here) / period).round() } else { 0.0 };
                let passed = image.unwrap_or(passed);
                agree(name, here + period * passed, far, scale, self.line)?;
                (here, passed)
            }
            (None, Some(far)) if period > 0.0 => {
                let passed = image.unwrap_or_else(|| ((far - low) / period).floor());
                (far - period * passed, passed)
            }
            _ => (here.or(far).unwrap_or_default(), image.unwrap_or_default()),
        };
        if !IMAGES.contains(&image) {
            return Err(ReadError::unexpected(self.line, "image", "below 2^31", image.to_string()));
        }
        Ok((place, image as i32))
    }

    /// Returns a component of the velocity.
    fn velocity(&self, axis: usize, mass: f64) -> Result<f64, ReadError> {
        let by_momentum = self.get(Momentum, axis).map(|momentum| momentum / mass);
        Ok(self.either("velocity", self.get(Velocity, axis), by_momentum, 0.0)?.unwrap_or_default())
    }

    /// Returns the angle. An orientation alone determines it only up to whole turns.
    fn angle(&self) -> Result<f64, ReadError> {
        let half = match (self.get(Orientation, 2), self.get(Orientation, 3)) {
            (Some(z), Some(w)) => Some(libm::atan2(z, w)),
            _ => None,
        };
        let Some(angle) = self.get(Angle, 0) else { return Ok(half.map_or(0.0, |half| 2.0 * half)) };
        // An angle of many turns has few digits left for its position within a turn. The writer
        // computed the orientation from the sine and cosine of half the angle, so these are compared.
        let (sin, cos) = (libm::sin(0.5 * angle), libm::cos(0.5 * angle));
        if half.is_none_or(|half| (libm::sin(half) * cos - libm::cos(half) * sin).abs() < ALIKE) {
            return Ok(angle);
        }
        Err(contradiction("angle", &format!("{angle}, and another one in the orientation"), self.line))
    }

    /// Returns the kind: from its number if possible, or else from a type, or else from a name.
    fn kind(&self, names: &[u16]) -> Result<Kind, ReadError> {
        let least = f64::from(u8::from(self.table.is_of_lammps));
        let (what, number, least) = match (self.get(Quantity::Kind, 0), self.get(Type, 0), self.get(Name, 0))
        {
            (Some(kind), ..) => ("kind", kind, 0.0),
            (_, Some(kind), _) => ("type", kind, least),
            (.., Some(name)) => ("name", names.get(name as usize).copied().unwrap_or_default().into(), 0.0),
            _ => return Ok(Kind::DEFAULT),
        };
        let most = least + f64::from(u16::MAX);
        if number.fract() == 0.0 && (least..=most).contains(&number) {
            return Ok(Kind::new((number - least) as u16));
        }
        let requirement = format!("from {least} to {most}");
        Err(ReadError::unexpected(self.line, what, requirement, number.to_string()))
    }
}

/// Returns the mass of a sphere, with the operations in the same order as in LAMMPS.
pub(super) fn sphere_mass(density: f64, radius: f64) -> f64 {
    4.0 * PI / 3.0 * radius * radius * radius * density
}
