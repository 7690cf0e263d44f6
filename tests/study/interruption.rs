//! The same bytes on any number of threads, and after any interruption.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use granular_edmd::study::{Control, Progress, Study};

use crate::support::{CHILD_FOLDER, Scratch, assert_same, done, run_with_interruptions, small_plan, start};

#[test]
#[cfg(feature = "rayon")]
fn threads_do_not_matter() -> Result<(), crate::support::AnyError> {
    let (expected, _) = done(&small_plan(), "threads-any");
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let (found, _) = pool.install(|| done(&small_plan(), &format!("threads-{threads}")));
        assert_same(&found.0, &expected.0);
    }
    Ok(())
}

#[test]
fn an_interrupted_study_goes_on() {
    let (expected, _) = done(&small_plan(), "interrupted-not");
    let scratch = Scratch::new("interrupted");
    let last = AtomicU64::new(0);
    let watch = |progress: &Progress| last.store(progress.done, Ordering::Relaxed);
    assert!(run_with_interruptions(&scratch.0, &small_plan(), |_| 16, watch) > 1);
    assert_eq!(last.into_inner(), 10 * 9, "three steps to settle, six samples");
    assert_same(&scratch.0, &expected.0);
}

/// The work of a process that is killed; it does nothing unless another test starts it.
#[test]
#[ignore = "started by the tests of killed processes"]
fn child() {
    let Ok(folder) = std::env::var(CHILD_FOLDER) else { return };
    let study = Study::open_or_create(folder, &small_plan()).unwrap();
    study.run(&Control::default().with_save_interval(Duration::ZERO)).unwrap();
}

/// The process is killed at moments that drift through the run, until the study is complete.
#[test]
fn a_killed_study_ends_with_the_same_bytes() {
    let (expected, _) = done(&small_plan(), "killed-not");
    let scratch = Scratch::new("killed");
    let mut kills = 0;
    loop {
        let mut child = start("interruption::child", &scratch.0).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(20 + 7 * kills));
        match child.try_wait().unwrap() {
            Some(status) => {
                assert!(status.success());
                break;
            }
            None => child.kill().unwrap(),
        }
        child.wait().unwrap();
        kills += 1;
    }
    assert!(kills > 0);
    assert_same(&scratch.0, &expected.0);
}
