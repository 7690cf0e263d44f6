//! Schedulers that break their contract where a check may not look.

use std::cell::Cell;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

use granular_edmd::scheduler::{EventScheduler, LinearScan, NOTHING_DUE};

use crate::faults::blind::schedulers::Maker;
use crate::faults::{List, Planted};

/// An honest scan, some of whose calls are changed.
struct Changed {
    scan: LinearScan,
    due: Vec<f64>,
    sets: u64,
    asked: Cell<u64>,
    looks: u64,
    /// Returns the time that is kept: of the times, the disk, the new time, and the number of calls.
    set: fn(&Self, usize, f64) -> f64,
    reset: fn(&Self, &[f64]) -> Vec<f64>,
    answer: fn(&Self, (usize, f64)) -> (usize, f64),
}

impl EventScheduler for Changed {
    fn reset(&mut self, due: &[f64]) {
        let due = (self.reset)(self, due);
        self.scan.reset(&due);
        self.due = due;
    }

    fn set(&mut self, disk: usize, due: f64) {
        self.sets += 1;
        let due = (self.set)(self, disk, due);
        self.due[disk] = due;
        self.scan.set(disk, due);
        self.looks = 0;
    }

    fn earliest(&self) -> (usize, f64) {
        self.asked.set(self.asked.get() + 1);
        (self.answer)(self, self.scan.earliest())
    }

    fn upcoming(&mut self, _: &mut Vec<usize>) {
        self.looks += 1;
    }
}

const HONEST: fn() -> Changed = || Changed {
    scan: LinearScan::new(),
    due: Vec::new(),
    sets: 0,
    asked: Cell::new(0),
    looks: 0,
    set: |_, _, due| due,
    reset: |_, due| due.to_vec(),
    answer: |_, answer| answer,
};

type Schedulers = List<Maker>;

impl Schedulers {
    fn set(&mut self, family: &'static str, name: impl Into<String>, set: fn(&Changed, usize, f64) -> f64) {
        self.family = family;
        self.plant(name, Box::new(move || Box::new(Changed { set, ..HONEST() })));
    }

    fn reset(&mut self, family: &'static str, name: &str, reset: fn(&Changed, &[f64]) -> Vec<f64>) {
        self.family = family;
        self.plant(name, Box::new(move || Box::new(Changed { reset, ..HONEST() })));
    }

    fn answer(
        &mut self,
        family: &'static str,
        name: &str,
        answer: fn(&Changed, (usize, f64)) -> (usize, f64),
    ) {
        self.family = family;
        self.plant(name, Box::new(move || Box::new(Changed { answer, ..HONEST() })));
    }
}

pub(crate) fn catalogue() -> Vec<Planted<Maker>> {
    List::grown(&[sets, resets, answers, numbers])
}

/// A heap whose entries carry a number of this many bits: entries with another number than the latest one of
/// their disk are out of date, and stay until they come to the top.
#[derive(Default)]
struct Numbered {
    bits: u32,
    entries: BinaryHeap<Reverse<(u64, usize, u64)>>,
    numbers: Vec<u64>,
}

impl Numbered {
    /// Maps times to numbers of the same order.
    fn key(due: f64) -> u64 {
        let bits = (due + 0.0).to_bits();
        if due.is_sign_negative() && due != 0.0 { !bits } else { bits | 1 << 63 }
    }

    fn due(key: u64) -> f64 {
        f64::from_bits(if key >> 63 == 1 { key ^ 1 << 63 } else { !key })
    }

    fn tidy(&mut self) {
        while self.entries.peek().is_some_and(|&Reverse((_, disk, number))| self.numbers[disk] != number) {
            self.entries.pop();
        }
    }
}

impl EventScheduler for Numbered {
    fn reset(&mut self, due: &[f64]) {
        self.numbers = vec![0; due.len()];
        self.entries =
            due.iter().enumerate().map(|(disk, &due)| Reverse((Self::key(due), disk, 0))).collect();
    }

    fn set(&mut self, disk: usize, due: f64) {
        self.numbers[disk] = (self.numbers[disk] + 1) % (1 << self.bits);
        self.entries.push(Reverse((Self::key(due), disk, self.numbers[disk])));
        self.tidy();
    }

    fn earliest(&self) -> (usize, f64) {
        let first = self.entries.peek().map(|&Reverse((key, disk, _))| (disk, Self::due(key)));
        first.unwrap_or(NOTHING_DUE)
    }

    fn upcoming(&mut self, _: &mut Vec<usize>) {}
}

fn numbers(schedulers: &mut Schedulers) {
    for bits in [8, 16] {
        schedulers.family = "numbered entries";
        let make = move || -> Box<dyn EventScheduler> { Box::new(Numbered { bits, ..Numbered::default() }) };
        schedulers.plant(format!("entries have numbers of {bits} bits"), Box::new(make));
    }
}

fn sets(schedulers: &mut Schedulers) {
    schedulers.set("seldom", "one set in 5003 is lost", |scan, disk, due| {
        if scan.sets.is_multiple_of(5003) { scan.due[disk] } else { due }
    });
    schedulers.set("very seldom", "one set in 49000 is lost", |scan, disk, due| {
        if scan.sets.is_multiple_of(49_000) { scan.due[disk] } else { due }
    });
    schedulers.set("beyond the scripts", "one set in a million is lost", |scan, disk, due| {
        if scan.sets.is_multiple_of(1_000_000) { scan.due[disk] } else { due }
    });
    schedulers.set(
        "set to the answer",
        "a time equal to the earliest is taken as infinite",
        |scan, _, due| {
            if due == scan.scan.earliest().1 { f64::INFINITY } else { due }
        },
    );
    schedulers.set(
        "same again",
        "a time that is set again is taken as the next number",
        |scan, disk, due| {
            if due.to_bits() == scan.due[disk].to_bits() { due.next_up() } else { due }
        },
    );
    schedulers.set("after a look", "the set after a look at upcoming disks is lost", |scan, disk, due| {
        if scan.looks > 0 { scan.due[disk] } else { due }
    });
    schedulers.set("disk 65536", "disks from 65536 on keep the time of their reset", |scan, disk, due| {
        if disk >= 65_536 { scan.due[disk] } else { due }
    });
    schedulers.set(
        "negative infinity",
        "a time of minus infinity counts as the least number",
        |_, _, due| due.max(f64::MIN),
    );
}

fn resets(schedulers: &mut Schedulers) {
    schedulers.reset("reset of one", "a reset to one disk sets time 0", |_, due| {
        if due.len() == 1 { vec![0.0] } else { due.to_vec() }
    });
    schedulers.reset("reset of ties", "a reset separates equal times", |_, due| {
        let mut due = due.to_vec();
        if due.len() > 1 && due[0] == due[1] {
            due[1] = due[1].next_up();
        }
        due
    });
    schedulers.reset(
        "late reset",
        "a reset after a thousand sets keeps the times of as many disks",
        |scan, due| {
            if scan.sets > 1000 && scan.due.len() == due.len() { scan.due.clone() } else { due.to_vec() }
        },
    );
}

fn answers(schedulers: &mut Schedulers) {
    schedulers.answer(
        "third question",
        "each third answer to the same question is never",
        |scan, (disk, due)| (disk, if scan.asked.get() % 3 == 0 { f64::INFINITY } else { due }),
    );
    schedulers.answer(
        "ties of two sizes",
        "of ties at 0 and -0, the last one comes first",
        |scan, (disk, due)| {
            if due != 0.0 {
                return (disk, due);
            }
            let last = scan.due.iter().rposition(|&time| time == 0.0).unwrap_or(disk);
            (last, scan.due[last])
        },
    );
    schedulers.answer("small numbers", "a time below 1e-307 is 0", |_, (disk, due)| {
        (disk, if due.abs() < 1e-307 { 0.0 } else { due })
    });
}
