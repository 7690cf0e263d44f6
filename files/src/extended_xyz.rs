//! The extended XYZ format, which OVITO reads and from which a run can start.

use std::collections::BTreeSet;
use std::io::{self, BufRead, Write};

use granular_edmd::boundary::Domain;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::Snapshot;
use granular_edmd::{Disk, Gravity};

use super::format::{half_turn, no_frame, numbered, shown_depth, shown_top, skip_lines, whole_line};
use super::{Frame, FrameFormat};
use crate::ReadError;
use crate::column::{Column, Quantity, plain};
use crate::lines::{Input, Text, checked_box, finite, is_upright, number};
use crate::table::{Found, Table};

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
        let time = Keys::parse(&keys, 0)
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

/// Largest number of columns of a disk. Without a limit, a few characters in a file could ask for any number
/// of columns.
const MOST_COLUMNS: usize = 1000;

/// The keys that the reader understands.
const KNOWN: [&str; 8] = ["Properties", "Time", "t", "Gravity", "Domain", "Lattice", "Origin", "pbc"];

/// The keys of a frame with their values, without quotes.
struct Keys<'a> {
    pairs: Vec<(&'a str, &'a str)>,
    line: usize,
}

impl<'a> Keys<'a> {
    /// Divides a line into keys and values. Words without a value are ignored.
    fn parse(text: &'a str, line: usize) -> Result<Self, ReadError> {
        let (mut pairs, mut rest) = (Vec::new(), text.trim());
        while !rest.is_empty() {
            let (name, after) = word(rest, |letter| letter == '=' || letter.is_whitespace())
                .unwrap_or_else(|| rest.split_at(rest.len()));
            rest = after.trim_start();
            let Some(after) = rest.strip_prefix('=').map(str::trim_start) else { continue };
            let (value, after) = word(after, char::is_whitespace).ok_or_else(|| {
                ReadError::unexpected(line, format!("the value of `{name}`"), "within two quotes", after)
            })?;
            pairs.push((name, value.trim_end_matches(',')));
            rest = after.trim_start();
        }
        Ok(Self { pairs, line })
    }

    /// Returns the names of the keys that the reader does not understand, each of them once.
    fn ignored(&self) -> impl Iterator<Item = String> {
        let names: BTreeSet<&str> = self.pairs.iter().map(|(name, _)| *name).collect();
        names.into_iter().filter(|name| !is_one_of(name, &KNOWN)).map(str::to_owned)
    }

    /// Returns the value of a key that may have several names.
    fn value(&self, names: &[&str]) -> Result<Option<&'a str>, ReadError> {
        let mut found = self.pairs.iter().filter(|(name, _)| is_one_of(name, names));
        let first = found.next();
        match found.find(|(_, value)| first.is_some_and(|(_, first)| first != value)) {
            None => Ok(first.map(|(_, value)| *value)),
            Some((name, _)) => {
                let what = format!("the key `{name}`");
                Err(ReadError::Doubled { line: self.line, first: self.line, what })
            }
        }
    }

    /// Returns the time, if the frame has it.
    fn time(&self) -> Result<Option<f64>, ReadError> {
        self.value(&["Time", "t"])?.map(|value| finite("Time", value, self.line)).transpose()
    }

    /// Returns an empty table with the columns of the frame.
    fn table(&self) -> Result<Table, ReadError> {
        let properties = self.value(&["Properties"])?;
        let columns = columns(properties.unwrap_or("species:S:1:pos:R:3"), self.line)?;
        let mut table = Table::new(columns, self.line);
        match self.time() {
            // The comment of a plain XYZ file may hold anything.
            Err(ReadError::Unexpected { found, .. }) if properties.is_none() => {
                table.notes.push(format!("the time {found:?} is no number, and ignored"));
            }
            time => table.time = time?,
        }
        table.gravity = self.value(&["Gravity"])?.map(|value| self.gravity(value)).transpose()?;
        table.domain = self.domain(&mut table.notes)?;
        table.is_own = self.value(&["Domain"])?.is_some();
        Ok(table)
    }

    /// Reads gravity: a number for gravity that points down, or both components of the acceleration.
    fn gravity(&self, value: &str) -> Result<Gravity, ReadError> {
        let finite = || value_words(value).map(|value| finite("Gravity", value, self.line));
        match finite().collect::<Result<Vec<f64>, _>>()?[..] {
            [downward] => Ok(downward.into()),
            [x, y] => Ok(DVec2::new(x, y).into()),
            _ => Err(ReadError::unexpected(self.line, "Gravity", "1 or 2 numbers", value)),
        }
    }

    /// Returns the box from the key `Domain`, which this crate writes, or else from the lattice.
    fn domain(&self, notes: &mut Vec<String>) -> Result<Option<Domain>, ReadError> {
        let (own, lattice) = (self.value(&["Domain"])?, self.value(&["Lattice"])?);
        let domain = match (own, lattice) {
            (Some(domain), _) => {
                let [left, right, bottom, top] = self.numbers("Domain", domain, "4 numbers")?[..] else {
                    return Err(ReadError::unexpected(self.line, "Domain", "4 numbers", domain));
                };
                Domain::new(left, right, bottom, top)
            }
            (None, Some(lattice)) => self.of_lattice(lattice)?,
            (None, None) => return Ok(None),
        };
        let domain = match self.value(&["pbc"])? {
            Some(pbc) => self.periodic(domain, pbc)?,
            None if own.is_some() => domain,
            None => {
                notes.push("all sides of the lattice are periodic, since the file has no `pbc`".to_owned());
                domain.with_periodic_sides().with_periodic_ends()
            }
        };
        checked_box(domain, self.line).map(Some)
    }

    /// Returns the rectangle of a lattice: two or three vectors, or their lengths along the axes.
    fn of_lattice(&self, lattice: &str) -> Result<Domain, ReadError> {
        let numbers = "2, 3, 4 or 9 numbers";
        let (sides, tilts) = match self.numbers("Lattice", lattice, numbers)?[..] {
            [width, height] | [width, height, _] => ([width, height], [0.0; 4]),
            [width, a, b, height] => ([width, height], [a, 0.0, b, 0.0]),
            [width, a, b, c, height, d, _, _, _] => ([width, height], [a, b, c, d]),
            _ => return Err(ReadError::unexpected(self.line, "Lattice", numbers, lattice)),
        };
        if !is_upright(sides, tilts) {
            return Err(ReadError::unexpected(self.line, "Lattice", "a rectangle", lattice));
        }
        let origin = self.value(&["Origin"])?.unwrap_or("0 0 0");
        let [left, bottom, _] = self.numbers("Origin", origin, "3 numbers")?[..] else {
            return Err(ReadError::unexpected(self.line, "Origin", "3 numbers", origin));
        };
        Ok(Domain::new(left, left + sides[0], bottom, bottom + sides[1]))
    }

    /// Returns the box with the periodic directions of the file.
    fn periodic(&self, mut domain: Domain, pbc: &str) -> Result<Domain, ReadError> {
        let flag = |letter: &str| match letter.to_ascii_lowercase().as_str() {
            "t" | "1" | "true" => Some(true),
            "f" | "0" | "false" => Some(false),
            _ => None,
        };
        let flags: Vec<Option<bool>> = value_words(pbc).map(flag).collect();
        let (&[Some(sides), Some(ends)] | &[Some(sides), Some(ends), Some(_)]) = flags.as_slice() else {
            return Err(ReadError::unexpected(self.line, "pbc", "three letters T or F", pbc));
        };
        (domain.periodic_sides, domain.periodic_ends) = (sides, ends);
        Ok(domain)
    }

    /// Reads numbers that are separated by white space, commas or brackets.
    fn numbers(&self, what: &str, text: &str, requirement: &str) -> Result<Vec<f64>, ReadError> {
        let numbers: Vec<f64> =
            value_words(text).map(|text| number(what, text, self.line)).collect::<Result<_, _>>()?;
        // Only the top of a box may be infinite.
        let is_finite = what == "Domain" || numbers.iter().all(|number| number.is_finite());
        is_finite.then_some(numbers).ok_or_else(|| {
            ReadError::unexpected(self.line, what, format!("{requirement}, all of them finite"), text)
        })
    }
}

/// Returns whether a name is one of these, in upper or lower case. The case of a single letter matters, since
/// `T` is a temperature.
fn is_one_of(name: &str, known: &[&str]) -> bool {
    known.iter().any(|known| *known == name || known.len() > 1 && known.eq_ignore_ascii_case(name))
}

/// Returns the first word of a text, without its quotes or brackets, and the rest of the text, or `None` if
/// the word does not end.
fn word(text: &str, ends: impl Fn(char) -> bool) -> Option<(&str, &str)> {
    let open = text.chars().next().unwrap_or(' ');
    let close = match open {
        '"' | '\'' => open,
        '{' => '}',
        '[' => ']',
        _ => return Some(text.split_at(text.find(ends).unwrap_or(text.len()))),
    };
    let (mut depth, mut is_escaped) = (0_usize, false);
    for (place, letter) in text.char_indices() {
        let is_mark = !is_escaped;
        is_escaped = is_mark && letter == '\\';
        if is_mark && letter == close && place > 0 {
            depth -= 1;
            if depth == 0 {
                return Some((&text[1..place], &text[place + close.len_utf8()..]));
            }
        } else if is_mark && letter == open {
            depth += 1;
        }
    }
    None
}

/// Returns the words of a list.
fn value_words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|letter: char| letter.is_whitespace() || ",[]{}".contains(letter))
        .filter(|word| !word.is_empty())
}

/// Returns the columns of each disk.
fn columns(properties: &str, line: usize) -> Result<Vec<Column>, ReadError> {
    let parts: Vec<&str> = properties.split(':').collect();
    let mut columns = Vec::new();
    for part in parts.chunks(3) {
        let wrong = |found: &str| {
            Err(ReadError::unexpected(line, "each of `Properties`", "a name, a type and a number", found))
        };
        let &[name, _, count] = part else { return wrong(&part.join(":")) };
        let Ok(count @ 1..=MOST_COLUMNS) = count.parse() else { return wrong(&part.join(":")) };
        if columns.len() + count > MOST_COLUMNS {
            let most = format!("of at most {MOST_COLUMNS} columns");
            return Err(ReadError::unexpected(line, "`Properties`", most, properties));
        }
        let size = Quantity::named(&plain(name)).map_or(1, Quantity::size);
        if size == 3 && count > 3 {
            return Err(ReadError::unexpected(line, name, "of 2 or 3 columns", part.join(":")));
        }
        columns.extend(Column::of(name, count));
    }
    // If another column is the vector of positions, `Z` is ASE's atomic number.
    let is = |column: &Column, name: &str| column.name.eq_ignore_ascii_case(name);
    if columns.iter().any(|column| column.slot == Quantity::Position.slot(0) && !is(column, "x")) {
        columns.iter_mut().filter(|column| is(column, "z")).for_each(|column| column.slot = None);
    }
    Ok(columns)
}

/// Reads the next frame of a file.
pub(crate) fn next<'a, R: BufRead>(input: &mut Input<R>) -> Result<Option<Found<'a>>, ReadError> {
    let Some((count, line)) = input.next_filled()? else { return Ok(None) };
    let count = count.parse().map_err(|_| {
        ReadError::unexpected(line, "the first line of a frame", "the number of its disks", &count)
    })?;
    let (keys, line) = input.need("the keys of a frame")?;
    let rows = input.copy_disks(count)?;
    Ok(Some(Found::in_text(rows, None, move |rows| table(&keys, line, rows))))
}

fn table(keys: &str, line: usize, rows: &Text) -> Result<Table, ReadError> {
    let keys = Keys::parse(keys, line)?;
    let mut table = keys.table()?;
    let has_properties = keys.value(&["Properties"])?.is_some();
    if !has_properties {
        table.advice = "; the columns of plain XYZ are a name, x, y and z, and `Properties=` names others";
    }
    // A plain XYZ file may have more columns than the usual ones.
    let known = table.columns.len();
    let most = if has_properties { usize::MAX } else { known };
    let mut widest = known;
    for (row, line) in rows.lines()? {
        table.push(row.split_whitespace().take(most), line)?;
        widest = widest.max(row.split_whitespace().count());
    }
    if widest > known {
        let first = known + 1;
        let name = if widest == first { first.to_string() } else { format!("{first} to {widest}") };
        table.columns.push(Column { name, slot: None });
    }
    table.columns.extend(keys.ignored().map(|name| Column { name, slot: None }));
    Ok(table)
}
