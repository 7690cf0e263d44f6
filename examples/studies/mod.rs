//! Parts that the examples that run studies share: progress, Ctrl-C, and pictures.
#![allow(dead_code, reason = "each example takes what it needs")]

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Parser;
use granular_edmd::study::vibrated_box::{Base, VibratedBox};
use granular_edmd::study::{Control, Experiment, Plan, Progress, RampStatus, Study, StudyError, Summary};
use indicatif::{ProgressBar, ProgressStyle};
use kuva::backend::png::PngBackend;
use kuva::render::figure::Figure;

/// Set by Ctrl-C.
static STOP: AtomicBool = AtomicBool::new(false);

/// Flags of all studies.
#[derive(Parser)]
pub(crate) struct Common {
    /// Folder for the study, the picture and the tables.
    #[arg(long, default_value = "out")]
    out: PathBuf,
    /// A short run that shows the same features with larger errors.
    #[arg(long)]
    pub(crate) quick: bool,
    /// Seed of all random numbers.
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    /// Does this ramp alone, counted from 0: to share the work among processes.
    #[arg(long)]
    ramp: Option<usize>,
}

impl Common {
    /// Does what is not done yet of a study in a folder of this name, or of one ramp of it; see [`complete`].
    pub(crate) fn complete<E: Experiment>(
        &self,
        name: &str,
        plan: &Plan<E>,
    ) -> Result<Option<Study<E>>, Box<dyn Error>> {
        let folder = self.out.join(if self.quick { format!("{name}-quick") } else { name.to_owned() });
        complete(&folder, plan, self.ramp)
    }
}

/// Returns the paper's vibrated box at this gravity, with the contact duration that our figures take.
pub(crate) fn vibrated_box(gravity: f64) -> VibratedBox {
    let base = Base::BiParabolic { amplitude: 0.1, angular_frequency: 10.0 };
    VibratedBox::new(1000, 60.0, base).with_height(150.0).with_gravity(gravity).with_contact_duration(1e-4)
}

/// Ends the program; an error is told in one line with its reasons.
pub(crate) fn end(result: Result<(), Box<dyn Error>>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let sources = std::iter::successors(error.source(), |&source| source.source());
            let reasons = sources.map(ToString::to_string);
            let told: Vec<String> = std::iter::once(error.to_string()).chain(reasons).collect();
            eprintln!("error: {}", told.join(": "));
            ExitCode::FAILURE
        }
    }
}

/// Does what is not done yet of a study, or of one ramp of it, and returns the study once all of it is
/// complete.
///
/// The same command starts a study and goes on with it. Ctrl-C stops with all that was done saved; a second
/// one ends the program at once, with what was saved by then.
pub(crate) fn complete<E: Experiment>(
    folder: &Path,
    plan: &Plan<E>,
    ramp: Option<usize>,
) -> Result<Option<Study<E>>, Box<dyn Error>> {
    println!("study in {}:\n\n{plan}", folder.display());
    let study = Study::open_or_create(folder, plan)?;
    let summary = watched(|control| match ramp {
        Some(ramp) => study.run_ramp(ramp, control),
        None => study.run(control),
    })?;
    for file in &summary.redone {
        println!("{} was damaged and has been done again", file.display());
    }
    if (0..plan.ramps()).all(|ramp| study.status(ramp) == RampStatus::Done) {
        return Ok(Some(study));
    }
    println!("{} of {} values are finished; the same command goes on", summary.finished, summary.total);
    Ok(None)
}

/// Runs a study with a progress bar, until it is done or Ctrl-C comes.
fn watched(run: impl FnOnce(&Control<'_>) -> Result<Summary, StudyError>) -> Result<Summary, Box<dyn Error>> {
    stop_on_ctrl_c()?;
    let bar = progress_bar()?;
    let show = |progress: &Progress| {
        let before = bar.position();
        bar.set_length(progress.total);
        bar.set_position(progress.done);
        // A value that was done before says nothing about the rate.
        if progress.done > before + 1 {
            bar.reset_eta();
        }
    };
    let summary = run(&Control::default().with_progress(&show).with_interrupt(&STOP))?;
    bar.finish_and_clear();
    Ok(summary)
}

/// Sets the handler of Ctrl-C, once; more calls do nothing.
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

/// Returns a bar, which is drawn on a terminal only.
fn progress_bar() -> Result<ProgressBar, Box<dyn Error>> {
    let style =
        ProgressStyle::with_template("{elapsed_precise} {wide_bar} {percent}% {per_sec}, {eta} left")?;
    Ok(ProgressBar::new(0).with_style(style))
}

/// Writes a figure into the folder of a study.
pub(crate) fn write_png<E: Experiment>(
    figure: Figure,
    study: &Study<E>,
    name: &str,
) -> Result<(), Box<dyn Error>> {
    let path = study.folder().join(name);
    std::fs::write(&path, PngBackend::new().render_scene(&figure.render())?)?;
    println!("wrote {}; the tables are beside it", path.display());
    Ok(())
}
