//! One study, one code: other code is refused by name whatever it asks, until somebody accepts it.

use std::fs;
use std::path::Path;

use granular_edmd::boundary::Container;
use granular_edmd::collision::{CollisionRule, Contact, Impulse};
use granular_edmd::observable::{CollisionCounts, Snapshot};
use granular_edmd::{Disk, Fingerprint, initial};
use granular_edmd_study::{
    Axis, Column, Control, Experiment, ExperimentError, Plan, Protocol, Study, StudyError,
};
use serde::{Deserialize, Serialize};

use crate::support::{AnyError, Scratch, contents};

/// One experiment in several states of its code: as it was, and with one part edited.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Edited<const PART: u32> {
    loss: f64,
}

const AS_IT_WAS: u32 = 0;
const RULE: u32 = 1;
const SAMPLE: u32 = 2;
const DISKS: u32 = 3;
const OBSERVER: u32 = 4;
/// Columns are compared by themselves, so this edit leaves the revision as it was.
const COLUMNS: u32 = 5;

/// A rule without a fingerprint.
struct Plain {
    restitution: f64,
}

impl CollisionRule for Plain {
    fn impulse(&self, contact: &Contact) -> Impulse {
        Impulse::new(contact.normal_impulse(self.restitution), 0.0)
    }
}

impl<const PART: u32> Experiment for Edited<PART> {
    type Rule = Plain;
    type Boundary = Container;
    type Observer = CollisionCounts;
    type Sample = f64;

    fn revision() -> Fingerprint {
        Fingerprint::of("Edited").number(f64::from(if PART == COLUMNS { AS_IT_WAS } else { PART }))
    }

    fn rule(&self) -> Result<Plain, ExperimentError> {
        Ok(Plain { restitution: 1.0 - self.loss - if PART == RULE { 0.1 } else { 0.0 } })
    }

    fn boundary(&self) -> Result<Container, ExperimentError> {
        Ok(Container::closed(6.0, 6.0)?)
    }

    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        let disks = initial::lattice(&self.boundary()?, if PART == DISKS { 5 } else { 4 }, 0.5)?;
        Ok(initial::with_maxwellian_velocities(disks, 1.0, seed)?)
    }

    fn observer(&self) -> Result<CollisionCounts, ExperimentError> {
        Ok(CollisionCounts::default())
    }

    fn sample(&self, snapshot: &Snapshot<'_>, counts: &mut CollisionCounts) -> f64 {
        if PART == OBSERVER {
            *counts = CollisionCounts::default();
        }
        let energy = snapshot.mean(|disk| 0.5 * disk.velocity().length_squared());
        energy * if PART == SAMPLE { 1000.0 } else { 1.0 }
    }

    fn columns() -> Vec<Column<Self>> {
        vec![Column::sampled("energy", if PART == COLUMNS { "joule" } else { "energy" }, |energy| *energy)]
    }
}

fn plan<const PART: u32>() -> Plan<Edited<PART>> {
    Plan::new(Edited { loss: 0.1 }, Protocol::new(0, 3, 1).unwrap(), 1)
        .and_then(|plan| plan.with_axis(Axis::new("loss", [0.0, 0.1])?))
        .unwrap()
}

/// Returns what each entry says to this code: a whole run, a run of one ramp, tables, status.
fn entries<const PART: u32>(folder: &Path) -> [Result<(), StudyError>; 4] {
    let control = Control::default();
    let begun = || Study::open_or_create(folder, &plan::<PART>());
    let opened = || Study::<Edited<PART>>::open(folder);
    [
        begun().and_then(|study| study.run(&control)).map(drop),
        begun().and_then(|study| study.run_ramp(1, &control)).map(drop),
        opened().and_then(|study| study.write_tables()).map(drop),
        opened().and_then(|study| study.all_status()).map(drop),
    ]
}

/// Checks that all entries refuse this code, and name the number by which they know it.
fn refused<const PART: u32>(folder: &Path, number: &str) -> usize {
    let before = contents(folder);
    let results = entries::<PART>(folder);
    assert!(contents(folder) == before, "{number}: nothing has changed");
    for result in &results {
        let error = result.as_ref().unwrap_err();
        assert!(matches!(error, StudyError::Code { .. }), "{number}: {error}");
        assert!(error.to_string().contains(&format!("{number} is ")), "{number}: {error}");
    }
    results.len()
}

/// A study with one of its two ramps done.
fn half_done(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    let study = Study::create(&scratch.0, &plan::<AS_IT_WAS>()).unwrap();
    study.run_ramp(0, &Control::default()).unwrap();
    scratch
}

/// Changes a number in the provenance of a study, as if another version had begun it.
fn edit(folder: &Path, field: &str, value: &str) -> Result<(), AnyError> {
    let path = folder.join("provenance.json");
    let page = fs::read_to_string(&path)?;
    let line = page.lines().find(|line| line.contains(&format!("\"{field}\""))).ok_or("no such field")?;
    fs::write(&path, page.replace(line, &format!("  \"{field}\": \"{value}\",")))?;
    Ok(())
}

#[test]
fn edited_code_is_refused_by_name_at_every_entry() -> Result<(), AnyError> {
    let scratch = half_done("identity-edited");
    let folder = &scratch.0;
    let mut count = refused::<RULE>(folder, "revision") + refused::<SAMPLE>(folder, "revision");
    count += refused::<DISKS>(folder, "revision") + refused::<OBSERVER>(folder, "revision");
    count += refused::<COLUMNS>(folder, "columns");
    edit(folder, "results", "999999")?;
    count += refused::<AS_IT_WAS>(folder, "results");
    assert_eq!(count, 24);
    Ok(())
}

#[test]
fn a_version_with_the_same_results_goes_on() -> Result<(), AnyError> {
    let scratch = half_done("identity-version");
    edit(&scratch.0, "version", "0.0.1")?;
    edit(&scratch.0, "target", "elsewhere")?;
    assert!(entries::<AS_IT_WAS>(&scratch.0).iter().all(Result::is_ok));
    Ok(())
}

#[test]
fn accepted_code_goes_on_and_tables_tell_which_made_what() -> Result<(), AnyError> {
    let scratch = half_done("identity-accepted");
    let differences = Study::<Edited<SAMPLE>>::accept_changes(&scratch.0)?;
    assert_eq!(differences.iter().map(|found| found.field.as_str()).collect::<Vec<_>>(), ["revision"]);
    assert!(entries::<SAMPLE>(&scratch.0).iter().all(Result::is_ok));
    let mut values = csv::Reader::from_path(scratch.0.join("values.csv"))?;
    let column = values.headers()?.iter().position(|name| name == "made_by").ok_or("no column")?;
    let made: Vec<String> =
        values.records().map(|row| Ok(row?[column].to_owned())).collect::<Result<_, csv::Error>>()?;
    assert!(made.len() == 2 && made[0] != made[1], "{made:?}");
    assert!(made[0].ends_with(&format!("revision={}", Edited::<AS_IT_WAS>::revision())), "{made:?}");
    // The code that was replaced is refused now.
    refused::<AS_IT_WAS>(&scratch.0, "revision");
    assert!(Study::<Edited<SAMPLE>>::accept_changes(&scratch.0)?.is_empty());
    Ok(())
}

/// A record of code that nobody accepted, copied from another study of the same plan.
#[test]
fn a_record_of_other_code_is_refused() -> Result<(), AnyError> {
    let (mine, theirs) = (half_done("identity-mine"), Scratch::new("identity-theirs"));
    Study::create(&theirs.0, &plan::<SAMPLE>())?.run(&Control::default())?;
    fs::copy(theirs.0.join("blocks/0001.log"), mine.0.join("blocks/0001.log"))?;
    let study = Study::open_or_create(&mine.0, &plan::<AS_IT_WAS>())?;
    let error = study.run(&Control::default().with_verification()).unwrap_err();
    assert!(error.to_string().contains("was made with another revision"), "{error}");
    Ok(())
}

/// A study of a version that kept no provenance is refused, and so is one that has lost it.
#[test]
fn a_study_without_a_provenance_is_refused() -> Result<(), AnyError> {
    let scratch = half_done("identity-lost");
    fs::remove_file(scratch.0.join("provenance.json"))?;
    let error = entries::<AS_IT_WAS>(&scratch.0).map(Result::unwrap_err);
    for error in error {
        assert!(error.to_string().contains("results is absent there and"), "{error}");
    }
    Ok(())
}

/// The number of results, and the golden hashes of trajectories that belong to it. When a trajectory changes,
/// `RESULTS` grows, and both stand here anew: a study that was begun before is then refused.
const GOLDEN: (u32, [&str; 3]) =
    (1, ["box 11880 fc416af9392b211e", "column 38908 b46e13751eadf686", "packing 160 8b7f3f4dbb3c143d"]);

#[test]
fn the_number_of_results_belongs_to_the_golden_hashes() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tools/portable/recorded.txt");
    // The published package has no tools.
    let Ok(text) = fs::read_to_string(path) else { return };
    let found: Vec<String> =
        text.lines().map(|line| line.split(' ').take(3).collect::<Vec<_>>().join(" ")).collect();
    assert_eq!((granular_edmd::RESULTS, found.as_slice()), (GOLDEN.0, GOLDEN.1.map(String::from).as_slice()));
}
