//! The commands for a study in its folder: `run`, `status`, `tables` and `accept`.

use std::path::Path;

use serde_json::json;

use super::arguments::Manner;
use super::terminal::{STOP, Watch, is_stopped, listen, read, refused, say};
use super::{End, Failure, LISTED, core_time};
use crate::{Control, Experiment, Plan, Progress, RampStatus, Study, StudyError};

/// Opens or creates the study of a plan in a folder.
fn study<E: Experiment>(path: &Path, folder: &Path) -> Result<Study<E>, Failure> {
    let plan = Plan::from_toml_unproven(&read(path)?).map_err(refused(path))?;
    Ok(Study::open_or_put(folder, plan, Plan::check_experiments).map_err(|error| match error {
        StudyError::Plan(source) => refused(path)(source),
        error => error,
    })?)
}

pub(super) fn run<E: Experiment>(
    path: &Path,
    out: &Path,
    ramp: Option<usize>,
    manner: &Manner,
) -> Result<End, Failure> {
    let study = study::<E>(path, out)?;
    if manner.retry {
        for [failed, _] in study.failed()? {
            if ramp.is_none_or(|ramp| ramp == failed) {
                study.forget_failed(failed)?;
            }
        }
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(manner.threads.map_or(0, usize::from)).build()?;
    listen()?;
    let watch = Watch::new();
    let show = |progress: &Progress| watch.show(progress);
    let control = manner.of(Control::default().with_progress(&show).with_interrupt(&STOP))?;
    let summary = pool.install(|| match ramp {
        Some(ramp) => study.run_ramp(ramp, &control),
        None => study.run(&control),
    })?;
    watch.end();
    for file in &summary.redone {
        say(&format!("{} was damaged and has been done again", file.display()))?;
    }
    say(&format!("{} of {} values have ended in {}", summary.finished, summary.total, out.display()))?;
    let logs = out.join("logs/*.jsonl");
    for (count, told, of) in [
        (summary.failed, "stalled, failed or reached a limit; status lists them,", "why"),
        (summary.warned, "have warnings;", "of what"),
    ] {
        if count > 0 {
            say(&format!("{count} of them {told} {} say {of}", logs.display()))?;
        }
    }
    Ok(match (summary.is_complete(), summary.elsewhere.is_empty()) {
        (true, _) if summary.failed > 0 => End::Unfinished,
        (true, _) => End::Done,
        (false, false) if !is_stopped() => End::Elsewhere,
        _ => End::Interrupted,
    })
}

pub(super) fn status<E: Experiment>(folder: &Path, json: bool) -> Result<End, Failure> {
    let study = Study::<E>::open(folder)?;
    let (all, has_tables) = (study.all_status()?, study.has_tables());
    let ramps = all.len();
    let of = |wanted| (0..ramps).filter(|&ramp| all[ramp] == wanted).collect::<Vec<usize>>();
    let found = [
        ("done", of(RampStatus::Done)),
        ("running", of(RampStatus::Running)),
        ("begun", of(RampStatus::Begun)),
        ("waiting", of(RampStatus::Waiting)),
    ];
    let failed = study.failed()?;
    let (spent, left) = study.seconds()?;
    if json {
        let [done, running, begun, waiting] = found.each_ref().map(|(_, of)| of);
        let object = json!({
            "ramps": ramps, "done": done, "running": running, "begun": begun, "waiting": waiting,
            "failed": failed, "tables": has_tables, "seconds": spent, "seconds_left": left,
        });
        say(&object.to_string())?;
    } else {
        let counts = found.each_ref().map(|(name, of)| format!("{} {name}", of.len()));
        let tables = if has_tables { "tables of all" } else { "no tables of all" };
        say(&format!("{ramps} ramps: {}; {tables}", counts.join(", ")))?;
        if left.is_finite() {
            say(&format!("about {} are done, {} are left", core_time(spent), core_time(left)))?;
        }
        if !failed.is_empty() {
            let first: Vec<String> =
                failed.iter().take(LISTED).map(|[r, v]| format!("{r:04}/{v:04}")).collect();
            let more = if failed.len() > LISTED { " …" } else { "" };
            say(&format!(
                "{} values stalled, failed or reached a limit: {}{more}",
                failed.len(),
                first.join(" ")
            ))?;
        }
    }
    Ok(match (found[0].1.len() == ramps, has_tables) {
        (true, true) if failed.is_empty() => End::Done,
        (true, true) => End::Unfinished,
        (true, false) => End::NoTables,
        (false, _) if found[1].1.is_empty() => End::Idle,
        (false, _) => End::Elsewhere,
    })
}

pub(super) fn tables<E: Experiment>(folder: &Path, out: Option<&Path>) -> Result<End, Failure> {
    let study = Study::<E>::open(folder)?;
    let finished = out.map_or_else(|| study.write_tables(), |out| study.write_tables_to(out))?;
    say(&format!("tables of {finished} values are in {}", out.unwrap_or(folder).display()))?;
    Ok(End::Done)
}

pub(super) fn accept<E: Experiment>(folder: &Path) -> Result<End, Failure> {
    let differences = Study::<E>::accept_changes(folder)?;
    for difference in &differences {
        say(&difference.to_string())?;
    }
    say(if differences.is_empty() {
        "the study is of this code: there is nothing to accept"
    } else {
        "from here on, records are of this code: the column made_by of values.csv tells them from those before"
    })?;
    Ok(End::Done)
}
