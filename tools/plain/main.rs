//! A plain event-driven simulation of the paper's system, with which the speed of this crate is compared. It
//! uses nothing of the crate.
//!
//! ```sh
//! # gravity, friction, inelasticity, seed, oscillations to settle, and then to measure
//! cargo run --release -p tools --bin plain -- 0.015625 0.03 0 1 2000
//! ```
//!
//! It prints the number of collisions of two disks per second, and per oscillation of the base. Everything is
//! done in the simplest way: disks of diameter and mass 1 in cells of at least a diameter, one event for each
//! disk in the binary heap of the standard library, stale entries that are skipped when they come up, and a
//! clock for each disk.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::time::Instant;

const DISKS: usize = 1000;
const WIDTH: f64 = 60.0;
const HEIGHT: f64 = 150.0;
const RADIUS: f64 = 0.5;
const AMPLITUDE: f64 = 0.1;
const PERIOD: f64 = std::f64::consts::TAU / 10.0;
const CONTACT_DURATION: f64 = 1e-5;
const COLUMNS: usize = 60;
const ROWS: usize = 150;
const SIDE: [f64; 2] = [WIDTH / COLUMNS as f64, (HEIGHT + AMPLITUDE) / ROWS as f64];

fn main() {
    let numbers: Vec<f64> = std::env::args().skip(1).filter_map(|number| number.parse().ok()).collect();
    let &[gravity, friction, inelasticity, seed, oscillations] = numbers.as_slice() else {
        eprintln!("error: needs five numbers: gravity, friction, inelasticity, seed, oscillations");
        std::process::exit(2);
    };
    let mut run = Run::new(gravity, friction, inelasticity, seed as u64);
    run.advance(oscillations * PERIOD);
    let (start, before) = (Instant::now(), run.collisions);
    run.advance(2.0 * oscillations * PERIOD);
    let collisions = (run.collisions - before) as f64;
    println!("{} {}", collisions / start.elapsed().as_secs_f64(), collisions / oscillations);
}

#[derive(Clone, Copy, PartialEq)]
enum Next {
    Disk(usize),
    Left,
    Right,
    Floor,
    Lid,
    Cell(usize),
}

/// An event of a disk, stale if the disk has had another prediction, or its partner another collision.
struct Event {
    time: f64,
    disk: usize,
    next: Next,
    prediction: u32,
    partner_collisions: u32,
}

impl PartialEq for Event {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Event {}

impl PartialOrd for Event {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The heap has the greatest on top, so the earliest event is the greatest.
impl Ord for Event {
    fn cmp(&self, other: &Self) -> Ordering {
        other.time.total_cmp(&self.time).then(other.disk.cmp(&self.disk))
    }
}

/// A disk as it was at its time.
#[derive(Clone, Copy, Default)]
struct Disk {
    time: f64,
    place: [f64; 2],
    velocity: [f64; 2],
    spin: f64,
    cell: usize,
    predictions: u32,
    collisions: u32,
    last_collision: f64,
}

struct Run {
    gravity: f64,
    friction: f64,
    inelasticity: f64,
    collisions: u64,
    disks: Vec<Disk>,
    cells: Vec<Vec<usize>>,
    events: BinaryHeap<Event>,
}

impl Run {
    /// Puts the disks on a square lattice, with velocities of a Maxwellian gas of temperature 1.
    fn new(gravity: f64, friction: f64, inelasticity: f64, seed: u64) -> Self {
        let mut random = Random(seed);
        let disks = (0..DISKS).map(|k| Disk {
            place: [0.75 + 1.1 * (k % 50) as f64, 0.75 + 1.1 * (k / 50) as f64],
            velocity: [random.normal(), random.normal()],
            last_collision: f64::NEG_INFINITY,
            ..Disk::default()
        });
        let disks: Vec<Disk> = disks.collect();
        let cells = vec![Vec::new(); COLUMNS * ROWS];
        let mut run =
            Self { gravity, friction, inelasticity, collisions: 0, disks, cells, events: BinaryHeap::new() };
        for k in 0..DISKS {
            let [x, y] = run.disks[k].place;
            let cell = (x / SIDE[0]) as usize + COLUMNS * ((y + AMPLITUDE) / SIDE[1]) as usize;
            run.disks[k].cell = cell;
            run.cells[cell].push(k);
        }
        (0..DISKS).for_each(|k| run.predict(k));
        run
    }

    /// Carries out all events before `end`.
    fn advance(&mut self, end: f64) {
        while let Some(event) = self.events.pop_if_before(end) {
            let Event { time, disk, next, prediction, partner_collisions } = event;
            if self.disks[disk].predictions != prediction {
                continue;
            }
            self.fly(disk, time);
            match next {
                Next::Disk(other) if self.disks[other].collisions == partner_collisions => {
                    self.fly(other, time);
                    self.collide(disk, other);
                    self.predict(other);
                }
                Next::Disk(_) => {}
                Next::Cell(cell) => {
                    let old = self.disks[disk].cell;
                    self.cells[old].retain(|&other| other != disk);
                    self.cells[cell].push(disk);
                    self.disks[disk].cell = cell;
                }
                wall => self.collide_with_wall(disk, wall),
            }
            self.predict(disk);
        }
    }

    /// Moves a disk to its state at a time.
    fn fly(&mut self, disk: usize, time: f64) {
        let disk = &mut self.disks[disk];
        let after = time - disk.time;
        disk.place[0] += disk.velocity[0] * after;
        disk.place[1] += (disk.velocity[1] - 0.5 * self.gravity * after) * after;
        disk.velocity[1] -= self.gravity * after;
        disk.time = time;
    }

    /// Returns position and velocity of a disk at a time.
    fn at(&self, disk: usize, time: f64) -> ([f64; 2], [f64; 2]) {
        let Disk { time: start, place: [x, y], velocity: [u, v], .. } = self.disks[disk];
        let after = time - start;
        ([x + u * after, y + (v - 0.5 * self.gravity * after) * after], [u, v - self.gravity * after])
    }

    /// Finds the next event of a disk, as if no other disk had one before.
    fn predict(&mut self, disk: usize) {
        self.disks[disk].predictions += 1;
        let Disk { time: now, place, velocity, cell, predictions: prediction, .. } = self.disks[disk];
        let (mut least, mut next) = self.exit(disk);
        let (column, row) = (cell % COLUMNS, cell / COLUMNS);
        let mut found = |after: f64, event: Next| {
            if after < least {
                (least, next) = (after, event);
            }
        };
        if column == 0 && velocity[0] < 0.0 {
            found(((RADIUS - place[0]) / velocity[0]).max(0.0), Next::Left);
        }
        if column == COLUMNS - 1 && velocity[0] > 0.0 {
            found(((WIDTH - RADIUS - place[0]) / velocity[0]).max(0.0), Next::Right);
        }
        if row == ROWS - 1 {
            let gap = (HEIGHT - RADIUS - place[1]).max(0.0);
            found(descent(gap, -velocity[1], self.gravity), Next::Lid);
        }
        if row == 0 {
            found(self.base(now, place[1], velocity[1]), Next::Floor);
        }
        for row in row.saturating_sub(1)..(row + 2).min(ROWS) {
            for column in column.saturating_sub(1)..(column + 2).min(COLUMNS) {
                for &other in self.cells[column + COLUMNS * row].iter().filter(|&&other| other != disk) {
                    let (there, its) = self.at(other, now);
                    let [x, y] = [place[0] - there[0], place[1] - there[1]];
                    let [u, v] = [velocity[0] - its[0], velocity[1] - its[1]];
                    let (closing, speed) = (x * u + y * v, u * u + v * v);
                    let gap = (x * x + y * y - 4.0 * RADIUS * RADIUS).max(0.0);
                    let square = closing * closing - speed * gap;
                    if closing < 0.0 && square > 0.0 {
                        found(gap / (square.sqrt() - closing), Next::Disk(other));
                    }
                }
            }
        }
        let partner_collisions = if let Next::Disk(other) = next { self.disks[other].collisions } else { 0 };
        self.events.push(Event { time: now + least, disk, next, prediction, partner_collisions });
    }

    /// Returns the time after which a disk leaves its cell, and the cell that it enters.
    fn exit(&self, disk: usize) -> (f64, Next) {
        let Disk { place: [x, y], velocity: [u, v], cell, .. } = self.disks[disk];
        let (column, row) = (cell % COLUMNS, cell / COLUMNS);
        let low = [column as f64 * SIDE[0], row as f64 * SIDE[1] - AMPLITUDE];
        let (mut least, mut enters) = (f64::INFINITY, cell);
        if u > 0.0 && column + 1 < COLUMNS {
            (least, enters) = (((low[0] + SIDE[0] - x) / u).max(0.0), cell + 1);
        }
        if u < 0.0 && column > 0 {
            (least, enters) = (((low[0] - x) / u).max(0.0), cell - 1);
        }
        let up = descent((low[1] + SIDE[1] - y).max(0.0), -v, self.gravity);
        let down = descent((y - low[1]).max(0.0), v, -self.gravity);
        if row + 1 < ROWS && up < least {
            (least, enters) = (up, cell + COLUMNS);
        }
        if row > 0 && down < least {
            (least, enters) = (down, cell - COLUMNS);
        }
        (least, Next::Cell(enters))
    }

    /// Returns the time after which a disk at this height meets the base: its parabolas, one after another.
    fn base(&self, now: f64, height: f64, velocity: f64) -> f64 {
        let half = 0.5 * PERIOD;
        let mut after = descent((height - RADIUS - AMPLITUDE).max(0.0), velocity, -self.gravity);
        if height - RADIUS <= AMPLITUDE {
            after = 0.0;
        }
        let mut piece = ((now + after) / half).floor();
        while after < 1e3 {
            let start = now + after;
            let (base, speed, acceleration) = base_in(piece, start);
            let gap = height + (velocity - 0.5 * self.gravity * after) * after - RADIUS - base;
            let hit =
                descent(gap.max(0.0), velocity - self.gravity * after - speed, -self.gravity - acceleration);
            let rest = (piece + 1.0) * half - start;
            if hit <= rest {
                return after + hit;
            }
            (after, piece) = (after + rest, piece + 1.0);
        }
        f64::INFINITY
    }

    /// Returns whether a disk collides for the second time within the contact duration, which loses no
    /// energy.
    fn is_again(&mut self, disk: usize) -> bool {
        let disk = &mut self.disks[disk];
        let again = disk.time - disk.last_collision < CONTACT_DURATION;
        disk.last_collision = disk.time;
        disk.collisions += 1;
        again
    }

    fn collide(&mut self, a: usize, b: usize) {
        self.collisions += 1;
        let again = self.is_again(a) | self.is_again(b);
        let (p, q) = (self.disks[a], self.disks[b]);
        let [x, y] = [q.place[0] - p.place[0], q.place[1] - p.place[1]];
        let distance = x.hypot(y);
        let normal = [x / distance, y / distance];
        let relative = [p.velocity[0] - q.velocity[0], p.velocity[1] - q.velocity[1]];
        let impulse = self.impulse(normal, relative, RADIUS * (p.spin + q.spin), again, 1.0);
        self.push(a, normal, impulse, -1.0);
        self.push(b, normal, impulse, 1.0);
    }

    fn collide_with_wall(&mut self, disk: usize, wall: Next) {
        let again = self.is_again(disk);
        let Disk { time, velocity, spin, .. } = self.disks[disk];
        let (normal, moves) = match wall {
            Next::Left => ([-1.0, 0.0], 0.0),
            Next::Right => ([1.0, 0.0], 0.0),
            Next::Lid => ([0.0, 1.0], 0.0),
            _ => ([0.0, -1.0], base_in((time / (0.5 * PERIOD)).floor(), time).1),
        };
        let relative = [velocity[0], velocity[1] - moves];
        // A wall has infinite mass, so the same change of velocity takes twice the impulse.
        let impulse = self.impulse(normal, relative, RADIUS * spin, again, 2.0);
        self.push(disk, normal, impulse, -1.0);
    }

    /// Returns the impulse along the normal and the tangent, by the paper's rule.
    fn impulse(&self, normal: [f64; 2], relative: [f64; 2], roll: f64, again: bool, mass: f64) -> [f64; 2] {
        let closing = relative[0] * normal[0] + relative[1] * normal[1];
        if again {
            return [mass * closing, 0.0];
        }
        let slip = relative[1] * normal[0] - relative[0] * normal[1] + roll;
        let along = mass * (1.0 - self.inelasticity) * closing;
        let sticking = mass * (1.0 - self.inelasticity) * slip.abs() / 3.0;
        [along, sticking.min(self.friction * along).copysign(slip)]
    }

    /// Changes velocity and spin of a disk of mass 1 and moment of inertia R²/2. The impulse acts with the
    /// other sign on the other disk, but turns both in the same sense.
    fn push(&mut self, disk: usize, normal: [f64; 2], [along, across]: [f64; 2], sign: f64) {
        let disk = &mut self.disks[disk];
        disk.velocity[0] += sign * (along * normal[0] - across * normal[1]);
        disk.velocity[1] += sign * (along * normal[1] + across * normal[0]);
        disk.spin -= 2.0 * across / RADIUS;
    }
}

/// Height, velocity and acceleration of the base in one of its parabolas, at a time in it.
fn base_in(piece: f64, time: f64) -> (f64, f64, f64) {
    let half = 0.5 * PERIOD;
    let sign = if piece.rem_euclid(2.0) < 1.0 { 1.0 } else { -1.0 };
    let phase = (time - piece * half) / half;
    let factor = 4.0 * sign * AMPLITUDE;
    (factor * phase * (1.0 - phase), factor * (1.0 - 2.0 * phase) / half, -2.0 * factor / (half * half))
}

/// Returns the first time after which a gap that is not negative has closed, with its velocity and its
/// acceleration, or infinity. A gap of zero that opens has not closed.
fn descent(gap: f64, velocity: f64, acceleration: f64) -> f64 {
    let square = velocity * velocity - 2.0 * acceleration * gap;
    if acceleration < 0.0 {
        return (velocity + square.sqrt()) / -acceleration;
    }
    if velocity >= 0.0 || square < 0.0 { f64::INFINITY } else { 2.0 * gap / (square.sqrt() - velocity) }
}

trait Earliest {
    fn pop_if_before(&mut self, end: f64) -> Option<Event>;
}

impl Earliest for BinaryHeap<Event> {
    fn pop_if_before(&mut self, end: f64) -> Option<Event> {
        if self.peek()?.time < end { self.pop() } else { None }
    }
}

/// Random numbers by SplitMix64.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.uniform()).ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}
