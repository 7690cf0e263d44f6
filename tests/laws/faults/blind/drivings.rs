//! Drivings that break the promises of a driving: to change velocities and spins only, alike for all disks,
//! at the beats of a clock that goes on, and with random numbers of its own. The trait has no chapter on its
//! contract; these are the habits of `WhiteNoise` and `Rescaling`.

use std::collections::hash_map::RandomState;
use std::hash::BuildHasher;
use std::sync::atomic::{AtomicU64, Ordering};

use granular_edmd::glam::DVec2;
use granular_edmd::observable::SampleTimes;
use granular_edmd::simulation::{Driving, WhiteNoise};
use granular_edmd::{Disk, Kind, ParameterError};

use crate::faults::{List, Planted, tenth};

/// A driving, and whether it promises to keep the total momentum.
pub(crate) struct Driven {
    pub(crate) driving: Box<dyn Driving>,
    pub(crate) keeps_momentum: bool,
}

/// The kicks of all drivings that count together.
static KICKS: AtomicU64 = AtomicU64::new(0);

type Kicked = Result<(), ParameterError>;

/// White noise with a change of the disks after each kick, and of the clock whenever somebody asks for it.
struct Altered {
    honest: WhiteNoise,
    kicks: u64,
    asked: u64,
    /// The disks before the kick and after it, and the number of kicks so far.
    change: Box<dyn Fn(&[Disk], &mut [Disk], u64) -> Kicked>,
    /// The clock, and the number of calls so far.
    clock: fn(&mut SampleTimes, u64),
}

fn clock() -> SampleTimes {
    SampleTimes::every(0.25).expect("an interval")
}

impl Default for Altered {
    fn default() -> Self {
        let honest = WhiteNoise::new(0.1, clock(), 7).expect("a strength");
        Self { honest, kicks: 0, asked: 0, change: Box::new(|_, _, _| Ok(())), clock: |_, _| () }
    }
}

impl Driving for Altered {
    fn times(&mut self) -> &mut SampleTimes {
        self.asked += 1;
        (self.clock)(self.honest.times(), self.asked);
        self.honest.times()
    }

    fn kick(&mut self, disks: &mut [Disk]) -> Kicked {
        let before = disks.to_vec();
        self.kicks += 1;
        self.honest.kick(disks)?;
        (self.change)(&before, disks, self.kicks)
    }
}

/// The catalogue while it grows.
type Drivings = List<Driven>;

impl Drivings {
    fn add(&mut self, name: impl Into<String>, keeps_momentum: bool, driving: Altered) {
        self.plant(name, Driven { driving: Box::new(driving), keeps_momentum });
    }

    /// Adds a driving whose kicks are changed.
    fn add_kick<F>(&mut self, name: impl Into<String>, keeps_momentum: bool, change: F)
    where
        F: Fn(&[Disk], &mut [Disk], u64) -> Kicked + 'static,
    {
        self.add(name, keeps_momentum, Altered { change: Box::new(change), ..Altered::default() });
    }

    /// Adds a driving that changes each disk besides its kick.
    fn add_each<F>(&mut self, name: impl Into<String>, change: F)
    where
        F: Fn(Disk) -> Result<Disk, ParameterError> + 'static,
    {
        self.add_kick(name, false, move |_, disks, _| {
            disks.iter_mut().try_for_each(|disk| change(*disk).map(|changed| *disk = changed))
        });
    }
}

/// Returns the driving on which faults are planted.
pub(crate) fn honest() -> Vec<Planted<Driven>> {
    let mut drivings = Drivings::default();
    drivings.add("white noise", true, Altered::default());
    drivings.faults
}

pub(crate) fn catalogue() -> Vec<Planted<Driven>> {
    List::grown(&[disks, momenta, shares, clocks])
}

/// A kick changes velocities and spins, and nothing else.
fn disks(drivings: &mut Drivings) {
    drivings.family = "disks";
    for n in [1, 6, 12] {
        let (step, name) = (DVec2::new(tenth(n), 0.0), format!("each kick moves the disks by 1e-{n}"));
        drivings.add_each(name, move |disk| disk.with_position(disk.position() + step));
        let (factor, name) = (1.0 + tenth(n), format!("each kick makes the disks heavier by 1e-{n}"));
        drivings.add_each(name, move |disk| disk.with_mass(factor * disk.mass()));
    }
    drivings.add_each("each kick makes new disks, which have no id", |disk| disk.with_id(0));
    drivings.add_each("each kick changes the kind", |disk| Ok(disk.with_kind(Kind::new(1))));
    drivings
        .add_each("each kick forgets the periods that a disk has passed", |disk| Ok(disk.with_image([0, 0])));
    drivings.add_each("each kick turns the disks", |disk| disk.with_angle(disk.angle() + 0.1));
    drivings.add_kick("each kick exchanges two disks", true, |_, disks, _| {
        if disks.len() > 1 {
            disks.swap(0, 1);
        }
        Ok(())
    });
    drivings.add_kick("each kick sorts the disks by speed", true, |_, disks, _| {
        disks.sort_by(|one, other| one.velocity().length().total_cmp(&other.velocity().length()));
        Ok(())
    });
}

/// A total momentum that is said to be kept.
fn momenta(drivings: &mut Drivings) {
    drivings.family = "momentum";
    for n in [1, 3, 6, 9] {
        let (drift, name) = (DVec2::new(0.0, tenth(n)), format!("each kick adds a drift of 1e-{n}"));
        drivings.add_kick(name, true, move |_, disks, _| {
            disks.iter_mut().try_for_each(|disk| {
                *disk = disk.with_velocity(disk.velocity() + drift)?;
                Ok(())
            })
        });
    }
    drivings.add_kick("the mean kick is taken away without weights", true, |before, disks, _| {
        let gained = |(old, new): (&Disk, &Disk)| new.velocity() - old.velocity();
        let mean = before.iter().zip(&*disks).map(gained).sum::<DVec2>() / disks.len().max(1) as f64;
        disks.iter_mut().try_for_each(|disk| {
            *disk = disk.with_velocity(disk.velocity() - mean)?;
            Ok(())
        })
    });
}

/// Kicks that differ by the order of the disks, or by numbers that are not of the driving.
fn shares(drivings: &mut Drivings) {
    drivings.family = "share";
    drivings.add_kick("the first disk gets no kick", false, |before, disks, _| {
        if let (Some(old), Some(new)) = (before.first(), disks.first_mut()) {
            *new = *old;
        }
        Ok(())
    });
    drivings.add_kick("the kicks grow with the index", false, |before, disks, _| {
        let count = disks.len() as f64;
        disks.iter_mut().zip(before).enumerate().try_for_each(|(index, (new, old))| {
            let kick = new.velocity() - old.velocity();
            *new = new.with_velocity(old.velocity() + index as f64 / count * kick)?;
            Ok(())
        })
    });
    drivings.family = "random";
    drivings.add_each("the random numbers are of the process", |disk| {
        let number = RandomState::new().hash_one(0) as f64 / u64::MAX as f64;
        disk.with_velocity(disk.velocity() + 0.1 * (number - 0.5))
    });
    drivings.add_each("all drivings of a program share a counter", |disk| {
        let number = KICKS.fetch_add(1, Ordering::Relaxed) as f64;
        disk.with_angular_velocity(disk.angular_velocity() + number.sin())
    });
}

/// Clocks that do not go on, or that depend on how often somebody asks for them.
fn clocks(drivings: &mut Drivings) {
    let clocks: [(&str, fn(&mut SampleTimes, u64)); 4] = [
        ("the clock begins anew whenever it is asked for", |times, _| *times = clock()),
        ("the clock advances whenever it is asked for", |times, _| times.advance_past(times.upcoming())),
        ("the clock skips a beat in each tenth call", |times, asked| {
            if asked % 10 == 0 {
                times.advance_past(times.upcoming());
            }
        }),
        ("the clock goes back in the fifth call", |times, asked| {
            if asked == 5 {
                *times = clock();
            }
        }),
    ];
    drivings.family = "clock";
    for (name, clock) in clocks {
        drivings.add(name, true, Altered { clock, ..Altered::default() });
    }
}
