//! Drivings that break their contract where a check may not look.

use std::collections::HashMap;

use granular_edmd::glam::DVec2;
use granular_edmd::observable::SampleTimes;
use granular_edmd::simulation::{Driving, WhiteNoise};
use granular_edmd::{Disk, ParameterError};

use crate::faults::blind::drivings::Driven;
use crate::faults::{List, Planted, tenth};

/// Changes the disks of a kick: the disks before it, the disks after it, and the number of kicks so far.
type Change = Box<dyn Fn(&[Disk], &mut [Disk], u64) -> Result<(), ParameterError>>;

struct Changed {
    noise: WhiteNoise,
    kicks: u64,
    change: Change,
    clock: fn(&mut SampleTimes, u64),
}

impl Driving for Changed {
    fn times(&mut self) -> &mut SampleTimes {
        (self.clock)(self.noise.times(), self.kicks);
        self.noise.times()
    }

    fn kick(&mut self, disks: &mut [Disk]) -> Result<(), ParameterError> {
        let before = disks.to_vec();
        self.kicks += 1;
        self.noise.kick(disks)?;
        (self.change)(&before, disks, self.kicks)
    }
}

fn changed() -> Changed {
    let times = SampleTimes::every(0.5).expect("an interval");
    let noise = WhiteNoise::new(0.2, times, 11).expect("a strength");
    Changed { noise, kicks: 0, change: Box::new(|_, _, _| Ok(())), clock: |_, _| () }
}

type Drivings = List<Driven>;

impl Drivings {
    fn kick<F>(&mut self, family: &'static str, name: impl Into<String>, keeps_momentum: bool, change: F)
    where
        F: Fn(&[Disk], &mut [Disk], u64) -> Result<(), ParameterError> + 'static,
    {
        self.family = family;
        let driving = Box::new(Changed { change: Box::new(change), ..changed() });
        self.plant(name, Driven { driving, keeps_momentum });
    }

    fn clock(&mut self, family: &'static str, name: &str, clock: fn(&mut SampleTimes, u64)) {
        self.family = family;
        self.plant(name, Driven { driving: Box::new(Changed { clock, ..changed() }), keeps_momentum: true });
    }
}

pub(crate) fn catalogue() -> Vec<Planted<Driven>> {
    List::grown(&[disks, shares, clocks, memories])
}

fn disks(drivings: &mut Drivings) {
    drivings.kick("inertia", "each kick makes rings", false, |_, disks, _| {
        disks.iter_mut().try_for_each(|disk| disk.with_inertia_factor(1.0).map(|ring| *disk = ring))
    });
    drivings.kick("seldom moved", "kick 150 moves a disk", true, |_, disks, kicks| {
        let Some(disk) = disks.last_mut().filter(|_| kicks == 150) else { return Ok(()) };
        disk.with_position(1.000_001 * disk.position()).map(|moved| *disk = moved)
    });
    drivings.kick("image", "each kick counts a period more", true, |_, disks, _| {
        for disk in disks {
            *disk = disk.with_image([disk.image()[0] + 1, disk.image()[1]]);
        }
        Ok(())
    });
    for n in [8, 11] {
        let name = format!("one kick in ten adds a drift of 1e-{n}");
        drivings.kick("seldom drift", name, true, move |_, disks, kicks| {
            let drift = if kicks % 10 == 0 { tenth(n) } else { 0.0 };
            disks.iter_mut().try_for_each(|disk| {
                let velocity = disk.velocity() + DVec2::new(drift, 0.0);
                disk.with_velocity(velocity).map(|moved| *disk = moved)
            })
        });
    }
}

fn shares(drivings: &mut Drivings) {
    drivings.kick("last place", "the last disk gets no kick", false, |before, disks, _| {
        if let (Some(old), Some(new)) = (before.last(), disks.last_mut()) {
            *new = *old;
        }
        Ok(())
    });
    for share in [0.5, 0.8] {
        let name = format!("disks at odd places get {share} of the kick");
        drivings.kick("odd places", name, false, move |before, disks, _| {
            disks.iter_mut().zip(before).skip(1).step_by(2).try_for_each(|(new, old)| {
                let velocity = old.velocity() + share * (new.velocity() - old.velocity());
                new.with_velocity(velocity).map(|less| *new = less)
            })
        });
    }
    drivings.kick(
        "first place",
        "the first disk gets 1.3 times the kick along x",
        false,
        |before, disks, _| {
            let (Some(old), Some(new)) = (before.first(), disks.first_mut()) else { return Ok(()) };
            let kick = new.velocity() - old.velocity();
            new.with_velocity(new.velocity() + 0.3 * kick * DVec2::X).map(|more| *new = more)
        },
    );
}

fn clocks(drivings: &mut Drivings) {
    drivings.clock("stopped", "the clock stops after 20 kicks", |times, kicks| {
        if kicks == 20 {
            *times = SampleTimes::every(0.5).expect("an interval");
        }
    });
    drivings.clock("faster", "the clock is twice as fast after 50 kicks", |times, kicks| {
        if kicks >= 50 {
            let next = times.upcoming();
            *times = SampleTimes::every(0.25)
                .and_then(|times| times.starting_at(next + 0.25))
                .expect("an interval");
        }
    });
}

/// Numbers that a driving remembers of disks, by keys.
type Memory = HashMap<u64, f64>;

/// Returns the kick of a disk, from its index in the list and the number of kicks so far.
type Kick = fn(&mut Memory, &Disk, u64, u64) -> DVec2;

/// Returns the kick of a disk's spin, from the same.
type Turn = fn(&mut Memory, &Disk, u64, u64) -> f64;

struct Remembering {
    times: SampleTimes,
    kicks: u64,
    memory: Memory,
    kick: Kick,
    turn: Turn,
}

impl Driving for Remembering {
    fn times(&mut self) -> &mut SampleTimes {
        &mut self.times
    }

    fn kick(&mut self, disks: &mut [Disk]) -> Result<(), ParameterError> {
        self.kicks += 1;
        for (index, disk) in (0..).zip(disks) {
            let kick = (self.kick)(&mut self.memory, disk, index, self.kicks);
            *disk = disk.with_velocity(disk.velocity() + kick)?;
            let turn = (self.turn)(&mut self.memory, disk, index, self.kicks);
            *disk = disk.with_angular_velocity(disk.angular_velocity() + turn)?;
        }
        Ok(())
    }
}

fn remembering(kick: Kick) -> Driven {
    turning(kick, |_, _, _, _| 0.0)
}

fn turning(kick: Kick, turn: Turn) -> Driven {
    let times = SampleTimes::every(0.5).expect("an interval");
    let driving = Remembering { times, kicks: 0, memory: Memory::new(), kick, turn };
    Driven { driving: Box::new(driving), keeps_momentum: false }
}

/// Returns a number from −1 to 1 that looks random.
fn noise(one: u64, other: u64) -> f64 {
    let hash = (one << 32 | other).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let hash = (hash ^ hash >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (hash >> 11) as f64 / 2_f64.powi(52) - 1.0
}

/// Turns a remembered direction by a little noise, and returns a push in this direction.
fn push(memory: &mut Memory, key: u64, noise_of: u64, kicks: u64) -> DVec2 {
    let direction = memory.entry(key).or_insert_with(|| 3.0 * noise(0, noise_of));
    *direction += 0.3 * noise(kicks, noise_of);
    0.1 * DVec2::from_angle(*direction)
}

/// Returns a push from rest in every fifth kick since this key had a fast disk.
fn wake(memory: &mut Memory, key: u64, disk: &Disk) -> DVec2 {
    let rested = memory.entry(key).or_default();
    *rested = if disk.velocity().length() > 1.0 { 0.0 } else { *rested + 1.0 };
    if *rested > 4.0 { DVec2::new(0.0, std::mem::take(rested)) } else { -0.1 * disk.velocity() }
}

/// Returns drivings without a fault, which remember disks by their ids, or nothing.
pub(crate) fn honest() -> Vec<Planted<Driven>> {
    let kicks: [(&str, Kick); 10] = [
        ("directions and noise by id", |memory, disk, _, kicks| push(memory, disk.id(), disk.id(), kicks)),
        ("directions by id, noise by index", |memory, disk, index, kicks| {
            push(memory, disk.id(), index, kicks)
        }),
        ("rests by id", |memory, disk, _, _| wake(memory, disk.id(), disk)),
        ("noise by index", |_, _, index, kicks| DVec2::new(noise(kicks, index), noise(index, kicks))),
        ("one push for all", |_, _, _, kicks| DVec2::new(0.1, noise(kicks, kicks))),
        ("half of the ids, every second kick", |_, disk, _, kicks| {
            if disk.id() % 2 == kicks % 2 { DVec2::X } else { DVec2::ZERO }
        }),
        ("a quarter of the ids, two kicks in a row", |_, disk, _, kicks| {
            if disk.id() % 4 == 0 && kicks % 4 < 2 { DVec2::X } else { DVec2::ZERO }
        }),
        ("one id", |_, disk, _, _| if disk.id() == 12 { DVec2::X } else { DVec2::ZERO }),
        ("one disk at random", |_, _, index, kicks| {
            let chosen = 8.0 + 8.0 * noise(kicks, 0);
            if chosen as u64 == index { DVec2::X } else { DVec2::ZERO }
        }),
        ("drag by mass", |_, disk, _, _| -0.1 / disk.mass() * disk.velocity()),
    ];
    let planted = |(name, part): (&str, Driven)| Planted { name: name.to_owned(), family: "honest", part };
    let noise_by_index: Kick = |_, _, index, kicks| DVec2::new(noise(kicks, index), 0.0);
    let turns =
        [
            (
                "turns by id",
                turning(noise_by_index, |memory, disk, _, kicks| push(memory, disk.id(), disk.id(), kicks).x),
            ),
            ("noise of turns by index", turning(noise_by_index, |_, _, index, kicks| noise(index, kicks))),
            (
                "one disk turns at random",
                turning(noise_by_index, |_, _, index, kicks| {
                    if (8.0 + 8.0 * noise(kicks, 0)) as u64 == index { 1.0 } else { 0.0 }
                }),
            ),
        ];
    kicks.map(|(name, kick)| (name, remembering(kick))).into_iter().chain(turns).map(planted).collect()
}

/// "What a driving remembers of a disk, it remembers by the id."
fn memories(drivings: &mut Drivings) {
    drivings.family = "memory";
    let kicks: [(&str, Kick); 8] = [
        ("directions by index, noise by index", |memory, _, index, kicks| push(memory, index, index, kicks)),
        ("directions by index, noise by id", |memory, disk, index, kicks| {
            push(memory, index, disk.id(), kicks)
        }),
        ("directions by index, pushes by mass", |memory, disk, index, kicks| {
            push(memory, index, index, kicks) / disk.mass().sqrt()
        }),
        ("directions by index, beside as strong noise", |memory, _, index, kicks| {
            let push = push(memory, index, index, kicks);
            push + 0.1 * DVec2::new(noise(kicks, 100 + index), noise(kicks, 200 + index))
        }),
        ("rests by index", |memory, disk, index, _| wake(memory, index, disk)),
        ("the last velocity of an index", |memory, disk, index, _| {
            let last = memory.insert(index, disk.velocity().x).unwrap_or(disk.velocity().x);
            DVec2::new(0.1 * (last - disk.velocity().x), 0.0)
        }),
        ("the first id of an index", |memory, disk, index, kicks| {
            let id = *memory.entry(index).or_insert(disk.id() as f64);
            DVec2::new(noise(kicks, id as u64), 0.0)
        }),
        ("the number of kicks of an index", |memory, disk, index, _| {
            let count = memory.entry(index).or_default();
            *count += if disk.id() % 2 == 0 { 1.0 } else { 0.0 };
            DVec2::new(0.1 * *count, 0.0)
        }),
    ];
    for (name, kick) in kicks {
        drivings.plant(name, remembering(kick));
    }
    let noise_by_index: Kick = |_, _, index, kicks| DVec2::new(noise(kicks, index), noise(index, kicks));
    let turns: [(&str, Turn); 2] = [
        ("turns by index", |memory, _, index, kicks| push(memory, index, index, kicks).x),
        ("turns by index, noise by id", |memory, disk, index, kicks| push(memory, index, disk.id(), kicks).x),
    ];
    for (name, turn) in turns {
        drivings.plant(name, turning(noise_by_index, turn));
    }
}
