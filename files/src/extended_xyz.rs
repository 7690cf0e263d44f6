//! The extended XYZ format, which OVITO reads and from which a run can start.

mod read;

pub(super) use read::frames;

use std::io::{self, BufRead, Write};

use granular_edmd::boundary::Domain;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::Snapshot;
use granular_edmd::{Disk, Gravity};

use super::format::{half_turn, numbered, shown_depth, shown_top};
use super::format::{no_frame, skip_lines, whole_line};
use super::{Frame, FrameFormat};

/// The extended XYZ format: a number of disks, a line of keys, and a line for each disk.
///
/// | column | |
/// |---|---|
/// | `species` | symbol of the element whose number is the kind: `X` for 0, `H` for 1; `X` beyond 118 |
/// | `pos` | position of the center; `z` is 0 |
/// | `kind`, `id` | number of the [`Kind`](granular_edmd::Kind); id of the disk in the run |
/// | `velo` | velocity of the center |
/// | `orientation` | turn about the third axis, as a quaternion with the real part last |
/// | `omega` | angular velocity about each axis in radians, counterclockwise; the last is the disk's |
/// | `angle` | in radians, counterclockwise; not reduced |
/// | `radius`, `mass`, `inertia_factor` | as in [`Disk`] |
/// | `image` | periods that the disk has passed to the right and up, from [`Disk::image`] |
/// | `unwrapped` | position from [`Domain::unwrapped`] |
///
/// ASE, chemfiles, MDAnalysis and OVITO agree on the meaning of the columns that they know. Symbols of
/// elements are written because ASE accepts nothing else.
///
/// The keys are `Lattice`, `Origin` and `pbc`, which OVITO knows, and `Time`, `Gravity` and `Domain` (left,
/// right, bottom and top, where an open top is `inf`). Gravity is one number if it points down, and otherwise
/// the two components of the acceleration. The lattice of an open box ends above the highest disk. `Walls`
/// has four numbers for each wall that moves, as [`Snapshot::moving_walls`] gives them: index, displacement
/// to the right and up, and phase.
///
/// [`Snapshot::moving_walls`]: granular_edmd::observable::Snapshot::moving_walls
///
/// A [`Reader`](super::Reader) reads the disks back to the same bits.
///
/// ```
/// use granular_edmd::Disk;
/// use granular_edmd::boundary::Domain;
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::observable::Snapshot;
/// use granular_edmd_files::{ExtendedXyz, Frame, FrameFormat, Reader};
///
/// let disks = [Disk::new(DVec2::new(0.1, 0.7), 0.5)?.with_velocity(DVec2::new(1.0 / 3.0, -2.0))?];
/// let snapshot = Snapshot::new(12.5, &disks, Domain::new(-1.0, 4.0, 0.0, f64::INFINITY), 1.0);
/// let mut text = Vec::new();
/// ExtendedXyz.write_frame(&Frame::new(0, &snapshot), &mut text)?;
/// let state = Reader::new().read_from(text.as_slice())?;
/// assert_eq!((state.disks(), state.time()), ([disks[0].with_id(1)?].as_slice(), Some(12.5)));
/// assert_eq!(state.domain(), Some(snapshot.domain()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
pub struct ExtendedXyz;

/// Columns of each disk.
const PROPERTIES: &str = "species:S:1:pos:R:3:kind:I:1:id:I:1:velo:R:3:orientation:R:4:omega:R:3:angle:R:1:\
     radius:R:1:mass:R:1:inertia_factor:R:1:image:I:2:unwrapped:R:2";

/// Symbols of the elements by their numbers; `X` stands for no element.
const SYMBOLS: &str = "X H He Li Be B C N O F Ne Na Mg Al Si P S Cl Ar K Ca Sc Ti V Cr Mn Fe Co Ni Cu Zn Ga Ge As Se \
    Br Kr Rb Sr Y Zr Nb Mo Tc Ru Rh Pd Ag Cd In Sn Sb Te I Xe Cs Ba La Ce Pr Nd Pm Sm Eu Gd Tb Dy Ho Er Tm Yb Lu \
    Hf Ta W Re Os Ir Pt Au Hg Tl Pb Bi Po At Rn Fr Ra Ac Th Pa U Np Pu Am Cm Bk Cf Es Fm Md No Lr Rf Db Sg Bh Hs \
    Mt Ds Rg Cn Nh Fl Mc Lv Ts Og";

impl FrameFormat for ExtendedXyz {
    fn write_frame(&self, frame: &Frame<'_>, out: &mut dyn Write) -> io::Result<()> {
        let snapshot = frame.snapshot();
        let (domain, disks) = (snapshot.domain(), snapshot.disks());
        let Domain { left, right, bottom, top, .. } = domain;
        let height = shown_top(&domain, disks) - bottom;
        let depth = shown_depth(disks);
        writeln!(out, "{}", disks.len())?;
        write!(out, "Lattice=\"{:?} 0.0 0.0 0.0 {height:?} 0.0 0.0 0.0 {depth:?}\" ", domain.width())?;
        write!(out, "Origin=\"{left:?} {bottom:?} {:?}\" ", -0.5 * depth)?;
        write!(out, "pbc=\"{} {} F\" ", letter(domain.periodic_sides), letter(domain.periodic_ends))?;
        write!(out, "Properties={PROPERTIES} Time={:?} Gravity=", snapshot.time())?;
        write_gravity(out, snapshot.gravity())?;
        write!(out, " Domain=\"{left:?} {right:?} {bottom:?} {top:?}\"")?;
        write_walls(out, snapshot)?;
        let symbols: Vec<&str> = SYMBOLS.split(' ').collect();
        numbered(disks).try_for_each(|(id, disk)| {
            let symbol = symbols.get(usize::from(disk.kind().number())).unwrap_or(&symbols[0]);
            write!(out, "\n{symbol} ")?;
            write_disk(out, id, disk, &domain)
        })?;
        writeln!(out)
    }

    fn skip_frame(&self, input: &mut dyn BufRead) -> io::Result<Option<f64>> {
        let Some(count) = whole_line(input)? else { return Ok(None) };
        let count: usize = count.trim().parse().map_err(|_| no_frame("a number of disks", &count))?;
        let Some(keys) = whole_line(input)? else { return Ok(None) };
        let time = read::Keys::parse(&keys, 0)
            .and_then(|keys| keys.time())
            .ok()
            .flatten()
            .ok_or_else(|| no_frame("the key `Time` and a number", &keys))?;
        let properties = keys.split_once(" Properties=").map_or("", |(_, after)| after);
        if properties.split(' ').next() != Some(PROPERTIES) {
            return Err(no_frame("the columns of this version", properties));
        }
        Ok(skip_lines(input, count)?.then_some(time))
    }
}

/// Writes one number, the strength, if gravity points down, and both components of the acceleration
/// otherwise.
fn write_gravity(out: &mut dyn Write, gravity: Gravity) -> io::Result<()> {
    if gravity.rightward() == 0.0 {
        return write!(out, "{:?}", gravity.downward());
    }
    let DVec2 { x, y } = gravity.acceleration();
    write!(out, "\"{x:?} {y:?}\"")
}

fn write_walls(out: &mut dyn Write, snapshot: &Snapshot<'_>) -> io::Result<()> {
    let mut before = " Walls=\"";
    for (wall, displacement, phase) in snapshot.moving_walls() {
        write!(out, "{before}{wall} {:?} {:?} {phase:?}", displacement.x, displacement.y)?;
        before = " ";
    }
    if before == " " { write!(out, "\"") } else { Ok(()) }
}

fn write_disk(out: &mut dyn Write, id: u64, disk: &Disk, domain: &Domain) -> io::Result<()> {
    let (position, velocity, unwrapped) = (disk.position(), disk.velocity(), domain.unwrapped(disk));
    let ([right, up], [real, third]) = (disk.image(), half_turn(disk));
    write!(out, "{:?} {:?} 0.0 {} {id} ", position.x, position.y, disk.kind().number())?;
    write!(out, "{:?} {:?} 0.0 0.0 0.0 {third:?} {real:?} ", velocity.x, velocity.y)?;
    write!(out, "0.0 0.0 {:?} {:?} ", disk.angular_velocity(), disk.angle())?;
    write!(out, "{:?} {:?} {:?} ", disk.radius(), disk.mass(), disk.inertia_factor())?;
    write!(out, "{right} {up} {:?} {:?}", unwrapped.x, unwrapped.y)
}

const fn letter(is_periodic: bool) -> char {
    if is_periodic { 'T' } else { 'F' }
}
