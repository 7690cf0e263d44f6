//! Schedulers that break their contract.

use std::cell::Cell;

use granular_edmd::scheduler::{EventScheduler, NOTHING_DUE, laws};

use crate::{Fault, blind, honest, informed, judge};

/// A scan through all times, some of whose steps are changed.
struct Altered {
    due: Vec<f64>,
    /// Numbers of calls.
    sets: u64,
    asked: Cell<u64>,
    reset: fn(&mut Vec<f64>, &[f64]),
    /// The times that are kept, the disk, its new time, and the number of calls.
    set: fn(&mut Vec<f64>, usize, f64, u64),
    /// The times that are kept, and the number of calls.
    answer: fn(&[f64], u64) -> (usize, f64),
    /// The times that are kept, and the disks that are known already.
    hint: fn(&mut Vec<f64>, &mut Vec<usize>),
}

fn scan() -> Altered {
    Altered {
        due: Vec::new(),
        sets: 0,
        asked: Cell::new(0),
        reset: |due, times| *due = times.to_vec(),
        set: |due, disk, time, _| due[disk] = time,
        answer: |due, _| earliest(due),
        hint: |_, _| (),
    }
}

impl EventScheduler for Altered {
    fn reset(&mut self, due: &[f64]) {
        (self.reset)(&mut self.due, due);
    }

    fn set(&mut self, disk: usize, due: f64) {
        self.sets += 1;
        (self.set)(&mut self.due, disk, due, self.sets);
    }

    fn earliest(&self) -> (usize, f64) {
        self.asked.set(self.asked.get() + 1);
        (self.answer)(&self.due, self.asked.get())
    }

    fn upcoming(&mut self, disks: &mut Vec<usize>) {
        (self.hint)(&mut self.due, disks);
    }
}

/// Returns the right answer for these times, as a `LinearScan` would.
fn earliest(due: &[f64]) -> (usize, f64) {
    due.iter().enumerate().fold(NOTHING_DUE, |first, (disk, &time)| {
        if time < first.1 || first.0 == usize::MAX { (disk, time) } else { first }
    })
}

/// Returns the last of the disks with the earliest time.
fn last_of_ties(due: &[f64]) -> (usize, f64) {
    let (_, first) = earliest(due);
    due.iter().rposition(|&time| time == first).map_or(NOTHING_DUE, |disk| (disk, first))
}

fn answering(answer: fn(&[f64], u64) -> (usize, f64)) -> Altered {
    Altered { answer, ..scan() }
}

fn setting(set: fn(&mut Vec<f64>, usize, f64, u64)) -> Altered {
    Altered { set, ..scan() }
}

type Maker = fn() -> Altered;

fn times() -> Vec<Fault<Maker>> {
    vec![
        blind("of equal times, the last disk comes first", || answering(|due, _| last_of_ties(due))),
        informed("a negative zero comes before a zero", || {
            answering(|due, _| {
                let first = due.iter().enumerate().min_by(|one, other| one.1.total_cmp(other.1));
                first.map_or(NOTHING_DUE, |(disk, &time)| (disk, time))
            })
        }),
        blind("times are kept in single precision", || {
            setting(|due, disk, time, _| due[disk] = f64::from(time as f32))
        }),
        informed("only the first 40000 disks are ever due", || {
            answering(|due, _| earliest(&due[..due.len().min(40_000)]))
        }),
    ]
}

fn calls() -> Vec<Fault<Maker>> {
    vec![
        blind("one set in a hundred is lost", || {
            setting(|due, disk, time, sets| {
                if sets % 100 != 0 {
                    due[disk] = time;
                }
            })
        }),
        informed("one set in 20000 is lost", || {
            setting(|due, disk, time, sets| {
                if sets % 20_000 != 0 {
                    due[disk] = time;
                }
            })
        }),
        blind("a time that is earlier than the last one of the disk is lost", || {
            setting(|due, disk, time, _| due[disk] = due[disk].max(time))
        }),
        blind("a reset with fewer disks leaves the others", || Altered {
            reset: |due, times| {
                due.resize(due.len().max(times.len()), f64::INFINITY);
                due[..times.len()].copy_from_slice(times);
            },
            ..scan()
        }),
        blind("a hint clears the disks that it is given", || Altered {
            hint: |_, disks| disks.clear(),
            ..scan()
        }),
        honest("scan", scan),
    ]
}

/// A sentence names the script, the step, the last operation and both answers.
#[test]
fn violations_name_the_step_and_both_answers() {
    let said = |make: Maker| laws::check(make).expect_err("a violation").to_string();
    let number = said(|| answering(|due, asked| if asked > 100 { (0, f64::NAN) } else { earliest(due) }));
    assert!(
        number.contains(" step ") && number.contains(", after ") && number.ends_with(" at NaN"),
        "{number}"
    );
    let somebody =
        said(|| answering(|due, _| if due.is_empty() { (0, f64::INFINITY) } else { earliest(due) }));
    let answers = "before the first reset: the earliest is nothing, not disk 0 at inf";
    assert!(somebody.starts_with("scheduler, law \"earliest\": script"), "{somebody}");
    assert!(somebody.ends_with(answers), "{somebody}");
    let confused = said(|| Altered { hint: |due, _| due.iter_mut().for_each(|due| *due += 1.0), ..scan() });
    assert!(confused.contains("after a look at upcoming disks"), "{confused}");
}

#[test]
fn the_check_of_schedulers_finds_planted_faults() {
    let all = [times(), calls()].into_iter().flatten().collect();
    judge("scheduler", all, |make: Maker| laws::check(make));
}
