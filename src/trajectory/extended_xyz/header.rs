//! The keys of a frame of extended XYZ.

use std::collections::HashMap;

use glam::DVec2;

use crate::Gravity;
use crate::boundary::Domain;
use crate::trajectory::ReadError;
use crate::trajectory::entry::{Columns, Field};
use crate::trajectory::lines::{checked_box, finite, number};

/// The keys of a frame that the reader needs.
pub(super) struct Header {
    pub(super) columns: Columns,
    pub(super) time: Option<f64>,
    pub(super) gravity: Option<Gravity>,
    pub(super) domain: Option<Domain>,
}

/// Most columns of a disk. A few letters can ask for any number of them.
const MOST_COLUMNS: usize = 1000;

impl Header {
    /// Reads the keys from their line.
    pub(super) fn parse(keys: &str, line: usize) -> Result<Self, ReadError> {
        let keys = Keys::parse(keys, line)?;
        let one = |key| keys.value(key).map(|value| finite(key, value, line)).transpose();
        let properties = keys.value("Properties").ok_or_else(|| ReadError::missing(line, "`Properties`"))?;
        Ok(Self {
            columns: Columns::new(fields(properties, line)?, line)?,
            time: one("Time")?,
            gravity: keys.value("Gravity").map(|value| gravity(value, line)).transpose()?,
            domain: domain(&keys, line)?,
        })
    }
}

/// Reads gravity: a number that points down, or the acceleration.
fn gravity(value: &str, line: usize) -> Result<Gravity, ReadError> {
    if !value.contains(' ') {
        return Ok(finite("Gravity", value, line)?.into());
    }
    let [x, y] = numbers("Gravity", value, line)?;
    let is_finite = x.is_finite() && y.is_finite();
    is_finite
        .then_some(DVec2::new(x, y).into())
        .ok_or_else(|| ReadError::unexpected(line, "Gravity", "finite", value))
}

/// The keys of a frame, each once, with their values without quotes.
struct Keys<'a>(HashMap<&'a str, &'a str>);

impl<'a> Keys<'a> {
    /// Divides a line into keys and values. Words without a value are ignored.
    fn parse(text: &'a str, line: usize) -> Result<Self, ReadError> {
        let (mut keys, mut rest) = (HashMap::new(), text.trim_start());
        while !rest.is_empty() {
            let end = rest.find(|letter: char| letter == '=' || letter.is_whitespace()).unwrap_or(rest.len());
            let (name, after) = rest.split_at(end);
            let Some(after) = after.strip_prefix('=') else {
                rest = after.trim_start();
                continue;
            };
            let (value, after) = match after.strip_prefix('"') {
                Some(quoted) => quoted.split_once('"').ok_or_else(|| {
                    ReadError::unexpected(line, format!("the value of `{name}`"), "within two quotes", after)
                })?,
                None => after.split_at(after.find(char::is_whitespace).unwrap_or(after.len())),
            };
            if keys.insert(name, value).is_some() {
                return Err(ReadError::Doubled { line, first: line, what: format!("the key `{name}`") });
            }
            rest = after.trim_start();
        }
        Ok(Self(keys))
    }

    fn value(&self, key: &str) -> Option<&'a str> {
        self.0.get(key).copied()
    }
}

/// Returns the time among the keys of a frame, if it is there.
pub(super) fn time(keys: &str) -> Option<f64> {
    Keys::parse(keys, 0).ok()?.value("Time")?.parse().ok()
}

/// Returns the fields of each disk, with [`Field::Other`] for columns that are no property of a disk.
fn fields(properties: &str, line: usize) -> Result<Vec<Field>, ReadError> {
    let parts: Vec<&str> = properties.split(':').collect();
    let mut fields = Vec::new();
    for part in parts.chunks(3) {
        let wrong = |found: &str| {
            Err(ReadError::unexpected(line, "each of `Properties`", "a name, a type and a number", found))
        };
        let &[name, _, count] = part else { return wrong(&part.join(":")) };
        let Ok(count @ 1..=MOST_COLUMNS) = count.parse() else { return wrong(&part.join(":")) };
        if fields.len() + count > MOST_COLUMNS {
            let most = format!("of at most {MOST_COLUMNS} columns");
            return Err(ReadError::unexpected(line, "`Properties`", most, properties));
        }
        let known = known(name);
        fields.extend((0..count).map(|index| known.get(index).copied().unwrap_or(Field::Other)));
    }
    Ok(fields)
}

/// Returns the fields of a column, one for each component.
fn known(name: &str) -> &'static [Field] {
    match name {
        "id" => &[Field::Id],
        "kind" => &[Field::Kind],
        "pos" => &[Field::X, Field::Y, Field::Zero],
        "velo" | "velocity" => &[Field::VelocityX, Field::VelocityY, Field::Zero],
        "angle" => &[Field::Angle],
        "angular_velocity" => &[Field::AngularVelocity],
        "omega" => &[Field::Zero, Field::Zero, Field::AngularVelocity],
        "radius" => &[Field::Radius],
        "mass" => &[Field::Mass],
        "inertia_factor" => &[Field::InertiaFactor],
        "image" => &[Field::ImageX, Field::ImageY],
        _ => &[],
    }
}

/// Returns the box from the key `Domain`, which this crate writes, or else from the lattice.
fn domain(keys: &Keys<'_>, line: usize) -> Result<Option<Domain>, ReadError> {
    let domain = match (keys.value("Domain"), keys.value("Lattice")) {
        (Some(domain), _) => {
            let [left, right, bottom, top] = numbers("Domain", domain, line)?;
            Domain::new(left, right, bottom, top)
        }
        (None, Some(lattice)) => {
            let [width, a, _, b, height, _, _, _, _] = numbers("Lattice", lattice, line)?;
            if a != 0.0 || b != 0.0 {
                return Err(ReadError::unexpected(line, "Lattice", "a rectangle", lattice));
            }
            let [left, bottom, _] = numbers("Origin", keys.value("Origin").unwrap_or("0 0 0"), line)?;
            Domain::new(left, left + width, bottom, bottom + height)
        }
        (None, None) => return Ok(None),
    };
    checked_box(periodic(domain, keys.value("pbc"), line)?, line).map(Some)
}

/// Returns the box with the periodic directions of the file.
fn periodic(domain: Domain, pbc: Option<&str>, line: usize) -> Result<Domain, ReadError> {
    let Some(pbc) = pbc else { return Ok(domain) };
    let flag = |letter: &str| match letter {
        "T" | "1" | "True" | "true" => Some(true),
        "F" | "0" | "False" | "false" => Some(false),
        _ => None,
    };
    let flags: Vec<Option<bool>> = pbc.split_whitespace().map(flag).collect();
    let &[Some(sides), Some(ends), Some(_)] = flags.as_slice() else {
        return Err(ReadError::unexpected(line, "pbc", "three letters T or F", pbc));
    };
    let domain = if sides { domain.with_periodic_sides() } else { domain };
    Ok(if ends { domain.with_periodic_ends() } else { domain })
}

/// Reads `COUNT` numbers, separated by white space.
fn numbers<const COUNT: usize>(what: &str, text: &str, line: usize) -> Result<[f64; COUNT], ReadError> {
    let numbers = text.split_whitespace().map(|text| number(what, text, line));
    let numbers: Vec<f64> = numbers.collect::<Result<_, _>>()?;
    numbers.try_into().map_err(|_| ReadError::unexpected(line, what, format!("{COUNT} numbers"), text))
}
