//! Parts that the programs that run studies share: progress, Ctrl-C, and pictures.

use std::error::Error;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Args;
use granular_edmd_study::vibrated_box::{Base, VibratedBox};
use granular_edmd_study::{Control, Experiment, Plan, RampStatus, Study, StudyError, Summary};

use crate::progress::Progress;
use crate::results::Results;
use crate::sheet::Sheet;

/// Set by Ctrl-C.
static STOP: AtomicBool = AtomicBool::new(false);

/// Flags of all studies.
#[derive(Args)]
pub struct Common {
    /// A short run that shows the same features with larger errors.
    #[arg(long)]
    pub quick: bool,
    /// Seed of all random numbers.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Runs this ramp alone, counted from 0, to share the work among processes.
    #[arg(long)]
    ramp: Option<usize>,
    #[command(flatten)]
    pub results: Results,
}

impl Common {
    /// Runs the remaining values of a study in a folder of this name, or of one of its ramps; see
    /// [`complete`].
    pub fn complete<E: Experiment>(
        &self,
        name: &str,
        plan: &Plan<E>,
    ) -> Result<Option<Study<E>>, Box<dyn Error>> {
        self.results.make_folder()?;
        let folder = self.results.path(&if self.quick { format!("{name}-quick") } else { name.to_owned() });
        complete(&folder, plan, self.ramp)
    }

    /// Writes a picture of this name into the folder of a study, and the values of the study as JSON.
    pub fn finish<E: Experiment>(
        &self,
        picture: &Sheet,
        study: &Study<E>,
        name: &str,
    ) -> Result<(), Box<dyn Error>> {
        let path = study.folder().join(name);
        picture.write(&path)?;
        crate::say!("wrote {0}.svg and {0}.png; the tables are beside them", path.display());
        self.results.write_tables_as_json(&[("values", study.folder().join("values.csv"))])
    }
}

/// Returns the paper's vibrated box at this gravity, with the contact duration of all figures.
pub fn vibrated_box(gravity: f64) -> VibratedBox {
    let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
    VibratedBox::new(1000, 60.0, base).with_height(150.0).with_gravity(gravity).with_contact_duration(1e-4)
}

/// Runs the remaining values of a study, or of one of its ramps, and returns the study once all of it is
/// complete.
///
/// The same command starts a study and continues it. Ctrl-C saves all work and stops; a second Ctrl-C ends
/// the program immediately, with the work saved so far.
pub fn complete<E: Experiment>(
    folder: &Path,
    plan: &Plan<E>,
    ramp: Option<usize>,
) -> Result<Option<Study<E>>, Box<dyn Error>> {
    crate::say!("study in {}:\n\n{plan}", folder.display());
    let study = Study::open_or_create(folder, plan)?;
    let summary = watched(|control| match ramp {
        Some(ramp) => study.run_ramp(ramp, control),
        None => study.run(control),
    })?;
    for file in &summary.redone {
        crate::say!("{} was damaged and has been done again", file.display());
    }
    if summary.warned > 0 {
        crate::say!("{} values have warnings", summary.warned);
        for [ramp, value] in study.warned()? {
            let record = study.record(ramp, value)?;
            let warnings = record.map_or_else(String::new, |record| record.warnings().join("; "));
            crate::say!("  ramp {ramp}, value {value}: {warnings}");
        }
    }
    if study.all_status()?.iter().all(|status| *status == RampStatus::Done) {
        return Ok(Some(study));
    }
    crate::say!(
        "{} of {} values are finished; this command goes on, and draws once all ramps are done",
        summary.finished,
        summary.total
    );
    Ok(None)
}

/// Runs a study and shows its progress, until it is done or Ctrl-C is pressed.
fn watched(run: impl FnOnce(&Control<'_>) -> Result<Summary, StudyError>) -> Result<Summary, Box<dyn Error>> {
    stop_on_ctrl_c()?;
    let progress = Progress::of("study");
    let show = |now: &granular_edmd_study::Progress| progress.show(now.done, now.total);
    Ok(run(&Control::default().with_progress(&show).with_interrupt(&STOP))?)
}

/// Sets the handler of Ctrl-C once; further calls do nothing.
fn stop_on_ctrl_c() -> Result<(), ctrlc::Error> {
    let handler = || {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    };
    match ctrlc::set_handler(handler) {
        Err(ctrlc::Error::MultipleHandlers) => Ok(()),
        other => other,
    }
}
