//! Files for ParaView: XML with base64, and a series of them.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use granular_edmd::Disk;
use granular_edmd::boundary::Domain;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::Snapshot;

use super::State;
use super::format::{numbered, shown_top};
use crate::format::no_frame;
use crate::recording::{Growing, Layout, Recording, Start};
use crate::{Frame, RecordError};

impl State {
    /// Writes the disks as VTK's `PolyData`, a `.vtp` file for ParaView with a point for each disk.
    ///
    /// The arrays are `id` (from 1), `kind`, `velocity`, `angle`, `angular_velocity`, `radius`, `mass`,
    /// `inertia_factor`, `image` and `unwrapped` (position), and `TimeValue` for the whole file. Numbers are
    /// in binary. A [`Recorder`](super::Recorder) with [`Vtk`](super::Vtk) makes a series of such files. In
    /// ParaView, the filter Glyph shows the disks: choose a sphere of radius 1, scaled by the array `radius`.
    ///
    /// # Errors
    /// If the writer fails.
    pub fn write_vtk(&self, mut out: impl Write) -> io::Result<()> {
        write_disks(&mut out, &self.disks, self.domain.as_ref(), self.time)?;
        out.flush()
    }
}

const HEAD: &str = "<?xml version=\"1.0\"?>\n\
    <VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n";
const TAIL: &str = "</Piece>\n</PolyData>\n</VTKFile>\n";

fn write_disks(
    out: &mut dyn Write,
    disks: &[Disk],
    domain: Option<&Domain>,
    time: Option<f64>,
) -> io::Result<()> {
    out.write_all(HEAD.as_bytes())?;
    write_time(out, time)?;
    let count = disks.len();
    writeln!(out, "<Piece NumberOfPoints=\"{count}\" NumberOfVerts=\"{count}\">\n<PointData>")?;
    let whole = |of: fn(&Disk) -> i64| disks.iter().map(of);
    let number = |of: fn(&Disk) -> f64| disks.iter().map(of);
    write_tuples(out, INTEGERS, "id", 1, numbered(disks).map(|(id, _)| id.cast_signed()))?;
    write_tuples(out, INTEGERS, "kind", 1, whole(|disk| disk.kind().number().into()))?;
    write_tuples(out, NUMBERS, "velocity", 3, disks.iter().flat_map(|disk| in_space(disk.velocity())))?;
    write_tuples(out, NUMBERS, "angle", 1, number(Disk::angle))?;
    write_tuples(out, NUMBERS, "angular_velocity", 1, number(Disk::angular_velocity))?;
    write_tuples(out, NUMBERS, "radius", 1, number(Disk::radius))?;
    write_tuples(out, NUMBERS, "mass", 1, number(Disk::mass))?;
    write_tuples(out, NUMBERS, "inertia_factor", 1, number(Disk::inertia_factor))?;
    let images = disks.iter().flat_map(|disk| disk.image().map(i64::from));
    write_tuples(out, INTEGERS, "image", 2, images)?;
    let unwrapped = |disk| domain.map_or(Disk::position(disk), |domain| domain.unwrapped(disk));
    write_tuples(out, NUMBERS, "unwrapped", 3, disks.iter().flat_map(|disk| in_space(unwrapped(disk))))?;
    out.write_all(b"</PointData>\n<Points>\n")?;
    write_tuples(out, NUMBERS, "Points", 3, disks.iter().flat_map(|disk| in_space(disk.position())))?;
    out.write_all(b"</Points>\n<Verts>\n")?;
    write_tuples(out, INTEGERS, "connectivity", 1, (0_i64..).take(count))?;
    write_tuples(out, INTEGERS, "offsets", 1, (1_i64..).take(count))?;
    out.write_all(b"</Verts>\n")?;
    out.write_all(TAIL.as_bytes())
}

/// Writes the edges of the box at the positions of its walls, and the other walls, as lines.
///
/// The array `periodic` is 1 for edges that are not walls, and `part` is 1 for walls that are not edges. An
/// open box has no lid.
fn write_box(out: &mut dyn Write, snapshot: &Snapshot<'_>) -> io::Result<()> {
    let (domain, walls) = (snapshot.edges(), snapshot.wall_lines());
    let Domain { left, right, bottom, .. } = domain;
    let top = shown_top(&domain, snapshot.disks());
    let corners = [(left, top), (left, bottom), (right, bottom), (right, top)].map(DVec2::from);
    let edges = if domain.top.is_finite() { 4 } else { 3 };
    let points = || corners.iter().chain(walls.iter().flatten()).copied();
    let (lines, points_count) = (edges + walls.len(), points().count());
    out.write_all(HEAD.as_bytes())?;
    write_time(out, Some(snapshot.time()))?;
    writeln!(out, "<Piece NumberOfPoints=\"{points_count}\" NumberOfLines=\"{lines}\">\n<CellData>")?;
    let periodic = [domain.periodic_sides, domain.periodic_ends].map(i64::from);
    let periodic = periodic.into_iter().cycle().take(edges).chain(walls.iter().map(|_| 0));
    write_tuples(out, INTEGERS, "periodic", 1, periodic)?;
    write_tuples(out, INTEGERS, "part", 1, (0..lines).map(|line| i64::from(line >= edges)))?;
    out.write_all(b"</CellData>\n<Points>\n")?;
    write_tuples(out, NUMBERS, "Points", 3, points().flat_map(in_space))?;
    out.write_all(b"</Points>\n<Lines>\n")?;
    let ends = (0_i64..).take(edges).flat_map(|line| [line, (line + 1) % 4]);
    write_tuples(out, INTEGERS, "connectivity", 1, ends.chain((4_i64..).take(points_count - 4)))?;
    let sizes = (0..edges).map(|_| 2).chain(walls.iter().map(Vec::len));
    let offsets = sizes.scan(0, |sum, size| {
        *sum += i64::try_from(size).unwrap_or(i64::MAX);
        Some(*sum)
    });
    write_tuples(out, INTEGERS, "offsets", 1, offsets)?;
    out.write_all(b"</Lines>\n")?;
    out.write_all(TAIL.as_bytes())
}

fn write_time(out: &mut dyn Write, time: Option<f64>) -> io::Result<()> {
    let Some(time) = time else { return Ok(()) };
    out.write_all(b"<FieldData>\n")?;
    write_array(out, "Float64", "TimeValue", "NumberOfTuples=\"1\"", std::iter::once(time.to_le_bytes()))?;
    out.write_all(b"</FieldData>\n")
}

/// Returns a vector of the plane with a third component 0.
fn in_space(vector: DVec2) -> [f64; 3] {
    [vector.x, vector.y, 0.0]
}

/// The types of numbers in arrays: their names, and how they become bytes.
const INTEGERS: (&str, fn(i64) -> [u8; 8]) = ("Int64", i64::to_le_bytes);
const NUMBERS: (&str, fn(f64) -> [u8; 8]) = ("Float64", f64::to_le_bytes);

/// Writes an array with a tuple of `components` numbers for each point or line.
fn write_tuples<T>(
    out: &mut dyn Write,
    (kind, to_bytes): (&str, fn(T) -> [u8; 8]),
    name: &str,
    components: usize,
    numbers: impl Iterator<Item = T>,
) -> io::Result<()> {
    let attributes = format!("NumberOfComponents=\"{components}\"");
    write_array(out, kind, name, &attributes, numbers.map(to_bytes))
}

fn write_array(
    out: &mut dyn Write,
    kind: &str,
    name: &str,
    attributes: &str,
    numbers: impl Iterator<Item = [u8; 8]>,
) -> io::Result<()> {
    let mut bytes = vec![0; 8];
    bytes.extend(numbers.flatten());
    let length = (bytes.len() - 8) as u64;
    bytes[..8].copy_from_slice(&length.to_le_bytes());
    write!(out, "<DataArray type=\"{kind}\" Name=\"{name}\" {attributes} format=\"binary\">")?;
    out.write_all(&base64(&bytes))?;
    out.write_all(b"</DataArray>\n")
}

/// Returns the bytes in base64 (RFC 4648).
fn base64(bytes: &[u8]) -> Vec<u8> {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = Vec::with_capacity(bytes.len().div_ceil(3) * 4);
    for triple in bytes.chunks(3) {
        let bits =
            triple.iter().fold(0_u32, |bits, &byte| bits << 8 | u32::from(byte)) << (8 * (3 - triple.len()));
        let letters = [18, 12, 6, 0].map(|shift| LETTERS[(bits >> shift & 63) as usize]);
        text.extend(&letters[..=triple.len()]);
        text.extend(&b"=="[..3 - triple.len()]);
    }
    text
}

/// Beginning and ending of the file of times. The ending follows each frame, so that the file is always
/// whole.
const SERIES_HEAD: &str = "<?xml version=\"1.0\"?>\n\
    <VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
const SERIES_TAIL: &str = "</Collection>\n</VTKFile>\n";

/// Frames in separate files, in a folder beside the file of times.
struct Series {
    folder: PathBuf,
    /// Name of the folder, as written in the file of times.
    name: String,
}

/// Begins a series, or continues it after its last complete frame.
pub(crate) fn open(path: &Path, start: Start) -> Result<Recording, RecordError> {
    let (folder, name) = place(path)?;
    let (mut file, is_new) = Growing::open(path, start)?;
    let mut all = Vec::new();
    if is_new {
        fs::create_dir(&folder).map_err(|error| {
            if start == Start::New {
                let _ = fs::remove_file(path);
            }
            match error.kind() {
                io::ErrorKind::AlreadyExists => RecordError::Exists { path: folder.clone() },
                _ => RecordError::io("create", &folder)(error),
            }
        })?;
        file.push(SERIES_HEAD.as_bytes(), SERIES_TAIL.as_bytes())?;
    } else {
        let text = io::read_to_string(&file.file).map_err(RecordError::io("read", path))?;
        let (times, length) = times(&text, &name);
        if !times.is_empty() && !is_torn(&text[length..], &name, times.len()) {
            return Err(RecordError::io("continue", path)(no_frame("an ending", &text[length..])));
        }
        file.resume(length as u64, SERIES_TAIL.into());
        all = times;
    }
    Recording::new(file, is_new, all, Series { folder, name })
}

impl Series {
    /// Writes one of a frame's files. A killed run may have left that file, complete or not.
    fn write(&self, part: &str, number: usize, bytes: &[u8]) -> Result<(), RecordError> {
        let path = self.folder.join(file_name(part, number));
        let file = match fs::read(&path) {
            Ok(there) if there == bytes => return Ok(()),
            Ok(there) if bytes.starts_with(&there) => File::create(&path),
            Ok(_) => return Err(RecordError::Exists { path }),
            Err(_) => File::create_new(&path),
        };
        let mut file = file.map_err(RecordError::io("create", &path))?;
        file.write_all(bytes).map_err(|error| {
            // An incomplete file is harmless, but it takes room on a full drive.
            let _ = fs::remove_file(&path);
            RecordError::io("write to", &path)(error)
        })
    }
}

impl Layout for Series {
    fn make(&self, frame: &Frame<'_>, bytes: &mut Vec<u8>) -> io::Result<()> {
        let snapshot = frame.snapshot();
        write_disks(bytes, snapshot.disks(), Some(&snapshot.domain()), Some(snapshot.time()))
    }

    fn push(&mut self, file: &mut Growing, frame: &Frame<'_>, bytes: &[u8]) -> Result<(), RecordError> {
        let (mut edges, number, snapshot) = (Vec::new(), frame.number(), frame.snapshot());
        write_box(&mut edges, snapshot).map_err(RecordError::io("make a frame of", &file.path))?;
        self.write("disks", number, bytes)?;
        self.write("box", number, &edges)?;
        file.push(entry(&self.name, number, snapshot.time()).as_bytes(), SERIES_TAIL.as_bytes())
    }

    fn has(&self, _: &Growing, number: usize, bytes: &[u8]) -> Result<bool, RecordError> {
        let path = self.folder.join(file_name("disks", number));
        Ok(fs::read(&path).map_err(RecordError::io("read", &path))? == bytes)
    }
}

/// Returns the folder of the frames, and its name in the file of times.
fn place(path: &Path) -> Result<(PathBuf, String), RecordError> {
    let name = path.file_stem().and_then(|name| name.to_str());
    if let Some(name) = name.filter(|_| path.extension().is_some_and(|ending| ending == "pvd")) {
        return Ok((path.with_extension(""), escaped(name)));
    }
    Err(RecordError::unusable(path, "the name must be valid Unicode and end in .pvd"))
}

fn file_name(part: &str, number: usize) -> String {
    format!("{part}_{number:06}.vtp")
}

/// Returns the lines of a frame in the file of times.
fn entry(folder: &str, number: usize, time: f64) -> String {
    let line = |index: usize, part: &str| {
        let file = file_name(part, number);
        format!(
            "<DataSet timestep=\"{time:?}\" part=\"{index}\" name=\"{part}\" file=\"{folder}/{file}\"/>\n"
        )
    };
    line(0, "disks") + &line(1, "box")
}

/// Returns the times of the complete frames that a file of times lists, and the length of the text up to the
/// end of the last complete entry.
fn times(text: &str, folder: &str) -> (Vec<f64>, usize) {
    let (mut times, mut length) = (Vec::new(), SERIES_HEAD.len());
    let Some(mut rest) = text.strip_prefix(SERIES_HEAD) else { return (times, 0) };
    loop {
        let quoted = rest.strip_prefix("<DataSet timestep=\"").and_then(|rest| rest.split_once('"'));
        let Some(time) = quoted.and_then(|(time, _)| time.parse().ok()) else { break };
        let entry = entry(folder, times.len(), time);
        let Some(after) = rest.strip_prefix(entry.as_str()) else { break };
        times.push(time);
        length += entry.len();
        rest = after;
    }
    (times, length)
}

/// Returns true if the rest of a file of times is no longer than its ending, or is an unfinished frame.
fn is_torn(rest: &str, folder: &str, number: usize) -> bool {
    let time = rest.strip_prefix("<DataSet timestep=\"").and_then(|rest| rest.split_once('"'));
    let entry =
        time.and_then(|(time, _)| time.parse().ok()).map(|time| entry(folder, number, time) + SERIES_TAIL);
    rest.len() <= SERIES_TAIL.len() || entry.is_some_and(|entry| entry.starts_with(rest))
}

/// Returns a text with the characters that have a meaning in XML escaped.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
