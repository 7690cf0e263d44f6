//! Schedulers that break their contract.

use std::cell::Cell;

use granular_edmd::scheduler::{EventScheduler, NOTHING_DUE};

use crate::faults::{List, Planted, tenth};

/// Makes a scheduler without disks.
pub(crate) type Maker = Box<dyn Fn() -> Box<dyn EventScheduler>>;

/// The times that are kept, the disk, its new time, and the number of calls of `set` so far.
type Set = Box<dyn Fn(&mut Vec<f64>, usize, f64, u64)>;

/// A scan through all times, some of whose steps are changed.
struct Altered {
    due: Vec<f64>,
    sets: u64,
    resets: u64,
    /// The times that are kept, the new times, and the number of resets so far.
    reset: Box<dyn Fn(&mut Vec<f64>, &[f64], u64)>,
    set: Set,
    answer: Box<dyn Fn(&[f64]) -> (usize, f64)>,
    hint: fn(&mut Vec<usize>),
}

impl Default for Altered {
    fn default() -> Self {
        Self {
            due: Vec::new(),
            sets: 0,
            resets: 0,
            reset: Box::new(|due, times, _| *due = times.to_vec()),
            set: Box::new(|due, disk, time, _| due[disk] = time),
            answer: Box::new(earliest),
            hint: |_| (),
        }
    }
}

impl EventScheduler for Altered {
    fn reset(&mut self, due: &[f64]) {
        self.resets += 1;
        (self.reset)(&mut self.due, due, self.resets);
    }

    fn set(&mut self, disk: usize, due: f64) {
        self.sets += 1;
        (self.set)(&mut self.due, disk, due, self.sets);
    }

    fn earliest(&self) -> (usize, f64) {
        (self.answer)(&self.due)
    }

    fn upcoming(&mut self, disks: &mut Vec<usize>) {
        (self.hint)(disks);
    }
}

/// Returns the right answer for these times, as a `LinearScan` would.
fn earliest(due: &[f64]) -> (usize, f64) {
    due.iter().enumerate().fold(NOTHING_DUE, |first, (disk, &time)| {
        if time < first.1 || first.0 == usize::MAX { (disk, time) } else { first }
    })
}

/// Returns the right answer for times that are changed before they are compared, with the time as it was.
fn earliest_of(due: &[f64], change: impl Fn(f64) -> f64) -> (usize, f64) {
    let changed: Vec<f64> = due.iter().map(|&time| change(time)).collect();
    let (disk, time) = earliest(&changed);
    (disk, due.get(disk).copied().unwrap_or(time))
}

/// Returns the last of the disks with the earliest time.
fn last_of_ties(due: &[f64]) -> (usize, f64) {
    let (_, first) = earliest(due);
    due.iter().rposition(|&time| time == first).map_or(NOTHING_DUE, |disk| (disk, first))
}

/// The catalogue while it grows.
type Schedulers = List<Maker>;

impl Schedulers {
    fn add(&mut self, name: impl Into<String>, make: impl Fn() -> Altered + 'static) {
        self.plant(name, Box::new(move || Box::new(make())));
    }

    fn add_set(&mut self, name: impl Into<String>, set: fn(&mut Vec<f64>, usize, f64, u64)) {
        self.add(name, move || Altered { set: Box::new(set), ..Altered::default() });
    }

    fn add_reset(&mut self, name: impl Into<String>, reset: fn(&mut Vec<f64>, &[f64], u64)) {
        self.add(name, move || Altered { reset: Box::new(reset), ..Altered::default() });
    }

    fn add_answer(&mut self, name: impl Into<String>, answer: fn(&[f64]) -> (usize, f64)) {
        self.add(name, move || Altered { answer: Box::new(answer), ..Altered::default() });
    }
}

/// Returns the scheduler on which faults are planted.
pub(crate) fn honest() -> Vec<Planted<Maker>> {
    let mut schedulers = Schedulers::default();
    schedulers.add("scan", Altered::default);
    schedulers.faults
}

pub(crate) fn catalogue() -> Vec<Planted<Maker>> {
    List::grown(&[ties, sets, times, resets, sizes, states])
}

/// "Ties go to the smallest index. 0.0 and -0.0 are the same time."
fn ties(schedulers: &mut Schedulers) {
    schedulers.family = "tie";
    schedulers.add_answer("of equal times, the last disk comes first", last_of_ties);
    schedulers.add_answer("of equal times above 100, the last disk comes first", |due| {
        let (disk, time) = earliest(due);
        if time > 100.0 { last_of_ties(due) } else { (disk, time) }
    });
    schedulers.add_answer("of four equal times or more, the last disk comes first", |due| {
        let (disk, time) = earliest(due);
        let count = due.iter().filter(|&&other| other == time).count();
        if count >= 4 { last_of_ties(due) } else { (disk, time) }
    });
    schedulers.add_answer("of infinite times, the last disk comes first", |due| {
        let (disk, time) = earliest(due);
        if time == f64::INFINITY { last_of_ties(due) } else { (disk, time) }
    });
    schedulers.add_answer("a negative zero comes before a zero", |due| {
        let first = due.iter().enumerate().min_by(|one, other| one.1.total_cmp(other.1));
        first.map_or(NOTHING_DUE, |(disk, &time)| (disk, time))
    });
    for n in [3, 7, 12] {
        let name = format!("times that differ by less than 1e-{n} are equal");
        let resolution = tenth(n);
        schedulers.add(name, move || Altered {
            answer: Box::new(move |due| earliest_of(due, |time| (time / resolution).floor())),
            ..Altered::default()
        });
    }
}

/// "Time may go back": each new time counts.
fn sets(schedulers: &mut Schedulers) {
    schedulers.family = "lost set";
    for calls in [2, 10, 100, 1_000, 20_000] {
        schedulers.add(format!("one set in {calls} is lost"), move || Altered {
            set: Box::new(move |due, disk, time, sets| {
                if sets % calls != 0 {
                    due[disk] = time;
                }
            }),
            ..Altered::default()
        });
    }
    schedulers.add_set(
        "a time that is earlier than the last one of the disk is lost",
        |due, disk, time, _| {
            due[disk] = due[disk].max(time);
        },
    );
    schedulers.add_set("a time that is earlier than all others is lost", |due, disk, time, _| {
        if time >= earliest(due).1 {
            due[disk] = time;
        }
    });
    schedulers.add_set("a later time of a disk that is not due next is lost", |due, disk, time, _| {
        if time < due[disk] || earliest(due).0 == disk {
            due[disk] = time;
        }
    });
    schedulers.add_set("an infinite time is lost", |due, disk, time, _| {
        if time < f64::INFINITY {
            due[disk] = time;
        }
    });
    schedulers.add_set("the time after an infinite one is lost", |due, disk, time, _| {
        if due[disk] < f64::INFINITY || time == f64::INFINITY {
            due[disk] = time;
        }
    });
    schedulers.add_set("a time that is later by less than 1e-6 is lost", |due, disk, time, _| {
        if !(0.0..1e-6).contains(&(time - due[disk])) {
            due[disk] = time;
        }
    });
    schedulers.add_set("the last disk keeps its time", |due, disk, time, _| {
        if disk + 1 < due.len() {
            due[disk] = time;
        }
    });
    schedulers.family = "wrong disk";
    schedulers.add_set("one set in 50 goes to the disk before", |due, disk, time, sets| {
        due[if sets % 50 == 0 { disk.saturating_sub(1) } else { disk }] = time;
    });
}

/// "That time": the answer has the time that was set, to the bit.
fn times(schedulers: &mut Schedulers) {
    let rounded: [(&str, fn(f64) -> f64); 7] = [
        ("times are kept in single precision", |time| f64::from(time as f32)),
        ("times are kept to twelve digits after the point", |time| (time * 1e12).round() / 1e12),
        ("the last bit of a time is lost", |time| f64::from_bits(time.to_bits() & !1)),
        ("negative times are kept as 0", |time| time.max(0.0)),
        ("times above 1e6 are kept as infinite", |time| if time > 1e6 { f64::INFINITY } else { time }),
        ("infinite times are kept as the largest number", |time| time.min(f64::MAX)),
        ("times below 1e-300 are kept as 0", |time| if time.abs() < 1e-300 { 0.0 } else { time }),
    ];
    schedulers.family = "rounded time";
    for (name, round) in rounded {
        schedulers.add(name, move || Altered {
            reset: Box::new(move |due, times, _| *due = times.iter().map(|&time| round(time)).collect()),
            set: Box::new(move |due, disk, time, _| due[disk] = round(time)),
            ..Altered::default()
        });
    }
    schedulers.add_answer("times are compared in single precision", |due| {
        earliest_of(due, |time| f64::from(time as f32))
    });
    schedulers.add_answer("times are compared by size without the sign", |due| earliest_of(due, f64::abs));
    schedulers.family = "infinite";
    schedulers.add_answer("infinite times alone are nothing due", |due| {
        let (disk, time) = earliest(due);
        if time == f64::INFINITY { NOTHING_DUE } else { (disk, time) }
    });
}

/// "Nothing outlives a reset", and without disks nothing is due.
fn resets(schedulers: &mut Schedulers) {
    schedulers.family = "reset";
    schedulers.add_reset("a reset with fewer disks leaves the others", |due, times, _| {
        due.resize(due.len().max(times.len()), f64::INFINITY);
        due[..times.len()].copy_from_slice(times);
    });
    schedulers.add_reset("a reset with more disks forgets the new ones", |due, times, resets| {
        let known = if resets == 1 { times.len() } else { due.len() };
        *due = times.to_vec();
        due.iter_mut().skip(known).for_each(|time| *time = f64::INFINITY);
    });
    schedulers.add_reset("a reset keeps times that are earlier", |due, times, _| {
        let kept = |(disk, &time): (usize, &f64)| due.get(disk).map_or(time, |&last| last.min(time));
        *due = times.iter().enumerate().map(kept).collect();
    });
    schedulers.add_reset("the third reset does nothing if there are as many disks", |due, times, resets| {
        if resets != 3 || due.len() != times.len() {
            *due = times.to_vec();
        }
    });
    schedulers.add_reset("a reset without disks does nothing", |due, times, _| {
        if !times.is_empty() {
            *due = times.to_vec();
        }
    });
    schedulers.family = "no disks";
    schedulers.add_answer("without disks, disk 0 is due never", |due| {
        if due.is_empty() { (0, f64::INFINITY) } else { earliest(due) }
    });
    schedulers.add_answer("without disks, nothing is due at time 0", |due| {
        if due.is_empty() { (usize::MAX, 0.0) } else { earliest(due) }
    });
}

/// Faults beyond a number of disks.
fn sizes(schedulers: &mut Schedulers) {
    schedulers.family = "number of disks";
    for most in [63, 64, 256, 1_000, 40_000] {
        schedulers.add(format!("only the first {most} disks are ever due"), move || Altered {
            answer: Box::new(move |due| earliest(&due[..due.len().min(most)])),
            ..Altered::default()
        });
    }
    schedulers.add_answer("a single disk is never due", |due| {
        if due.len() == 1 { (0, f64::INFINITY) } else { earliest(due) }
    });
    schedulers.add_answer("the last disk is left out of an odd number", |due| {
        let even = if due.len() > 1 { due.len() / 2 * 2 } else { due.len() };
        earliest(&due[..even])
    });
}

/// "This method changes nothing", and a hint leaves the disks that it is given.
fn states(schedulers: &mut Schedulers) {
    schedulers.family = "hidden state";
    schedulers.add("the second of two calls names the next disk", || {
        let last = Cell::new(NOTHING_DUE);
        let answer = move |due: &[f64]| {
            let right = earliest(due);
            let is_again = last.replace(right) == right && due.len() > 1;
            if is_again {
                earliest_of(due, |time| if time == right.1 { f64::INFINITY } else { time })
            } else {
                right
            }
        };
        Altered { answer: Box::new(answer), ..Altered::default() }
    });
    schedulers.add("the first answer after a change is the one before it", || {
        let last = Cell::new(NOTHING_DUE);
        Altered { answer: Box::new(move |due| last.replace(earliest(due))), ..Altered::default() }
    });
    let hints: [(&str, fn(&mut Vec<usize>)); 3] = [
        ("a hint clears the disks that it is given", Vec::clear),
        ("a hint turns the disks that it is given around", |disks| disks.reverse()),
        ("a hint removes disks that are named twice", Vec::dedup),
    ];
    schedulers.family = "hint";
    for (name, hint) in hints {
        schedulers.add(name, move || Altered { hint, ..Altered::default() });
    }
}
