//! Frames of GSD, read one by one.

use std::cell::RefCell;
use std::f64::consts::PI;
use std::io::{Read, Seek};
use std::rc::Rc;

use granular_edmd::Disk;
use granular_edmd::boundary::Domain;
use granular_edmd::glam::DVec2;

use super::{Archive, Chunk, F32};
use crate::ReadError;
use crate::column::Column;
use crate::lines::{as_whole, checked_box, is_upright};
use crate::table::Table;
use crate::table::{Found, Frames, RADIUS_IGNORED, Settings};

/// Rounding of an inertia factor that follows from three numbers of single precision, relative to the factor.
const ROUNDING: f64 = 1e-6;

/// Returns whether a file that begins with these bytes is a GSD file.
pub(crate) fn is_gsd(head: &[u8]) -> bool {
    head.starts_with(&0x65DF_65DF_65DF_65DF_u64.to_le_bytes())
}

/// Returns the frames of a file, each of which is read only on request.
pub(crate) fn frames<'a>(input: impl Read + Seek + 'a) -> Result<Frames<'a>, ReadError> {
    let archive = Archive::open(input)?;
    let (count, archive) = (archive.frames(), Rc::new(RefCell::new(archive)));
    Ok(Box::new((0..count).map(move |frame| {
        let step = archive.borrow_mut().chunk(frame, "configuration/step")?;
        let step = step.map_or(0, |step| step.number(0, 0) as u64);
        let archive = Rc::clone(&archive);
        Ok(Found {
            step: Some(step),
            read: Box::new(move |settings| {
                View { archive: &mut archive.borrow_mut(), frame, settings, notes: Vec::new() }.table()
            }),
        })
    })))
}

/// A frame of a file.
struct View<'a, R> {
    archive: &'a mut Archive<R>,
    frame: u64,
    settings: &'a Settings,
    notes: Vec<String>,
}

impl<R: Read + Seek> View<'_, R> {
    fn wrong(&self, what: &str) -> ReadError {
        ReadError::gsd(format!("frame {}: {what}", self.frame))
    }

    /// Returns a chunk, or the chunk of the first frame if this frame lacks it.
    fn find(&mut self, name: &str) -> Result<Option<Chunk>, ReadError> {
        match self.archive.chunk(self.frame, name)? {
            None => self.archive.chunk(0, name),
            own => Ok(own),
        }
    }

    /// Returns a chunk with a row for each disk. A chunk of the first frame does not count if it has another
    /// number of rows.
    fn rows(&mut self, name: &str, rows: usize, columns: usize) -> Result<Option<Chunk>, ReadError> {
        let is_own = self.archive.chunk(self.frame, name)?.is_some();
        let Some(chunk) = self.find(name)? else { return Ok(None) };
        if (chunk.rows, chunk.columns) == (rows, columns) {
            return Ok(Some(chunk));
        }
        let found = format!("{} rows of {} numbers, not {rows} of {columns}", chunk.rows, chunk.columns);
        if is_own { Err(self.wrong(&format!("the chunk `{name}` has {found}"))) } else { Ok(None) }
    }

    /// Returns the numbers in a chunk that must hold `COUNT` of them, or `None` if the frame has no such
    /// chunk.
    fn numbers<const COUNT: usize>(&mut self, name: &str) -> Result<Option<[f64; COUNT]>, ReadError> {
        let Some(chunk) = self.find(name)? else { return Ok(None) };
        if chunk.rows.saturating_mul(chunk.columns) != COUNT {
            let found = format!("{} rows of {} numbers, not {COUNT} numbers", chunk.rows, chunk.columns);
            return Err(self.wrong(&format!("the chunk `{name}` has {found}")));
        }
        Ok(Some(std::array::from_fn(|at| chunk.number(at / chunk.columns, at % chunk.columns))))
    }

    /// Returns the numbers in a chunk that must hold `COUNT` finite ones, or `None` if the frame has no such
    /// chunk.
    fn finite<const COUNT: usize>(&mut self, name: &str) -> Result<Option<[f64; COUNT]>, ReadError> {
        match self.numbers(name)? {
            Some(numbers) if numbers.iter().any(|number| !number.is_finite()) => {
                Err(self.wrong(&format!("the chunk `{name}` must be finite, but is {numbers:?}")))
            }
            numbers => Ok(numbers),
        }
    }

    fn table(mut self) -> Result<Table, ReadError> {
        let [count] = self.numbers("particles/N")?.unwrap_or_default();
        let count = count as usize;
        // The chunk is only marked as known: the positions themselves show whether the disks lie in a plane.
        self.find("configuration/dimensions")?;
        let position = self.rows("particles/position", count, 3)?;
        let Some(position) = position.or_else(|| (count == 0).then(Chunk::default)) else {
            return Err(self.wrong("the chunk `particles/position` is missing"));
        };
        let center = self.finite("log/center")?.map_or(DVec2::ZERO, DVec2::from_array);
        let mut columns = self.columns(count)?;
        let places =
            position.numbers(&[0, 1, 2]).into_iter().zip([center.x, center.y, 0.0].into_iter().cycle());
        columns.push(("pos", 3, places.map(|(place, center)| place + center).collect()));
        let mut table = Table::new(columns.iter().flat_map(|(name, size, _)| Column::of(name, *size)), 1);
        table.binary_frame = Some(self.frame);
        self.space(center, &mut table)?;
        for row in 0..count {
            let numbers =
                columns.iter().flat_map(|(_, size, numbers)| &numbers[row * size..(row + 1) * size]);
            table.push_numbers(numbers.copied(), row + 1);
        }
        if let Some(types) = self.find("particles/types")? {
            let names = types.bytes.chunks(types.columns.max(1)).map(String::from_utf8_lossy);
            let names: Vec<String> = names.map(|name| name.trim_end_matches('\0').to_owned()).collect();
            let is_named = names.iter().any(|name| as_whole::<u16>(name).is_none());
            table.kind_names = if is_named { names } else { Vec::new() };
        }
        let ignored = self.archive.unread(self.frame);
        table.columns.extend(ignored.map(|name| Column { name: name.to_owned(), slot: None }));
        table.rounding = rounding(&position, center);
        table.notes = self.notes;
        Ok(table)
    }

    /// Returns the columns that the frame has besides the positions.
    fn columns(&mut self, count: usize) -> Result<Vec<Numbers>, ReadError> {
        let mut columns = Vec::new();
        for (chunk, name, order) in [
            ("particles/typeid", "kind", [0].as_slice()),
            ("particles/mass", "mass", &[0]),
            ("particles/velocity", "velo", &[0, 1, 2]),
            ("particles/orientation", "orientation", &[1, 2, 3, 0]),
            ("particles/image", "image", &[0, 1, 2]),
            ("log/particles/id", "id", &[0]),
        ] {
            if let Some(chunk) = self.rows(chunk, count, order.len())? {
                columns.push((name, order.len(), chunk.numbers(order)));
            }
        }
        let diameters = self.diameters(count)?;
        let (masses, density) = (self.rows("particles/mass", count, 1)?, self.settings.density);
        if masses.is_none() && density.is_some() {
            self.notes
                .push("masses follow from the density, since the file has none (all may be 1)".to_owned());
        }
        if let Some(inertia) = self.rows("particles/moment_inertia", count, 3)? {
            let moments = inertia.numbers(&[2]);
            let turned = self.rows("particles/orientation", count, 4)?;
            if let Some(momentum) = self.rows("particles/angmom", count, 4)? {
                // The angular momentum is twice the orientation times the angular momentum in the frame of
                // the body.
                let spin = |row| {
                    let half =
                        turned.as_ref().map_or([1.0, 0.0], |it| [0, 3].map(|part| it.number(row, part)));
                    let about = half[0] * momentum.number(row, 3) - half[1] * momentum.number(row, 0);
                    let turning = if moments[row] > 0.0 { 0.5 * about / moments[row] } else { 0.0 };
                    [momentum.number(row, 1), momentum.number(row, 2), turning]
                };
                columns.push(("omega", 3, (0..count).flat_map(spin).collect()));
            }
            let factor = |row: usize| {
                let square = 0.25 * diameters[row] * diameters[row];
                let by_density = || density.map_or(1.0, |density| density * PI * square);
                let unit = square * masses.as_ref().map_or_else(by_density, |mass| mass.number(row, 0));
                let homogeneous = Disk::HOMOGENEOUS_INERTIA_FACTOR;
                let factor = if moments[row] > 0.0 { moments[row] / unit } else { homogeneous };
                // Rounding must not change the inertia factor of a homogeneous disk, and must not take a ring
                // or a heavy point beyond the limits.
                let exact = [homogeneous, 1.0, 1e-6].into_iter();
                let mut near = exact.filter(|exact| (factor - exact).abs() <= ROUNDING * exact);
                near.next().unwrap_or(factor)
            };
            columns.push(("inertia_factor", 1, (0..count).map(factor).collect()));
        } else if self.rows("particles/angmom", count, 4)?.is_some() {
            let note = "angular momenta are ignored, since the file has no moments of inertia";
            self.notes.push(note.to_owned());
        }
        columns.push(("diameter", 1, diameters));
        Ok(columns)
    }

    /// Sets the box, the time and gravity.
    fn space(&mut self, center: DVec2, table: &mut Table) -> Result<(), ReadError> {
        let [width, height, _, xy, xz, yz] =
            self.numbers("configuration/box")?.unwrap_or([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
        if !is_upright([width, height], [xy * height, xz, yz]) {
            return Err(
                self.wrong(&format!("the box must be a rectangle, but has the tilts {xy}, {xz} and {yz}"))
            );
        }
        let (corner, periodic) = (center - 0.5 * DVec2::new(width, height), self.numbers("log/periodic")?);
        let seen = Domain::new(corner.x, corner.x + width, corner.y, corner.y + height);
        let own = self
            .numbers("log/domain")?
            .map(|[left, right, bottom, top]| Domain::new(left, right, bottom, top));
        if periodic.is_none() && self.archive.is_own {
            self.notes
                .push("the box is left out, since the file does not say where it is periodic".to_owned());
        } else {
            let wrong = |error| ReadError::Frame { frame: self.frame, source: Box::new(error) };
            let domain = checked_box(own.unwrap_or(seen), 1).map_err(wrong)?;
            let [sides, ends] = periodic.unwrap_or([1.0; 2]);
            let domain = if sides == 0.0 { domain } else { domain.with_periodic_sides() };
            table.domain = Some(if ends == 0.0 { domain } else { domain.with_periodic_ends() });
        }
        table.time = self.finite("log/time")?.map(|[time]| time);
        table.gravity = self.finite("log/gravity")?.map(|gravity| DVec2::from_array(gravity).into());
        Ok(())
    }

    /// Returns the diameters of the disks. The diameters come from the shapes if the file has shapes, or else
    /// from its diameters, or else from the settings. Otherwise, all are 1.
    fn diameters(&mut self, count: usize) -> Result<Vec<f64>, ReadError> {
        let state = self.archive.names.iter().find(|name| name.starts_with("state/hpmc/"));
        if let Some(state) = state.cloned() {
            return Err(
                self.wrong(&format!("the shapes must be in `particles/type_shapes`, not in `{state}`"))
            );
        }
        let shapes = match self.find("particles/type_shapes")? {
            Some(shapes) => self.shapes(&shapes)?,
            None => Vec::new(),
        };
        let (kinds, given) =
            (self.rows("particles/typeid", count, 1)?, self.rows("particles/diameter", count, 1)?);
        let default = self.settings.radius.map_or(1.0, |radius| 2.0 * radius);
        if shapes.is_empty() && given.is_none() && self.settings.radius.is_none() {
            self.notes.push("all diameters are 1, since the file has none".to_owned());
        }
        if self.settings.radius.is_some() && (given.is_some() || !shapes.is_empty()) {
            self.notes.push(RADIUS_IGNORED.to_owned());
        }
        let of_disk = |row| {
            let kind = kinds.as_ref().map_or(0, |kinds| kinds.number(row, 0) as usize);
            let shape = shapes.get(kind).copied();
            shape.unwrap_or_else(|| given.as_ref().map_or(default, |given| given.number(row, 0)))
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

/// The name of a property, the number of its components, and their values for one disk after another.
type Numbers = (&'static str, usize, Vec<f64>);

/// Returns the largest rounding error of positions in single precision.
fn rounding(position: &Chunk, center: DVec2) -> f64 {
    let places = (0..position.rows).flat_map(|row| [0, 1].map(|axis| position.number(row, axis).abs()));
    let largest = places.fold(center.abs().max_element() * 1e-9, f64::max);
    if position.kind == F32 { f64::from(f32::EPSILON) * largest } else { 0.0 }
}
