//! Disks as VTK's `PolyData`, for ParaView.

mod array;
mod series;

pub(super) use series::open;

use std::io::{self, Write};

use granular_edmd::glam::DVec2;

use self::array::{write_field, write_integers, write_numbers};
use super::State;
use super::shown::{numbered, shown_top};
use granular_edmd::Disk;
use granular_edmd::boundary::Domain;
use granular_edmd::observable::Snapshot;

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
    write_integers(out, "id", 1, numbered(disks).map(|(id, _)| id.cast_signed()))?;
    write_integers(out, "kind", 1, whole(|disk| disk.kind().number().into()))?;
    write_numbers(out, "velocity", 3, disks.iter().flat_map(|disk| in_space(disk.velocity())))?;
    write_numbers(out, "angle", 1, number(Disk::angle))?;
    write_numbers(out, "angular_velocity", 1, number(Disk::angular_velocity))?;
    write_numbers(out, "radius", 1, number(Disk::radius))?;
    write_numbers(out, "mass", 1, number(Disk::mass))?;
    write_numbers(out, "inertia_factor", 1, number(Disk::inertia_factor))?;
    let images = disks.iter().flat_map(|disk| disk.image().map(i64::from));
    write_integers(out, "image", 2, images)?;
    let unwrapped = |disk| domain.map_or(Disk::position(disk), |domain| domain.unwrapped(disk));
    write_numbers(out, "unwrapped", 3, disks.iter().flat_map(|disk| in_space(unwrapped(disk))))?;
    out.write_all(b"</PointData>\n<Points>\n")?;
    write_numbers(out, "Points", 3, disks.iter().flat_map(|disk| in_space(disk.position())))?;
    out.write_all(b"</Points>\n<Verts>\n")?;
    write_integers(out, "connectivity", 1, (0_i64..).take(count))?;
    write_integers(out, "offsets", 1, (1_i64..).take(count))?;
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
    write_integers(out, "periodic", 1, periodic)?;
    write_integers(out, "part", 1, (0..lines).map(|line| i64::from(line >= edges)))?;
    out.write_all(b"</CellData>\n<Points>\n")?;
    write_numbers(out, "Points", 3, points().flat_map(in_space))?;
    out.write_all(b"</Points>\n<Lines>\n")?;
    let ends = (0_i64..).take(edges).flat_map(|line| [line, (line + 1) % 4]);
    write_integers(out, "connectivity", 1, ends.chain((4_i64..).take(points_count - 4)))?;
    let sizes = (0..edges).map(|_| 2).chain(walls.iter().map(Vec::len));
    let offsets = sizes.scan(0, |sum, size| {
        *sum += i64::try_from(size).unwrap_or(i64::MAX);
        Some(*sum)
    });
    write_integers(out, "offsets", 1, offsets)?;
    out.write_all(b"</Lines>\n")?;
    out.write_all(TAIL.as_bytes())
}

fn write_time(out: &mut dyn Write, time: Option<f64>) -> io::Result<()> {
    let Some(time) = time else { return Ok(()) };
    out.write_all(b"<FieldData>\n")?;
    write_field(out, "TimeValue", time)?;
    out.write_all(b"</FieldData>\n")
}

/// Returns a vector of the plane with a third component 0.
fn in_space(vector: DVec2) -> [f64; 3] {
    [vector.x, vector.y, 0.0]
}
