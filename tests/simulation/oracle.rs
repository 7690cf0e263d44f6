//! An independent simulation without cells, slots and frames. It tries all pairs and all walls at each event.

use granular_edmd::boundary::Container;
use granular_edmd::collision::{Elastic, Encounter, collide, collide_with_wall};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, Partner};
use granular_edmd::{Disk, Gravity, Simulation, initial};
use proptest::prelude::*;

use crate::setups::{Log, config};

const WIDTH: f64 = 30.0;
const HEIGHT: f64 = 24.0;

struct Naive {
    time: f64,
    gravity: Gravity,
    periodic: [bool; 2],
    disks: Vec<Disk>,
}

/// The first positive root of $`a t^2 + 2 b t + c`$ that is reached from above.
fn first_root(a: f64, b: f64, c: f64) -> f64 {
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return f64::INFINITY;
    }
    let root = discriminant.sqrt();
    let falling = if a == 0.0 { if b < 0.0 { -0.5 * c / b } else { f64::INFINITY } } else { (-b - root) / a };
    if falling > 0.0 { falling } else { f64::INFINITY }
}

impl Naive {
    fn images(&self) -> Vec<DVec2> {
        let along = |is_periodic: bool| if is_periodic { vec![-1.0, 0.0, 1.0] } else { vec![0.0] };
        let [columns, rows] = self.periodic.map(along);
        let image = |&x: &f64| rows.iter().map(move |y| DVec2::new(x * WIDTH, y * HEIGHT));
        columns.iter().flat_map(image).collect()
    }

    /// Returns the time at which a pair meets, with its second disk moved by `image`.
    fn pair(&self, i: usize, j: usize, image: DVec2) -> f64 {
        let (a, b) = (&self.disks[i], &self.disks[j]);
        let (r, v) = (b.position() + image - a.position(), b.velocity() - a.velocity());
        let contact = a.radius() + b.radius();
        if r.dot(v) >= 0.0 {
            return f64::INFINITY;
        }
        first_root(v.length_squared(), r.dot(v), (r.length() - contact) * (r.length() + contact))
    }

    /// Returns the time at which a disk meets a wall with this normal and offset.
    fn wall(&self, i: usize, normal: DVec2, offset: f64) -> f64 {
        let disk = &self.disks[i];
        let gap = disk.position().dot(normal) - offset - disk.radius();
        let (rate, pull) = (disk.velocity().dot(normal), self.gravity.acceleration().dot(normal));
        if pull < 0.0 {
            // The disk goes up and down again, so the later root counts. A disk that has just left the wall
            // has a gap of rounding.
            let root = (rate * rate - 2.0 * pull * gap.max(0.0)).sqrt();
            return (rate + root) / -pull;
        }
        if rate >= 0.0 { f64::INFINITY } else { first_root(0.5 * pull, 0.5 * rate, gap).max(0.0) }
    }

    fn walls(&self) -> Vec<(DVec2, f64)> {
        let level = [(DVec2::Y, 0.0), (DVec2::NEG_Y, -HEIGHT)];
        let sides = [(DVec2::X, 0.0), (DVec2::NEG_X, -WIDTH)];
        let walls = |walls: [_; 2], is_periodic: bool| if is_periodic { Vec::new() } else { walls.to_vec() };
        [walls(level, self.periodic[1]), walls(sides, self.periodic[0])].concat()
    }

    /// Returns the next event: its time, its disk, and its partner (a disk or a wall).
    fn next(&self) -> (f64, usize, Result<usize, usize>) {
        let mut first = (f64::INFINITY, 0, Err(0));
        for i in 0..self.disks.len() {
            for j in 0..i {
                for image in self.images() {
                    let wait = self.pair(i, j, image);
                    if wait < first.0 {
                        first = (wait, i, Ok(j));
                    }
                }
            }
            for (k, (normal, offset)) in self.walls().into_iter().enumerate() {
                let wait = self.wall(i, normal, offset);
                if wait < first.0 {
                    first = (wait, i, Err(k));
                }
            }
        }
        first
    }

    fn advance(&mut self, wait: f64) {
        let fall = self.gravity.acceleration();
        for disk in &mut self.disks {
            let mut position = disk.position() + wait * (disk.velocity() + 0.5 * wait * fall);
            if self.periodic[0] {
                position.x = position.x.rem_euclid(WIDTH);
            }
            if self.periodic[1] {
                position.y = position.y.rem_euclid(HEIGHT);
            }
            *disk =
                disk.with_velocity(disk.velocity() + wait * fall).unwrap().with_position(position).unwrap();
        }
        self.time += wait;
    }

    /// Does the next event. Returns its time and its partners in order (a wall counts from 1000).
    fn step(&mut self) -> (f64, usize, usize) {
        let (wait, i, partner) = self.next();
        self.advance(wait);
        match partner {
            Ok(j) => {
                let (a, b) = (self.disks[i], self.disks[j]);
                let turns = ((b.position() - a.position()) / DVec2::new(WIDTH, HEIGHT)).round();
                let [x, y] = self.periodic.map(f64::from);
                let shift = turns * DVec2::new(x * WIDTH, y * HEIGHT);
                let near = b.with_position(b.position() - shift).unwrap();
                let Encounter { first: a, second: near, .. } = collide(&Elastic, &a, &near);
                self.disks[i] = a;
                self.disks[j] = near.with_position(b.position()).unwrap();
                (self.time, j, i)
            }
            Err(k) => {
                let (normal, _) = self.walls()[k];
                self.disks[i] = collide_with_wall(&Elastic, &self.disks[i], normal, DVec2::ZERO).disk;
                (self.time, i, 1000)
            }
        }
    }
}

fn partners(collision: &Collision) -> (usize, usize) {
    match collision.partner {
        Partner::Disk(other) => (collision.disk.min(other), collision.disk.max(other)),
        Partner::Wall(_) => (collision.disk, 1000),
    }
}

proptest! {
    #![proptest_config(config(40))]

    #[test]
    fn the_engine_does_what_brute_force_does(
        periodic in any::<[bool; 2]>(),
        gravity in prop_oneof![Just(0.0.into()), Just(0.1.into()), Just(1.0.into()), Just(Gravity::tilted(1.0, 0.7).unwrap()), Just(Gravity::tilted(-0.5, 0.6).unwrap())],
        smallest in prop_oneof![Just(0.5), Just(0.05), Just(0.01)],
        seed in any::<u64>(),
    ) {
        let container = Container::closed(WIDTH, HEIGHT).unwrap();
        let boundary = if periodic[0] { container.with_periodic_sides().unwrap() } else { container };
        let boundary = if periodic[1] { boundary.with_periodic_ends().unwrap() } else { boundary };
        // The disks go from grains of dust to stones of fifty (and five, and one) times their size.
        let radius = |k: usize| if k.is_multiple_of(5) { 2.5 } else { smallest * (1.0 + k as f64 / 40.0) };
        let disks = (0..30).map(|k| Disk::new(DVec2::ZERO, radius(k)).unwrap()).collect();
        let disks = initial::scattered_mix(&boundary, disks, HEIGHT, seed).unwrap();
        let disks = initial::with_maxwellian_velocities(disks, 1.0, seed).unwrap();
        let mut naive = Naive { time: 0.0, gravity, periodic, disks: disks.clone() };
        let mut simulation = Simulation::builder(Elastic, boundary).disks(disks).gravity(gravity).build().unwrap();
        let mut log = Log(Vec::new());
        // The run is short, since each collision multiplies a difference of rounding by the flight over the
        // radius: tenfold at least, a thousandfold for a grain of dust. Three of those make 1e-7 of 1e-16.
        while log.0.len() < 60 {
            simulation.step_until(simulation.time() + 1.0, &mut log).unwrap();
        }
        for collision in &log.0[..60] {
            let (time, first, second) = naive.step();
            prop_assert_eq!(partners(collision), (first, second), "at {} and {}", collision.time, time);
            prop_assert!((collision.time - time).abs() < 1e-6, "{} {}", collision.time, time);
        }
    }
}
