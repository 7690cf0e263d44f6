//! The command line of studies: plans are written, checked, run in many processes, and read.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// A folder of a test's own, removed with it.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let folder =
            Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("runner-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_granular-edmd"));
        command.args(arguments).current_dir(&self.0);
        command
    }

    fn runs(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Writes a plan of four short ramps.
    fn small_plan(&self) {
        fs::write(self.0.join("plan.toml"), SMALL).unwrap();
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

const SMALL: &str = r#"
seed = 1
repeats = 2
[experiment]
disks = 20
width = 10.0
height = 20.0
gravity = 0.02
contact_duration = 1e-4
base.bi_parabolic = { amplitude = 0.1, angular_frequency = 10.0 }
[protocol]
settle = 10
samples = 5
every = 2
[[sweep]]
parameter = "friction"
values = [0.0, 0.1]
"#;

fn code(output: &Output) -> Option<i32> {
    output.status.code()
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

#[test]
fn a_new_plan_is_a_plan_and_overwrites_nothing() {
    let scratch = Scratch::new("new");
    assert_eq!(code(&scratch.runs(&["new", "mine.toml"])), Some(0));
    let text = fs::read_to_string(scratch.0.join("mine.toml")).unwrap();
    assert!(
        text.contains("# Seed of all random numbers") && text.contains("# Measured: state, one_roll"),
        "{text}"
    );
    let check = scratch.runs(&["check", "mine.toml"]);
    assert_eq!(said(&check), "2 ramps of 4 values of 1500 cycles\n");
    let again = scratch.runs(&["new", "mine.toml"]);
    assert_eq!(code(&again), Some(1));
    assert!(said(&again).starts_with("error: cannot write mine.toml"), "{}", said(&again));
    assert_eq!(fs::read_to_string(scratch.0.join("mine.toml")).unwrap(), text);
}

#[test]
fn a_plan_that_cannot_be_is_refused_with_code_2() {
    let scratch = Scratch::new("refused");
    fs::write(scratch.0.join("plan.toml"), SMALL.replace("\"friction\"", "\"frction\"")).unwrap();
    for command in [["check", "plan.toml"].as_slice(), &["run", "plan.toml", "--out", "study"]] {
        let output = scratch.runs(command);
        assert_eq!(code(&output), Some(2));
        assert!(said(&output).contains("there is no parameter `frction`"), "{}", said(&output));
        assert_eq!(said(&output).lines().count(), 1, "{}", said(&output));
    }
    assert!(!scratch.0.join("study").exists());
    assert_eq!(code(&scratch.runs(&["walk"])), Some(2));
}

#[test]
fn ramps_in_many_processes_are_a_study() {
    let scratch = Scratch::new("many");
    scratch.small_plan();
    assert_eq!(code(&scratch.runs(&["run", "plan.toml", "--out", "one", "--threads", "1"])), Some(0));
    let start = |ramp: &str| {
        let arguments = ["run", "plan.toml", "--out", "many", "--ramp", ramp];
        scratch.command(&arguments).stdout(Stdio::null()).spawn().unwrap()
    };
    let children = ["0", "1", "2"].map(start);
    assert!(children.into_iter().all(|mut child| child.wait().unwrap().success()));
    let status = scratch.runs(&["status", "many"]);
    assert_eq!(
        (code(&status), said(&status).as_str()),
        (Some(3), "4 ramps: 3 done, 0 running, 0 begun, 1 waiting\n")
    );
    let json: serde_json::Value =
        serde_json::from_slice(&scratch.runs(&["status", "many", "--json"]).stdout).unwrap();
    let expected = serde_json::json!({
        "ramps": 4, "done": [0, 1, 2], "running": [], "begun": [], "waiting": [3]
    });
    assert_eq!(json, expected);
    assert!(!scratch.0.join("many/values.csv").exists());
    assert_eq!(code(&scratch.runs(&["tables", "many"])), Some(0));
    assert!(scratch.0.join("many/values.csv").exists());
    assert!(start("3").wait().unwrap().success());
    assert_eq!(code(&scratch.runs(&["status", "many"])), Some(0));
    for file in
        ["values.csv", "points.csv", "profiles.csv", "columns.csv", "plan.toml", "ramps/0003/0000.record"]
    {
        let [one, many] = ["one", "many"].map(|study| fs::read(scratch.0.join(study).join(file)).unwrap());
        assert!(one == many, "{file}");
    }
    let outside = scratch.runs(&["run", "plan.toml", "--out", "many", "--ramp", "4"]);
    assert_eq!((code(&outside), said(&outside).lines().count()), (Some(1), 1));
}

#[test]
fn a_prepared_folder_has_a_workflow_that_is_left_as_it_was_edited() {
    let scratch = Scratch::new("prepared");
    scratch.small_plan();
    let arguments = ["prepare", "plan.toml", "--out", "study"];
    assert_eq!(said(&scratch.runs(&arguments)), "4 ramps are prepared in study\n");
    let path = scratch.0.join("study/workflow.toml");
    let text = fs::read_to_string(&path).unwrap();
    assert!(
        text.contains(&format!("'{}' run plan.toml --out . ", env!("CARGO_BIN_EXE_granular-edmd"))),
        "{text}"
    );
    fs::write(&path, "edited").unwrap();
    assert_eq!(code(&scratch.runs(&arguments)), Some(0));
    assert_eq!(fs::read_to_string(&path).unwrap(), "edited");
    assert!(scratch.0.join("study/ramps/0003/value.json").exists());
    let inside = scratch
        .command(&["run", "plan.toml", "--out", ".", "--ramp", "0003"])
        .current_dir(scratch.0.join("study"))
        .output();
    assert_eq!(code(&inside.unwrap()), Some(0));
    assert!(
        said(&scratch.runs(&["status", "study"]))
            .starts_with("4 ramps: 1 done, 0 running, 0 begun, 3 waiting")
    );
}

/// A signal stops a study with everything saved, and the same command goes on.
#[test]
#[cfg(unix)]
fn a_signal_saves_and_the_same_command_goes_on() {
    let scratch = Scratch::new("signal");
    fs::write(scratch.0.join("plan.toml"), SMALL.replace("samples = 5", "samples = 20000")).unwrap();
    let arguments = ["run", "plan.toml", "--out", "study", "--ramp", "0"];
    let child = scratch.command(&arguments).stdout(Stdio::null()).spawn().unwrap();
    std::thread::sleep(std::time::Duration::from_millis(600));
    let killed = Command::new("kill").args(["-TERM", &child.id().to_string()]).status();
    let output = child.wait_with_output().unwrap();
    assert!(killed.is_ok_and(|status| status.success()));
    assert_eq!(code(&output), Some(130), "{}", said(&output));
    assert!(scratch.0.join("study/ramps/0000/0000.partial").exists());
    assert!(said(&scratch.runs(&["status", "study"])).contains("1 begun"));
}
