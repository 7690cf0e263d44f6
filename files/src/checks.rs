//! Checks of the disks of a file: against each other, for overlaps, and against their box.

use std::collections::HashMap;

use granular_edmd::Disk;
use granular_edmd::boundary::Domain;
use granular_edmd::glam::DVec2;

use super::errors::rounded;
use super::table::Settings;
use super::{ReadError, State};

/// Disks of similar size, in squares a little wider than the largest disk.
///
/// With squares for one size only, a single giant would make every disk a neighbor of every other.
struct Class {
    side: f64,
    /// The disks in each square, by the column and row of the square. Both are whole floating-point numbers,
    /// which do not overflow; the keys are their bits.
    squares: HashMap<[u64; 2], Vec<usize>>,
}

impl Class {
    /// Creates the class whose largest disk has this radius. The excess over a diameter covers rounding.
    fn new(radius: f64) -> Self {
        Self { side: 2.001 * radius, squares: HashMap::new() }
    }

    /// Returns whether the class has room for a disk of this radius. The disks of the class are at least as
    /// large.
    fn takes(&self, radius: f64) -> bool {
        8.0 * radius > self.side
    }

    fn square(&self, place: DVec2) -> DVec2 {
        (place / self.side).floor()
    }

    /// Returns the disks in the square of a position and in the eight squares around it.
    fn near(&self, place: DVec2) -> impl Iterator<Item = usize> {
        let middle = self.square(place);
        let squares =
            (0..9).map(move |n| key(middle + DVec2::new(f64::from(n % 3 - 1), f64::from(n / 3 - 1))));
        squares.filter_map(|key| self.squares.get(&key)).flatten().copied()
    }
}

/// Returns the numbers of a square as a key. Adding 0 turns −0 into 0.
fn key(square: DVec2) -> [u64; 2] {
    [(square.x + 0.0).to_bits(), (square.y + 0.0).to_bits()]
}

/// The overlaps found so far.
#[derive(Debug, Clone, Copy)]
struct Overlap {
    /// Indices of the two disks that overlap most, in units of the sum of their radii.
    pair: [usize; 2],
    depth: f64,
    /// Depth in units of the sum of the radii.
    share: f64,
    /// Number of all overlaps.
    count: usize,
    /// True if all overlaps are counted. If very many disks lie at one place, there are too many overlaps to
    /// count.
    is_counted: bool,
}

/// Largest number of overlaps per disk that are counted. Disks that overlap only a little have at most three
/// each.
const MOST: usize = 8;

/// Returns the displacements of the nearest periodic images of a box, the first of which is zero.
fn images(periods: DVec2) -> Vec<DVec2> {
    let [columns, rows] =
        periods.to_array().map(|period| if period > 0.0 { vec![0.0, -period, period] } else { vec![0.0] });
    columns.iter().flat_map(|&x| rows.iter().map(move |&y| DVec2::new(x, y))).collect()
}

/// Returns the deepest overlap beyond this share of the sum of radii, or `None` if all are smaller.
///
/// The disks are taken in the order of their sizes, the largest first, and each is compared with the disks
/// before it. As long as these overlap little, a square holds only a few of them.
fn deepest(disks: &[Disk], domain: Option<&Domain>, least: f64) -> Option<Overlap> {
    let shifts = images(domain.map_or(DVec2::ZERO, Domain::periods));
    let mut order: Vec<usize> = (0..disks.len()).collect();
    order.sort_by(|&a, &b| disks[b].radius().total_cmp(&disks[a].radius()));
    let mut classes: Vec<Class> = Vec::new();
    let mut found: Option<Overlap> = None;
    for index in order {
        let disk = &disks[index];
        for (class, shift) in classes.iter().flat_map(|class| shifts.iter().map(move |shift| (class, shift)))
        {
            let place = disk.position() + shift;
            if *shift != DVec2::ZERO && !domain.is_some_and(|domain| domain.contains(place, class.side)) {
                continue;
            }
            for other in class.near(place).filter(|&other| other != index) {
                let contact = disk.radius() + disks[other].radius();
                let depth = contact - place.distance(disks[other].position());
                if depth <= least * contact {
                    continue;
                }
                let share = depth / contact;
                let count = found.map_or(1, |found| found.count + 1);
                let is_counted = count <= MOST * disks.len();
                let here = Overlap { pair: [index, other], depth, share, count, is_counted };
                let deepest = found.filter(|found| found.share >= share).unwrap_or(here);
                found = Some(Overlap { count, is_counted, ..deepest });
                if !is_counted {
                    return found;
                }
            }
        }
        if !classes.last().is_some_and(|class| class.takes(disk.radius())) {
            classes.push(Class::new(disk.radius()));
        }
        if let Some(class) = classes.last_mut() {
            let key = key(class.square(disk.position()));
            class.squares.entry(key).or_default().push(index);
        }
    }
    found
}

/// Largest overlap that a simulation still counts as touching, relative to the sum of the radii.
const TOUCHING: f64 = 1e-10;

/// Checks the disks of a state, with the lines from which they were read.
///
/// Disks outside of periodic sides are moved into the box. If the settings say so, radii shrink until no
/// disks overlap; otherwise none may overlap by more than the tolerance.
pub(super) fn settle(state: &mut State, lines: &[usize], settings: &Settings) -> Result<(), ReadError> {
    let accepted = settings.tolerance.unwrap_or_default().max(TOUCHING);
    if let Some(domain) = state.domain {
        let mut wrapped = 0;
        for (disk, &line) in state.disks.iter_mut().zip(lines) {
            fit(disk, &domain, line)?;
            wrapped += usize::from(enter(disk, &domain, accepted, line)?);
        }
        if wrapped > 0 {
            state.notes.push(format!("disks outside of periodic sides, wrapped: {wrapped}"));
        }
    }
    let least = if settings.shrinks { TOUCHING } else { accepted };
    let Some(found) = deepest(&state.disks, state.domain.as_ref(), least) else { return Ok(()) };
    let Overlap { pair: [a, b], depth, share, count, is_counted } = found;
    let is_small = share <= DEEPEST && settings.tolerance.is_none_or(|tolerance| share <= tolerance);
    if !(settings.shrinks && is_small && is_counted) {
        let [line, other] = [lines[a].max(lines[b]), lines[a].min(lines[b])];
        let advice = advice(share, settings);
        return Err(ReadError::Overlap { line, other, depth, share, count, advice });
    }
    for (disk, &line) in state.disks.iter_mut().zip(lines) {
        *disk = disk
            .with_radius(disk.radius() * (1.0 - share))
            .map_err(|source| ReadError::Disk { line, source })?;
    }
    state.shrunk = share;
    let shown = rounded(share);
    state.notes.push(format!("all radii are shrunk by the deepest overlap, a share of {shown:?}"));
    Ok(())
}

/// Deepest overlap for which radii shrink, as a share of the sum of the radii.
const DEEPEST: f64 = 0.5;

/// Returns the settings that accept overlaps as deep as this.
fn advice(share: f64, settings: &Settings) -> &'static str {
    match (settings.tolerance, settings.shrinks) {
        _ if share > DEEPEST => "two disks lie nearly at the same place",
        (_, false) => "set a tolerance or shrink the radii to accept them",
        (Some(_), true) => "a larger tolerance accepts them",
        (None, true) => "there are too many of them to shrink radii",
    }
}

/// Checks that no id appears twice. Ids that count from 0 are raised by 1, since the id 0 means that a disk
/// has no id.
pub(super) fn number(disks: &mut [Disk], lines: &[usize]) -> Result<bool, ReadError> {
    let mut order: Vec<usize> = (0..disks.len()).collect();
    order.sort_by_key(|&index| disks[index].id());
    if let Some(pair) = order.windows(2).find(|pair| disks[pair[0]].id() == disks[pair[1]].id()) {
        let (first, line, id) = (lines[pair[0]], lines[pair[1]], disks[pair[0]].id());
        return Err(ReadError::Doubled { line, first, what: format!("the disk {id}") });
    }
    let has_zero = order.first().is_some_and(|&index| disks[index].id() == 0);
    if has_zero {
        for (disk, &line) in disks.iter_mut().zip(lines) {
            *disk = disk.with_id(disk.id() + 1).map_err(|source| ReadError::Disk { line, source })?;
        }
    }
    Ok(has_zero)
}

/// Checks that a disk does not overlap its own images.
fn fit(disk: &Disk, domain: &Domain, line: usize) -> Result<(), ReadError> {
    let (width, periods) = (2.0 * disk.radius(), domain.periods().to_array());
    let is_narrow = |period: &f64| *period > 0.0 && width > period * (1.0 + TOUCHING);
    let Some(period) = periods.into_iter().find(is_narrow) else { return Ok(()) };
    let requirement = format!("at most {period}, a period of the box");
    Err(ReadError::unexpected(line, "the diameter of the disk", requirement, width.to_string()))
}

/// Numbers of periods that a disk can have passed.
pub(super) const IMAGES: std::ops::RangeInclusive<f64> = -2_147_483_648.0..=2_147_483_647.0;

/// Moves a disk into its box by whole periods, and returns whether it was outside.
fn enter(disk: &mut Disk, domain: &Domain, accepted: f64, line: usize) -> Result<bool, ReadError> {
    if domain.contains(disk.position(), TOUCHING * disk.radius()) {
        return Ok(false);
    }
    let place = domain.wrapped(disk.position());
    let outside = ReadError::Outside { line, x: disk.position().x, y: disk.position().y };
    if !domain.contains(place, accepted * disk.radius()) {
        return Err(outside);
    }
    let periods = domain.periods();
    let passed = |axis: usize| {
        let moved = disk.position()[axis] - place[axis];
        let passed = if periods[axis] > 0.0 { (moved / periods[axis]).round() } else { 0.0 };
        let image = f64::from(disk.image()[axis]) + passed;
        IMAGES.contains(&image).then_some(image as i32)
    };
    let (Some(right), Some(up)) = (passed(0), passed(1)) else { return Err(outside) };
    let moved = disk.with_position(place).map_err(|source| ReadError::Disk { line, source })?;
    let was_outside = [right, up] != disk.image();
    *disk = moved.with_image([right, up]);
    Ok(was_outside)
}
