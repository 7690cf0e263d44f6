//! The share of planted faults that the checks find, for each trait and each half of the catalogue.

use std::collections::BTreeMap;

use granular_edmd::Violation;
use granular_edmd::boundary::laws as boundary_laws;
use granular_edmd::collision::laws as collision_laws;
use granular_edmd::observable;
use granular_edmd::scheduler::laws as scheduler_laws;
use granular_edmd::wall::laws as wall_laws;

use crate::faults::blind::boundaries::Walled;
use crate::faults::blind::fingerprints::{Pair, Parts};
use crate::faults::blind::{self, motions::Motion, rules::Promised, schedulers::Maker};
use crate::faults::{Planted, informed};
use crate::survivors::SURVIVORS;
use support::measured::measured;

type Verdict = Result<(), Violation>;

/// The verdicts of a check about a catalogue, by the names of the faults.
type Verdicts = Vec<(String, Verdict)>;

fn judged<T>(catalogue: Vec<Planted<T>>, check: impl Fn(usize, &mut T) -> Verdict) -> Verdicts {
    let verdict = |(index, mut fault): (usize, Planted<T>)| {
        let name = format!("{}: {}", fault.family, fault.name);
        (name, check(index, &mut fault.part))
    };
    catalogue.into_iter().enumerate().map(verdict).collect()
}

fn check_rule(_: usize, fault: &mut Promised) -> Verdict {
    collision_laws::check(&*fault.rule, &fault.promises)
}

/// Twenty periods of the motions of the catalogue.
fn check_motion(_: usize, motion: &mut Motion) -> Verdict {
    wall_laws::check(&**motion, -1.0, 13.0)
}

fn check_boundary(_: usize, fault: &mut Walled) -> Verdict {
    // Gravity is 1, and so is the speed of a fall through a radius.
    let speed = (2.0 * fault.gravity * fault.radius).sqrt();
    (1..=3).try_for_each(|seed| boundary_laws::check(&mut *fault.boundary, fault.radius, speed, seed))
}

fn check_scheduler(_: usize, make: &mut Maker) -> Verdict {
    scheduler_laws::check(make)
}

fn check_pair(_: usize, pair: &mut Pair) -> Verdict {
    let verdict = match &mut pair.parts {
        Parts::Rules([one, other]) => collision_laws::check_fingerprints(&**one, &**other),
        Parts::Motions([one, other]) => wall_laws::check_fingerprints(&**one, &**other),
        Parts::Boundaries([one, other]) => {
            boundary_laws::check_fingerprints(&mut **one, &mut **other, 0.5, 1.0)
        }
    };
    if let Err(violation) = &verdict {
        assert_eq!(violation.found().contains("alike"), pair.act_alike, "{violation}");
    }
    verdict
}

/// Returns the verdicts about both halves of the catalogue, by trait and half.
fn all() -> BTreeMap<(&'static str, &'static str), Verdicts> {
    let halves = |part, blind, informed| [((part, "blind"), blind), ((part, "informed"), informed)];
    [
        halves(
            "rule",
            judged(blind::rules::catalogue(), check_rule),
            judged(informed::rules::catalogue(), check_rule),
        ),
        halves(
            "motion",
            judged(blind::motions::catalogue(), check_motion),
            judged(informed::motions::catalogue(), check_motion),
        ),
        halves(
            "boundary",
            judged(blind::boundaries::catalogue(), check_boundary),
            judged(informed::boundaries::catalogue(), check_boundary),
        ),
        halves(
            "scheduler",
            judged(blind::schedulers::catalogue(), check_scheduler),
            judged(informed::schedulers::catalogue(), check_scheduler),
        ),
        halves(
            "observer",
            judged(blind::observers::catalogue(), |_, observer| observable::laws::check(&mut **observer)),
            judged(informed::observers::catalogue(), |_, observer| observable::laws::check(&mut **observer)),
        ),
        halves(
            "fingerprint",
            judged(blind::fingerprints::catalogue(), check_pair),
            judged(informed::fingerprints::catalogue(), check_pair),
        ),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Each fault is found, or is a survivor with a reason; a survivor that is found must leave the list.
#[test]
fn the_checks_find_planted_faults() {
    let mut wrong = Vec::new();
    for ((part, half), verdicts) in all() {
        let found = verdicts.iter().filter(|(_, verdict)| verdict.is_err()).count();
        measured(&format!("{part}, {half}, found"), found);
        measured(&format!("{part}, {half}, planted"), verdicts.len());
        for (name, verdict) in &verdicts {
            let name = format!("{part}, {half}: {name}");
            let is_survivor = SURVIVORS.iter().any(|(survivor, _)| *survivor == name);
            match verdict {
                Ok(()) if !is_survivor => wrong.push(format!("not found: {name}")),
                Err(violation) if is_survivor => wrong.push(format!("found, by now: {name}: {violation}")),
                _ => (),
            }
            if std::env::var_os("FAULTS").is_some() {
                println!(
                    "{name}: {}",
                    verdict.as_ref().map_or_else(ToString::to_string, |()| "-".to_owned())
                );
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Parts without a fault pass.
#[test]
fn honest_parts_pass() {
    let all = [
        judged(blind::rules::honest(), check_rule),
        judged(blind::motions::honest(), check_motion),
        judged(informed::motions::honest(), check_motion),
        judged(blind::boundaries::honest(), check_boundary),
        judged(informed::boundaries::honest(), check_boundary),
        judged(blind::schedulers::honest(), check_scheduler),
        judged(blind::observers::honest(), |_, observer| observable::laws::check(&mut **observer)),
        judged(blind::fingerprints::honest(), check_pair),
        judged(informed::fingerprints::honest(), check_pair),
    ];
    for (name, verdict) in all.into_iter().flatten() {
        assert_eq!(verdict, Ok(()), "{name}");
    }
}
