//! Frames of GSD, read one by one.

use std::cell::RefCell;
use std::io::{BufRead, Cursor, Read, Seek};
use std::rc::Rc;

use glam::DVec2;

use super::archive::{Archive, Chunk};
use crate::Disk;
use crate::boundary::Domain;
use crate::trajectory::ReadError;
use crate::trajectory::column::Column;
use crate::trajectory::found::{Found, Frames};
use crate::trajectory::lines::{checked_box, is_upright};
use crate::trajectory::table::Table;

/// Returns whether a file that begins with these bytes is a file of GSD.
pub(in crate::trajectory) fn is_gsd(head: &[u8]) -> bool {
    head.starts_with(&0x65DF_65DF_65DF_65DF_u64.to_le_bytes())
}

/// Returns the frames of an input, which has to be in memory, since the index may be anywhere.
pub(in crate::trajectory) fn frames<'a>(mut input: impl BufRead + 'a) -> Frames<'a> {
    let mut bytes = Vec::new();
    match input.read_to_end(&mut bytes) {
        Ok(_) => frames_of_file(Cursor::new(bytes)),
        Err(error) => Box::new(std::iter::once(Err(ReadError::gsd(error.to_string())))),
    }
}

/// Returns the frames of a file, of which only the one that is wanted is read.
pub(in crate::trajectory) fn frames_of_file<'a>(input: impl Read + Seek + 'a) -> Frames<'a> {
    let archive = match Archive::open(input) {
        Ok(archive) => archive,
        Err(error) => return Box::new(std::iter::once(Err(error))),
    };
    let (count, archive) = (archive.frames(), Rc::new(RefCell::new(archive)));
    Box::new((0..count).map(move |frame| {
        let step = archive.borrow_mut().chunk(frame, "configuration/step")?;
        let step = step.map_or(0, |step| step.number(0, 0) as u64);
        let archive = Rc::clone(&archive);
        Ok(Found {
            step: Some(step),
            read: Box::new(move || {
                View { archive: &mut archive.borrow_mut(), frame, notes: Vec::new() }.table()
            }),
        })
    }))
}

/// A frame of a file.
struct View<'a, R> {
    archive: &'a mut Archive<R>,
    frame: u64,
    notes: Vec<String>,
}

/// Columns of a disk.
const COLUMNS: [(&str, usize); 10] = [
    ("pos", 3),
    ("kind", 1),
    ("diameter", 1),
    ("mass", 1),
    ("velo", 3),
    ("orientation", 4),
    ("omega", 3),
    ("inertia_factor", 1),
    ("image", 3),
    ("id", 1),
];

impl<R: Read + Seek> View<'_, R> {
    fn wrong(&self, what: &str) -> ReadError {
        ReadError::gsd(format!("frame {}: {what}", self.frame))
    }

    /// Returns a chunk, which is as in the first frame if it is missing.
    fn find(&mut self, name: &str) -> Result<Option<Chunk>, ReadError> {
        match self.archive.chunk(self.frame, name)? {
            None => self.archive.chunk(0, name),
            own => Ok(own),
        }
    }

    /// Returns a chunk with a row for each disk. One of the first frame does not count for other disks.
    fn rows(&mut self, name: &str, rows: usize, columns: usize) -> Result<Option<Chunk>, ReadError> {
        let is_own = self.archive.chunk(self.frame, name)?.is_some();
        let Some(chunk) = self.find(name)? else { return Ok(None) };
        if (chunk.rows, chunk.columns) == (rows, columns) {
            return Ok(Some(chunk));
        }
        let found = format!("{} rows of {} numbers, not {rows} of {columns}", chunk.rows, chunk.columns);
        if is_own { Err(self.wrong(&format!("the chunk `{name}` has {found}"))) } else { Ok(None) }
    }

    /// Returns a chunk of this number of numbers.
    fn numbers<const COUNT: usize>(&mut self, name: &str) -> Result<Option<[f64; COUNT]>, ReadError> {
        let Some(chunk) = self.find(name)? else { return Ok(None) };
        if chunk.rows.saturating_mul(chunk.columns) != COUNT {
            let found = format!("{} rows of {} numbers, not {COUNT} numbers", chunk.rows, chunk.columns);
            return Err(self.wrong(&format!("the chunk `{name}` has {found}")));
        }
        Ok(Some(std::array::from_fn(|at| chunk.number(at / chunk.columns, at % chunk.columns))))
    }

    fn table(mut self) -> Result<Table, ReadError> {
        let [count] = self.numbers("particles/N")?.unwrap_or_default();
        let disks = self.disks(count as usize)?;
        let columns = COLUMNS.iter().zip(disks.present()).filter(|(_, is_there)| *is_there);
        let mut table = Table::new(columns.flat_map(|((name, size), _)| Column::of(name, *size)), 1)?;
        let center = self.space(&mut table)?;
        for row in 0..count as usize {
            table.push_numbers(&disks.row(row, center), row + 1);
        }
        table.rounding = rounding(&disks.position, center);
        table.notes = self.notes;
        Ok(table)
    }

    fn disks(&mut self, count: usize) -> Result<Disks, ReadError> {
        let position = self.rows("particles/position", count, 3)?;
        let Some(position) = position.or_else(|| (count == 0).then(Chunk::default)) else {
            return Err(self.wrong("the chunk `particles/position` is missing"));
        };
        let kind = self.rows("particles/typeid", count, 1)?;
        let diameters = self.diameters(count, kind.as_ref())?;
        let mut rows = |name, columns| self.rows(name, count, columns);
        Ok(Disks {
            position,
            kind,
            diameters,
            mass: rows("particles/mass", 1)?,
            velocity: rows("particles/velocity", 3)?,
            orientation: rows("particles/orientation", 4)?,
            momentum: rows("particles/angmom", 4)?,
            inertia: rows("particles/moment_inertia", 3)?,
            image: rows("particles/image", 3)?,
            id: rows("log/particles/id", 1)?,
        })
    }

    /// Sets the box, the time and gravity, and returns the point from which positions count.
    fn space(&mut self, table: &mut Table) -> Result<DVec2, ReadError> {
        let [width, height, _, xy, xz, yz] =
            self.numbers("configuration/box")?.unwrap_or([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
        if !is_upright([width, height], [xy * height, xz, yz]) {
            return Err(
                self.wrong(&format!("the box must be a rectangle, but has the tilts {xy}, {xz} and {yz}"))
            );
        }
        let center = self.numbers("log/center")?.map_or(DVec2::ZERO, DVec2::from_array);
        let (corner, periodic) = (center - 0.5 * DVec2::new(width, height), self.numbers("log/periodic")?);
        let seen = Domain::new(corner.x, corner.x + width, corner.y, corner.y + height);
        let own = self
            .numbers("log/domain")?
            .map(|[left, right, bottom, top]| Domain::new(left, right, bottom, top));
        if periodic.is_none() && self.archive.is_own {
            self.notes
                .push("the box is left out, for the file does not tell where it is periodic".to_owned());
        } else {
            let domain = checked_box(own.unwrap_or(seen), 1)?;
            let [sides, ends] = periodic.unwrap_or([1.0; 2]);
            let domain = if sides == 0.0 { domain } else { domain.with_periodic_sides() };
            table.domain = Some(if ends == 0.0 { domain } else { domain.with_periodic_ends() });
        }
        table.time = self.numbers("log/time")?.map(|[time]| time);
        table.gravity = self.numbers("log/gravity")?.map(|gravity| DVec2::from_array(gravity).into());
        Ok(center)
    }

    /// Returns the diameters: those of the shapes if the file has shapes, or else its diameters, which are 1
    /// where it has none.
    fn diameters(&mut self, count: usize, kind: Option<&Chunk>) -> Result<Vec<f64>, ReadError> {
        if let Some(name) = self.archive.names().find_map(other_shape) {
            return Err(self.wrong(&format!("the shapes must be disks, but are `{name}`")));
        }
        let shapes = match self.find("particles/type_shapes")? {
            Some(shapes) => self.shapes(&shapes)?,
            None => Vec::new(),
        };
        let of_state = self.find("state/hpmc/sphere/radius")?;
        let given = self.rows("particles/diameter", count, 1)?;
        if shapes.is_empty() && of_state.is_none() && given.is_none() {
            self.notes.push("all diameters are 1, for the file has none".to_owned());
        }
        let of_disk = |row| {
            let kind = kind.map_or(0, |kind| kind.number(row, 0) as usize);
            let of_state = of_state.as_ref().filter(|state| kind < state.rows);
            let of_shape = shapes.get(kind).copied().or(of_state.map(|state| 2.0 * state.decimal(kind)));
            of_shape.unwrap_or_else(|| given.as_ref().map_or(1.0, |given| given.decimal(row)))
        };
        Ok((0..count).map(of_disk).collect())
    }

    /// Returns the diameters of the shapes of all types, which must be disks.
    fn shapes(&self, shapes: &Chunk) -> Result<Vec<f64>, ReadError> {
        let mut diameters = Vec::new();
        for shape in shapes.bytes.split(|&byte| byte == 0).filter(|shape| !shape.is_empty()) {
            let text = String::from_utf8_lossy(shape).replace([' ', '"'], "");
            let value = |name| Some(text.split(name).nth(1)?.split([',', '}']).next().unwrap_or_default());
            match (value("type:"), value("diameter:").and_then(|diameter| diameter.parse().ok())) {
                (Some("Sphere" | "Disk"), Some(diameter)) => diameters.push(diameter),
                (None, None) if diameters.is_empty() => {}
                (kind, _) => {
                    let found = kind.unwrap_or("none");
                    return Err(self.wrong(&format!("the shapes must be disks, but one is {found:?}")));
                }
            }
        }
        Ok(diameters)
    }
}

/// The chunks with a row for each disk, as far as they are there.
struct Disks {
    position: Chunk,
    kind: Option<Chunk>,
    diameters: Vec<f64>,
    mass: Option<Chunk>,
    velocity: Option<Chunk>,
    orientation: Option<Chunk>,
    momentum: Option<Chunk>,
    inertia: Option<Chunk>,
    image: Option<Chunk>,
    id: Option<Chunk>,
}

impl Disks {
    /// Returns which of the columns are there.
    fn present(&self) -> [bool; COLUMNS.len()] {
        let Self { kind, mass, velocity, orientation, momentum, inertia, image, id, .. } = self;
        let [kind, mass, velocity, orientation] = [kind, mass, velocity, orientation].map(Option::is_some);
        let [momentum, inertia, image, id] = [momentum, inertia, image, id].map(Option::is_some);
        [true, kind, true, mass, velocity, orientation, momentum && inertia, inertia, image, id]
    }

    /// Returns the numbers of a disk in the columns that are there.
    fn row(&self, row: usize, center: DVec2) -> Vec<f64> {
        let of = |chunk: &Option<Chunk>, column| chunk.as_ref().map(|chunk| chunk.number(row, column));
        let mut numbers =
            vec![self.position.number(row, 0) + center.x, self.position.number(row, 1) + center.y];
        let (mass, diameter) = (self.mass.as_ref().map(|mass| mass.decimal(row)), self.diameters[row]);
        numbers.push(self.position.number(row, 2));
        numbers.extend(of(&self.kind, 0));
        numbers.push(diameter);
        numbers.extend(mass);
        numbers.extend([0, 1, 2].iter().filter_map(|&axis| of(&self.velocity, axis)));
        numbers.extend([1, 2, 3, 0].iter().filter_map(|&part| of(&self.orientation, part)));
        let moment = of(&self.inertia, 2).filter(|&moment| moment > 0.0);
        if self.momentum.is_some() && self.inertia.is_some() {
            // A quaternion of angular momentum is twice the orientation times the momentum of the body.
            let [w, z] =
                [(0, 1.0), (3, 0.0)].map(|(part, unturned)| of(&self.orientation, part).unwrap_or(unturned));
            let [p, x, y, q] = [0, 1, 2, 3].map(|part| of(&self.momentum, part).unwrap_or_default());
            numbers.extend([x, y, moment.map_or(0.0, |moment| 0.5 * (w * q - z * p) / moment)]);
        }
        if self.inertia.is_some() {
            let unit = 0.25 * mass.unwrap_or(1.0) * diameter * diameter;
            numbers.push(moment.map_or(Disk::HOMOGENEOUS_INERTIA_FACTOR, |moment| moment / unit));
        }
        numbers.extend([0, 1, 2].iter().filter_map(|&axis| of(&self.image, axis)));
        numbers.extend(of(&self.id, 0));
        numbers
    }
}

/// Returns the shape of which a chunk keeps the state, if it is not a disk.
fn other_shape(name: &str) -> Option<String> {
    let shape = name.strip_prefix("state/hpmc/")?.split('/').next()?;
    (!["sphere", "integrate"].contains(&shape)).then(|| shape.to_owned())
}

/// Returns the largest rounding of positions in single precision.
fn rounding(position: &Chunk, center: DVec2) -> f64 {
    let places = (0..position.rows).flat_map(|row| [0, 1].map(|axis| position.number(row, axis).abs()));
    let largest = places.fold(center.abs().max_element() * 1e-9, f64::max);
    if position.is_single() { f64::from(f32::EPSILON) * largest } else { 0.0 }
}
