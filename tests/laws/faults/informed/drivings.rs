//! Drivings that break their contract where a check may not look.

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
    List::grown(&[disks, shares, clocks])
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
                let velocity = disk.velocity() + granular_edmd::glam::DVec2::new(drift, 0.0);
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
    drivings.kick("odd places", "disks at odd places get half a kick", false, |before, disks, _| {
        disks.iter_mut().zip(before).skip(1).step_by(2).try_for_each(|(new, old)| {
            let velocity = 0.5 * (new.velocity() + old.velocity());
            new.with_velocity(velocity).map(|halved| *new = halved)
        })
    });
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
