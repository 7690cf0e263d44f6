//! Folders: a study writes only where nothing else is, and removes only its own files.

use std::fs;

use granular_edmd_study::vibrated_box::VibratedBox;
use granular_edmd_study::{Control, Plan, Protocol, Study, StudyError};

use crate::support::{AnyError, Scratch, TEMPORARY, contents, small_box, small_plan};
use support::report::report;

#[test]
fn only_temporary_files_of_the_library_are_removed() -> Result<(), AnyError> {
    let scratch = Scratch::new("temporaries");
    let study = Study::create(&scratch.0, &small_plan())?;
    fs::create_dir_all(scratch.0.join("unfinished"))?;
    let theirs = ["data.tmp", "granular-edmd.tmp", "unfinished/0000-0001.tmp", "unfinished/notes.tmp"];
    for name in theirs {
        fs::write(scratch.0.join(name), name)?;
    }
    for folder in ["", "unfinished"] {
        fs::write(scratch.0.join(folder).join(TEMPORARY), "of a killed process")?;
    }
    fs::create_dir(scratch.0.join("granular-edmd-4711-1-0123456789abcdef.tmp"))?;
    assert!(study.run(&Control::default())?.is_complete());
    for name in theirs {
        assert_eq!(fs::read_to_string(scratch.0.join(name))?, name);
    }
    for folder in ["", "unfinished"] {
        assert!(!scratch.0.join(folder).join(TEMPORARY).exists(), "{folder}");
    }
    Ok(())
}

#[test]
fn folders_that_cannot_be_used_are_named() -> Result<(), AnyError> {
    let scratch = Scratch::new("folders");
    let refused = |made: Result<Study<VibratedBox>, StudyError>, why: &str| {
        let error = made.unwrap_err();
        assert!(
            matches!(&error, StudyError::Refused { path, reason } if *path == scratch.0 && reason == why)
        );
    };
    refused(Study::open(&scratch.0), "holds no study");
    let study = Study::create(&scratch.0, &small_plan())?;
    refused(Study::create(&scratch.0, &small_plan()), "holds a study already");
    let other = Plan::new(small_box(), Protocol::new(1, 1, 1)?, 1)?;
    assert!(matches!(Study::open_or_create(&scratch.0, &other), Err(StudyError::Different { .. })));
    // A file where a folder should be cannot be written into, not even by the superuser.
    fs::write(scratch.0.join("blocks"), "not a folder")?;
    let error = study.run(&Control::default()).unwrap_err().to_string();
    assert!(error.starts_with("cannot ") && error.contains("blocks"), "{error}");
    fs::remove_file(scratch.0.join("blocks"))?;
    let error = Study::create(scratch.0.join("README.txt"), &small_plan()).unwrap_err();
    assert!(matches!(error, StudyError::Io { .. }), "{error}");
    Ok(())
}

#[test]
#[cfg(unix)]
fn a_read_only_folder_is_an_error() -> Result<(), AnyError> {
    use std::os::unix::fs::PermissionsExt;
    let scratch = Scratch::new("read-only");
    let study = Study::create(&scratch.0, &small_plan())?;
    fs::set_permissions(&scratch.0, fs::Permissions::from_mode(0o555))?;
    let superuser = fs::write(scratch.0.join("probe"), "").is_ok();
    let result = study.run(&Control::default());
    fs::set_permissions(&scratch.0, fs::Permissions::from_mode(0o755))?;
    if !superuser {
        let error = report(&result.unwrap_err());
        assert!(error.starts_with("cannot create") && error.contains("ermission denied"), "{error}");
    }
    Ok(())
}

#[test]
fn a_folder_with_files_of_others_is_refused_and_left_alone() -> Result<(), AnyError> {
    let scratch = Scratch::new("occupied");
    fs::create_dir_all(&scratch.0)?;
    for (name, text) in
        [("README.txt", "my notes"), ("values.csv", "a,b"), ("data.tmp", "keep"), ("lock", "mine")]
    {
        fs::write(scratch.0.join(name), text)?;
        let before = contents(&scratch.0);
        for result in
            [Study::open_or_create(&scratch.0, &small_plan()), Study::create(&scratch.0, &small_plan())]
        {
            let error = result.unwrap_err();
            assert!(
                error.to_string().contains(&format!("holds other files ({name}) and no study")),
                "{error}"
            );
        }
        assert!(contents(&scratch.0) == before, "nothing has changed");
        fs::remove_file(scratch.0.join(name))?;
    }
    // Somebody's plan, among other files, is no study either.
    fs::write(scratch.0.join("plan.toml"), small_plan().to_string())?;
    fs::write(scratch.0.join("samples.csv"), "mine")?;
    let before = contents(&scratch.0);
    let refused = Study::open_or_create(&scratch.0, &small_plan()).unwrap_err();
    assert!(refused.to_string().contains("holds other files ("), "{refused}");
    assert!(Study::<VibratedBox>::open(&scratch.0).is_err());
    assert!(contents(&scratch.0) == before, "nothing has changed");
    fs::remove_file(scratch.0.join("plan.toml"))?;
    fs::remove_file(scratch.0.join("samples.csv"))?;
    // Left by a process that was killed before it had a plan.
    fs::write(scratch.0.join("lock"), "")?;
    fs::write(scratch.0.join(TEMPORARY), "of a killed process")?;
    Study::create(&scratch.0, &small_plan())?;
    assert!(!scratch.0.join(TEMPORARY).exists());
    Ok(())
}

#[test]
fn the_empty_path_is_refused() {
    let there = fs::read_dir(".").unwrap().count();
    for result in
        [Study::open_or_create("", &small_plan()), Study::create("", &small_plan()), Study::open("")]
    {
        assert!(matches!(result, Err(StudyError::NoPath)));
    }
    assert_eq!(fs::read_dir(".").unwrap().count(), there);
}

#[test]
fn a_plan_edited_after_the_start_is_refused_with_what_differs() -> Result<(), AnyError> {
    let scratch = Scratch::new("edited");
    let study = Study::create(&scratch.0, &small_plan())?;
    let plan = Plan::new(small_box().with_gravity(0.5), Protocol::new(25, 7, 10)?, 7)?;
    let error = Study::open_or_create(&scratch.0, &plan).unwrap_err();
    let told = error.to_string();
    assert!(told.contains("experiment.gravity is 0.015625 there and 0.5 here"), "{told}");
    assert!(told.contains("protocol.samples is 6 there and 7 here"), "{told}");
    assert!(told.contains("ramp is") && told.contains("there and absent here"), "{told}");
    // Edited under a study that is open: a run compares.
    let path = scratch.0.join("plan.toml");
    fs::write(&path, fs::read_to_string(&path)?.replace("seed = 7", "seed = 8"))?;
    let told = study.run(&Control::default()).unwrap_err().to_string();
    assert!(told.contains("seed is 8 there and 7 here"), "{told}");
    assert!(!scratch.0.join("blocks").exists());
    // Written otherwise, it is the same plan.
    fs::write(&path, format!("# a comment\n{}", small_plan().to_toml()?))?;
    assert!(study.run(&Control::default())?.is_complete());
    Ok(())
}
