//! Predictions in vector instructions. Each function computes the same bits as the plain function of the same
//! name, with its lines in the same order. The reasons for the arithmetic are given there.
//!
//! Three differences make this code faster than the plain code:
//! 1. **No read covers several recent writes.** The processor can pass a number on from a write to a read
//!    only if the write covers all of the read. Otherwise, the read waits about 15 cycles, until the writes
//!    have reached the cache, and the whole search waits with it. The compiler generates such reads from the
//!    plain code: it merges four numbers that lie side by side into one vector. The functions of
//!    [`load`](crate::instructions::load) read exactly as many numbers as their names say, and arguments come
//!    in registers or from tables, never as an array or a rectangle that was just built.
//! 2. **Two searches in one loop.** After a collision, neither of the two searches depends on the other. The
//!    root and the quotient of a search take most of its time, so one search is computed while the other
//!    waits.
//! 3. **Two exits in one vector**, with one root and two quotients for both.

pub(super) mod exits;
pub(super) mod pairs;

#[cfg(test)]
mod tests {
    use glam::DVec2;
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use crate::boundary::Container;
    use crate::instructions::Instructions;
    use crate::simulation::cells::{CellSize, Cells};
    use crate::simulation::prediction::{LANES, earliest_collision, find_partners, leave_cells};
    use crate::simulation::state::{Bodies, Earliest, Forecast};
    use crate::{Disk, Gravity};

    const SIDE: f64 = 9.0;
    const DISKS: usize = 24;

    /// Returns disks of diameter 1. Half of them take coordinates and velocities from a few values, so that
    /// many touch, overlap, rest, move alike, or meet others at the same time.
    fn bodies(generator: &mut Xoshiro256PlusPlus, gravity: f64) -> Bodies {
        let mut number = |few: bool, most: i32| {
            let coarse = f64::from(generator.random_range(-2 * most..=2 * most)) / 2.0;
            if few { coarse } else { f64::from(most) * (2.0 * generator.random::<f64>() - 1.0) }
        };
        let mut disk = |k: usize| {
            let middle = DVec2::splat(0.5 * SIDE);
            let (near, alike) = (k.is_multiple_of(2), k % 4 < 2);
            let position = middle + DVec2::new(number(near, 4), number(near, 4));
            let velocity = DVec2::new(number(alike, 1), number(alike, 1));
            Disk::new(position, 0.5).and_then(|disk| disk.with_velocity(velocity)).unwrap()
        };
        let disks: Vec<Disk> = (0..DISKS).map(&mut disk).collect();
        Bodies::new(&disks, Gravity::from(gravity))
    }

    /// Returns a list of candidates with room behind them, and their number.
    fn candidates(generator: &mut Xoshiro256PlusPlus, least: usize) -> (Vec<u32>, usize) {
        let count = generator.random_range(least..40);
        let found = (0..=count + LANES).map(|_| generator.random_range(0..DISKS as u32)).collect();
        (found, count)
    }

    fn bits(earliest: Earliest) -> (u64, u32) {
        (earliest.due.to_bits(), earliest.partner)
    }

    fn all_bits(forecast: &Forecast) -> [u64; 6] {
        let Forecast { collision_due, exit_due, partner, partner_collisions, exit, .. } = *forecast;
        let (partner, counted, exit) = (u64::from(partner), u64::from(partner_collisions), exit as u64);
        [collision_due.to_bits(), exit_due.to_bits(), partner, counted, exit, 0]
    }

    /// The test predicts about a million pairs with the instructions of each level.
    #[test]
    fn all_levels_find_the_same_partners() {
        let mut generator = Xoshiro256PlusPlus::seed_from_u64(1);
        for round in 0..30_000 {
            let bodies = bodies(&mut generator, 0.0);
            let periods = [DVec2::ZERO, DVec2::splat(SIDE), DVec2::new(SIDE, 0.0)][round % 3];
            let now = [0.0, generator.random()][round % 2];
            let ([(one, first), (two, second)], disks) = (
                [candidates(&mut generator, 0), candidates(&mut generator, 1)],
                [round % DISKS, (round + 7) % DISKS],
            );
            let known = [Earliest::NONE, Earliest { due: now + 0.5, partner: 5 }][round % 5 / 4];
            let answers = Instructions::all().into_iter().map(|level| {
                let mut found = [one.clone(), two.clone()];
                let alone =
                    earliest_collision(level, &bodies, periods, disks[0], &mut found[0], first, now, known);
                let (mut bodies, counts) = (bodies.clone(), [first.max(1), second]);
                find_partners(level, level, &mut bodies, periods, disks, &mut found, counts, now);
                (bits(alone), disks.map(|disk| all_bits(bodies.forecast(disk).unwrap())))
            });
            let answers: Vec<_> = answers.collect();
            assert!(answers.iter().all(|answer| *answer == answers[0]), "{round}: {answers:?}");
        }
    }

    #[test]
    fn all_levels_find_the_same_exits() {
        let mut generator = Xoshiro256PlusPlus::seed_from_u64(2);
        let closed = Container::closed(SIDE, SIDE).unwrap();
        for round in 0..30_000 {
            let bodies = bodies(&mut generator, [0.0, 1.0, 0.3, -0.5][round % 4]);
            let disks = (0..DISKS).map(|disk| (bodies.position(disk, 0.0), 0.5));
            let cells = Cells::new(&closed, CellSize::Small, disks, None).unwrap();
            let now = [0.0, generator.random()][round % 2];
            let answers = Instructions::all().into_iter().map(|level| {
                let mut bodies = bodies.clone();
                for disk in (0..DISKS).step_by(2) {
                    leave_cells(level, &mut bodies, &cells, disk, disk + 1, now);
                }
                bodies.particles.iter().map(|particle| all_bits(&particle.forecast)).collect::<Vec<_>>()
            });
            let answers: Vec<_> = answers.collect();
            assert!(answers.iter().all(|answer| *answer == answers[0]), "{round}");
        }
    }
}
