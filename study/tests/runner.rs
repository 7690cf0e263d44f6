//! The command line of studies: plans are written, checked, run in many processes, and read.

#[path = "support/logs.rs"]
mod logs;

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
    let listed = "2 ramps of 3 values of 103000 cycles\n  0: inelasticity = 0.0; friction = 0.01, 0.03, 0.05\n  \
                  1: inelasticity = 0.01; friction = 0.01, 0.03, 0.05\n";
    assert_eq!(said(&check), listed);
    let again = scratch.runs(&["new", "mine.toml"]);
    assert_eq!(code(&again), Some(1));
    assert!(said(&again).starts_with("error: cannot write mine.toml"), "{}", said(&again));
    assert_eq!(fs::read_to_string(scratch.0.join("mine.toml")).unwrap(), text);
}

/// Each key of a new plan stands below its meaning, and `explain` tells the same; it names the nearest key.
#[test]
fn keys_and_columns_are_explained() {
    let scratch = Scratch::new("explained");
    let text = said(&scratch.runs(&["new"]));
    let lines: Vec<&str> = text.lines().collect();
    let keys = lines.windows(2).filter(|pair| pair[1].contains(" = ") && !pair[1].starts_with('#'));
    assert!(keys.clone().count() > 15);
    keys.for_each(|pair| assert!(pair[0].starts_with("# "), "{pair:?}"));
    let all = said(&scratch.runs(&["explain"]));
    let measured = text.lines().find_map(|line| line.strip_prefix("# Measured: ")).unwrap();
    for name in measured.trim_end_matches('.').split(", ") {
        assert!(all.lines().any(|line| line.split([':', ' ']).next() == Some(name)), "{name}");
    }
    let friction = "friction: Coulomb's coefficient, at least 0: static, and dynamic unless that is given. 0 if not given.\n";
    assert_eq!(said(&scratch.runs(&["explain", "experiment.friction"])), friction);
    let unknown = scratch.runs(&["explain", "frction"]);
    assert_eq!(code(&unknown), Some(2));
    let amplitude = said(&scratch.runs(&["explain", "amplitude"]));
    assert_eq!(amplitude.matches(".amplitude: Amplitude").count(), 2, "{amplitude}");
    assert!(said(&unknown).contains("there is no key `frction`; the nearest is `friction`"));
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
    assert_eq!(code(&status), Some(8));
    let (ramps, times) = said(&status).split_once('\n').map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap();
    assert_eq!(ramps, "4 ramps: 3 done, 0 running, 0 begun, 1 waiting; the tables do not have all values");
    assert!(times.starts_with("about ") && times.ends_with(" core seconds are left\n"), "{times}");
    let mut json: serde_json::Value =
        serde_json::from_slice(&scratch.runs(&["status", "many", "--json"]).stdout).unwrap();
    let expected = serde_json::json!({
        "ramps": 4, "done": [0, 1, 2], "running": [], "begun": [], "waiting": [3], "failed": [], "tables": false
    });
    let [spent, left] = ["seconds", "seconds_left"].map(|name| json[name].as_f64().unwrap());
    // Times in logs have three digits.
    assert!(left >= 0.0 && (left - spent / 3.0).abs() < 1e-9, "{spent} {left}");
    for name in ["seconds", "seconds_left"] {
        json.as_object_mut().unwrap().remove(name);
    }
    assert_eq!(json, expected);
    assert!(!scratch.0.join("many/values.csv").exists());
    assert_eq!(code(&scratch.runs(&["tables", "many"])), Some(0));
    assert!(scratch.0.join("many/values.csv").exists());
    assert!(start("3").wait().unwrap().success());
    assert_eq!(code(&scratch.runs(&["status", "many"])), Some(0));
    // The command that writes the tables notes it, too. A copy of a log is the user's.
    let [log, copy] = ["0000.log", "copy.log"].map(|name| scratch.0.join("many/blocks").join(name));
    fs::copy(log, &copy).unwrap();
    let kept = fs::read(&copy).unwrap();
    fs::remove_file(scratch.0.join("many/complete")).unwrap();
    for (command, expected) in [("status", 4), ("tables", 0), ("status", 0)] {
        assert_eq!(code(&scratch.runs(&[command, "many"])), Some(expected), "{command}");
    }
    assert!(start("0").wait().unwrap().success() && fs::read(&copy).unwrap() == kept);
    for file in ["values.csv", "points.csv", "profiles.csv", "columns.csv", "plan.toml"] {
        let [one, many] = ["one", "many"].map(|study| fs::read(scratch.0.join(study).join(file)).unwrap());
        assert!(one == many, "{file}");
    }
    let outside = scratch.runs(&["run", "plan.toml", "--out", "many", "--ramp", "4"]);
    assert_eq!((code(&outside), said(&outside).lines().count()), (Some(1), 1));
}

/// Failed values are listed, and tried again with all that started from them.
#[test]
fn failed_values_are_listed_and_tried_again() {
    let scratch = Scratch::new("failed");
    let ramp = "[ramp]\nparameter = \"inelasticity\"\nvalues = [0.0, 0.45]\ncourse = \"up_and_down\"\n";
    let (head, _) = SMALL.split_once("[[sweep]]").unwrap();
    let plan = head.replace("0.02", "0.5").replace("contact_duration = 1e-4", "").replace("= 20\n", "= 30\n");
    let plan = plan.replace("settle = 10", "settle = 50").replace("every = 2", "every = 10") + ramp;
    fs::write(scratch.0.join("plan.toml"), plan.replace("repeats = 2", "repeats = 1")).unwrap();
    let run = |arguments: &[&str]| {
        let output = scratch.runs(&[&["run", "plan.toml", "--out", "study"], arguments].concat());
        assert_eq!(code(&output), Some(7), "{}", said(&output));
        logs::records(&scratch.0.join("study"))
    };
    let before = run(&[]);
    let status = said(&scratch.runs(&["status", "study"]));
    let why = "1 values stalled, failed or reached a limit:\n  ramp 0, value 1: the run stalled at time ";
    assert!(status.contains(why), "{status}");
    assert!(said(&scratch.runs(&["status", "study", "--json"])).contains(r#""failed":[[0,1]]"#));
    let log = || logs::finished(&scratch.0.join("study")).values().flatten().count();
    assert!(run(&[]) == before && log() == 3);
    assert!(run(&["--retry"]) == before, "the same code fails with the same bytes");
    assert_eq!(log(), 5, "the failed value and the one after it");
    assert_eq!(code(&scratch.runs(&["status", "study"])), Some(7));
}

/// A contact duration longer than the time between collisions turns the rule off: it is said, not only a
/// number in a table.
#[test]
fn warnings_of_values_are_told() {
    let scratch = Scratch::new("warned");
    let plan = SMALL.replace("contact_duration = 1e-4", "contact_duration = 1000.0");
    let plan = plan.replace("samples = 5", "samples = 1000");
    assert_ne!(plan, SMALL);
    fs::write(scratch.0.join("plan.toml"), plan).unwrap();
    let output = scratch.runs(&["run", "plan.toml", "--out", "study"]);
    assert_eq!(code(&output), Some(0), "{}", said(&output));
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(told.contains("of them have warnings: `status study` says why"), "{told}");
    let told = said(&scratch.runs(&["status", "study"]));
    assert!(told.contains("values have warnings:") && told.contains("the contact duration is"), "{told}");
}

/// A larger plan takes over what a smaller one has done, into a folder of its own.
#[test]
fn a_study_grows() {
    let scratch = Scratch::new("grows");
    scratch.small_plan();
    assert_eq!(code(&scratch.runs(&["run", "plan.toml", "--out", "study"])), Some(0));
    let larger = SMALL.replace("[0.0, 0.1]", "[0.0, 0.05, 0.1]").replace("repeats = 2", "repeats = 3");
    fs::write(scratch.0.join("larger.toml"), &larger).unwrap();
    let output = scratch.runs(&["run", "larger.toml", "--out", "larger", "--from", "study"]);
    assert_eq!((code(&output), said(&output).as_str()), (Some(0), "9 of 9 values have ended in larger\n"));
    let finished = logs::finished(&scratch.0.join("larger"));
    let taken: Vec<u32> =
        (0..9).filter(|ramp| finished[&[*ramp, 0]].iter().all(|seconds| seconds.is_nan())).collect();
    assert_eq!(taken, [0, 1, 6, 7]);
    fs::write(scratch.0.join("other.toml"), larger.replace("settle = 10", "settle = 20")).unwrap();
    let output = scratch.runs(&["run", "other.toml", "--out", "other", "--from", "study"]);
    assert_eq!(code(&output), Some(1));
    assert!(said(&output).contains("protocol.settle is 10 there and 20 here"), "{}", said(&output));
}

/// Each row of the table of exit codes, except 130, which has a test of its own.
#[test]
fn exit_codes_say_how_a_command_ended() {
    let scratch = Scratch::new("codes");
    scratch.small_plan();
    let of = |arguments: &[&str]| code(&scratch.runs(arguments));
    assert_eq!(of(&["run", "plan.toml", "--out", "study", "--ramp", "0"]), Some(0), "0: done");
    assert_eq!(of(&["run", "plan.toml", "--out", "study", "--ramp", "7"]), Some(1), "1: failed");
    assert_eq!(of(&["run", "plan.toml"]), Some(2), "2: wrong command line");
    assert_eq!(of(&["check", "study/provenance.json"]), Some(2), "2: no plan");
    assert_eq!(of(&["status", "study"]), Some(8), "8: not all done, and nobody does the rest");
    assert_eq!(of(&["run", "plan.toml", "--out", "study", "--no-tables"]), Some(0));
    assert!(!scratch.0.join("study/values.csv").exists());
    assert_eq!(of(&["status", "study"]), Some(4), "4: no tables");
    assert_eq!(of(&["run", "plan.toml", "--out", "study"]), Some(0));
    assert_eq!(of(&["status", "study"]), Some(0));
    assert_eq!(of(&["tables", "study", "--out", "elsewhere"]), Some(0));
    let [here, there] =
        ["study", "elsewhere"].map(|folder| fs::read(scratch.0.join(folder).join("points.csv")).unwrap());
    assert!(here == there);
    let again = scratch.runs(&["tables", "study", "--out", "elsewhere"]);
    assert!(
        code(&again) == Some(1) && said(&again).contains("elsewhere/values.csv exists already"),
        "{}",
        said(&again)
    );
}

/// Another process does the ramp, so a process that need not wait ends with code 3.
#[test]
#[cfg(unix)]
fn a_process_that_need_not_wait_leaves_the_rest_to_others() {
    let scratch = Scratch::new("rest");
    fs::write(scratch.0.join("plan.toml"), SMALL.replace("samples = 5", "samples = 20000")).unwrap();
    let arguments = ["run", "plan.toml", "--out", "study", "--ramp", "0"];
    let mut child = scratch.command(&arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    while !said(&scratch.runs(&["status", "study"])).contains("1 running") {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let other = scratch.runs(&[arguments.as_slice(), &["--no-wait"]].concat());
    assert_eq!(code(&other), Some(3), "{}", said(&other));
    child.kill().unwrap();
    child.wait().unwrap();
}

/// SIGTERM stops a value in the middle of one sampling interval that lasts longer than any test, and the
/// value is saved. The next process goes on from there.
#[test]
#[cfg(unix)]
fn a_signal_acts_within_a_second_whatever_the_sampling_interval_is() {
    let scratch = Scratch::new("bounded");
    fs::write(scratch.0.join("plan.toml"), SMALL.replace("every = 2", "every = 10000000")).unwrap();
    let arguments = ["run", "plan.toml", "--out", "study", "--ramp", "0", "--threads", "1"];
    let partial = scratch.0.join("study/unfinished/0000-0000");
    let mut lengths = Vec::new();
    for _ in 0..2 {
        let mut child = scratch.command(&arguments).stdout(Stdio::null()).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(800));
        let asked = std::time::Instant::now();
        assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130));
        // Half a second more than is promised, since other tests run beside this one.
        assert!(asked.elapsed().as_secs_f64() < 1.5, "{:?}", asked.elapsed());
        lengths.push(fs::read(&partial).unwrap());
    }
    assert!(lengths[0] != lengths[1], "the second process has gone on");
}

#[test]
fn a_plan_may_come_from_standard_input() {
    let scratch = Scratch::new("standard");
    scratch.small_plan();
    let plan = fs::File::open(scratch.0.join("plan.toml")).unwrap();
    let output = scratch.command(&["check", "-"]).stdin(plan).output().unwrap();
    let said = said(&output);
    assert_eq!(code(&output), Some(0));
    assert!(
        said.starts_with("4 ramps of 1 value of 20 cycles, with 2 repeats of each point\n  0 to 1: "),
        "{said}"
    );
}

#[test]
#[cfg(target_os = "linux")]
fn output_that_cannot_be_written_is_an_error_and_a_closed_pipe_is_none() {
    let scratch = Scratch::new("output");
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = scratch.command(&["new"]).stdout(full).output().unwrap();
    assert_eq!(code(&output), Some(1));
    assert!(said(&output).contains("cannot write standard output: No space left"), "{}", said(&output));
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let output = scratch.command(&["new"]).stdout(writer).output().unwrap();
    assert_eq!((code(&output), said(&output).as_str()), (Some(0), ""));
}

#[test]
fn a_number_of_threads_that_no_machine_has_is_refused() {
    let scratch = Scratch::new("threads");
    scratch.small_plan();
    let output = scratch.runs(&["run", "plan.toml", "--out", "study", "--threads", "100000"]);
    assert_eq!(code(&output), Some(2));
    assert!(said(&output).contains("100000 is not in 1..=4096"), "{}", said(&output));
}

/// An error shows the beginning of the line that it is about, however long that line is.
#[test]
fn a_long_line_is_not_repeated() {
    let scratch = Scratch::new("long");
    let long = format!("values = [{}]", "0.1, ".repeat(40_000));
    fs::write(
        scratch.0.join("plan.toml"),
        SMALL.replace("values = [0.0, 0.1]", &long).replace("seed = 1", "sede = 1"),
    )
    .unwrap();
    let output = scratch.runs(&["check", "plan.toml"]);
    assert_eq!(code(&output), Some(2));
    assert!(
        said(&output).len() < 1000 && said(&output).contains("unknown field `sede`"),
        "{}",
        said(&output)
    );
    fs::write(
        scratch.0.join("plan.toml"),
        SMALL.replace("values = [0.0, 0.1]", &long.replace("0.1, ]", "0.1, x]")),
    )
    .unwrap();
    let output = scratch.runs(&["check", "plan.toml"]);
    assert!(said(&output).len() < 1000 && said(&output).contains("line 17, column"), "{}", said(&output));
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
    assert!(scratch.0.join("study/unfinished/0000-0000").exists());
    assert!(said(&scratch.runs(&["status", "study"])).contains("1 begun"));
}

#[test]
fn bench_tells_the_hours_of_a_plan() {
    let scratch = Scratch::new("bench");
    scratch.small_plan();
    let output = scratch.runs(&["bench", "plan.toml", "--quick", "--json"]);
    assert_eq!(code(&output), Some(0), "{output:?}");
    let hours: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let of = |name: &str| hours[name].as_f64().unwrap();
    assert!(0.0 < of("least") && of("least") <= of("core_hours") && of("core_hours") <= of("most"));
    assert_eq!(hours["values"], 4);
    assert_eq!(code(&scratch.runs(&["bench", "missing.toml"])), Some(1));
}

#[test]
fn a_trajectory_has_a_frame_after_each_cycle() {
    let scratch = Scratch::new("trajectory");
    scratch.small_plan();
    let arguments = ["trajectory", "plan.toml", "--out", "run.xyz", "--ramp", "2", "--cycles", "3"];
    let output = scratch.runs(&arguments);
    assert_eq!(code(&output), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let text = fs::read_to_string(scratch.0.join("run.xyz")).unwrap();
    assert_eq!(text.lines().filter(|line| *line == "20").count(), 3);
    // The file is not overwritten; and there are only four ramps.
    assert_eq!(code(&scratch.runs(&arguments)), Some(1));
    let output = scratch.runs(&["trajectory", "plan.toml", "--out", "other.xyz", "--ramp", "4"]);
    assert_eq!(code(&output), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("below the number of ramps"));
    // A study knows the starts of all its values.
    let ramp = "[ramp]\nparameter = \"gravity\"\nvalues = [0.02, 0.03]\n";
    fs::write(scratch.0.join("ramp.toml"), SMALL.split_once("[[sweep]]").unwrap().0.to_owned() + ramp)
        .unwrap();
    assert_eq!(code(&scratch.runs(&["run", "ramp.toml", "--out", "study", "--threads", "1"])), Some(0));
    let frames = |value: &str, cycles: &str| {
        let name = format!("{value}-{cycles}.csv");
        let place = ["trajectory", "study", "--value", value, "--cycles", cycles, "--out", "value.xyz"];
        assert_eq!(code(&scratch.runs(&place)), Some(0));
        assert_eq!(code(&scratch.runs(&["convert", "value.xyz", &name, "--frame", "0"])), Some(0));
        fs::remove_file(scratch.0.join("value.xyz")).unwrap();
        fs::read_to_string(scratch.0.join(name)).unwrap()
    };
    assert_ne!(frames("0", "1"), frames("1", "1"));
}

/// Returns the lines of a table after its headings.
fn lines(output: &Output) -> Vec<String> {
    assert_eq!(code(output), Some(0), "{}", said(output));
    String::from_utf8_lossy(&output.stdout).lines().skip(1).map(str::to_owned).collect()
}

/// Each value of a ramp is made again from its start, with as many collisions as it had.
#[test]
fn a_value_is_played_back_and_any_collision_of_it() {
    let scratch = Scratch::new("replay");
    let ramp = "[ramp]\nparameter = \"friction\"\nvalues = [0.0, 0.2]\ncourse = \"up\"\n";
    let (head, _) = SMALL.split_once("[[sweep]]").unwrap();
    let plan = head.replace("samples = 5", "samples = 40") + ramp;
    fs::write(scratch.0.join("plan.toml"), plan).unwrap();
    assert_eq!(code(&scratch.runs(&["run", "plan.toml", "--out", "study", "--ramp", "1"])), Some(0));
    assert_eq!(code(&scratch.runs(&["tables", "study"])), Some(0));
    let values = fs::read_to_string(scratch.0.join("study/values.csv")).unwrap();
    let column = |name: &str| {
        let place = values.lines().next().unwrap().split(',').position(|found| found == name).unwrap();
        let cells = values.lines().skip(1).map(|line| line.split(',').nth(place).unwrap().parse().unwrap());
        cells.collect::<Vec<usize>>()
    };
    let counts: Vec<usize> = column("collisions")
        .iter()
        .zip(column("wall_collisions"))
        .map(|(disks, walls)| disks + walls)
        .collect();
    let of = |arguments: &[&str]| scratch.runs(&[&["replay", "study", "--ramp", "1"], arguments].concat());
    let all = lines(&of(&["--from", "-1"]));
    let second = lines(&of(&["--value", "1", "--from", "-1"]));
    assert!([all.len(), second.len()] == [counts[0], counts[1]] && counts[1] > 100, "{counts:?}");
    assert!(second[0].starts_with(&format!("{},", counts[0] + 1)), "{}", second[0]);
    assert!(
        second.iter().any(|line| line.ends_with("Sliding")) && second.iter().any(|l| l.contains(",floor,"))
    );
    // The plan alone has the start of the first value.
    assert_eq!(lines(&scratch.runs(&["replay", "plan.toml", "--ramp", "1", "--from", "-1"])), all);
    assert_eq!(lines(&of(&[])), all[counts[0] - 10..]);
    let cell = |line: &str, place: usize| line.split(',').nth(place).unwrap().to_owned();
    let is_own = |line: &&String| [2, 3].iter().any(|&place| cell(line, place) == "7");
    let own: Vec<String> = all.iter().filter(is_own).cloned().collect();
    assert_eq!(lines(&of(&["--disk", "7", "--last", "3"])), own[own.len() - 3..]);
    // A window has the times after its start and up to its end.
    let [from, until] = [100, 120].map(|row| cell(&all[row], 1));
    assert_eq!(lines(&of(&["--from", &from, "--until", &until, "--out", "window.csv"])), [""; 0]);
    let window = fs::read_to_string(scratch.0.join("window.csv")).unwrap();
    assert_eq!(window.lines().skip(1).collect::<Vec<_>>(), all[101..=120]);
}

/// A run that ended with an error is played back up to it, and compared up to it.
#[test]
fn the_collisions_before_an_error_are_played_back() {
    let scratch = Scratch::new("before-error");
    let (head, _) = SMALL.split_once("[[sweep]]").unwrap();
    let falls = |inelasticity: &str| {
        head.replace("0.02", "0.5")
            .replace("contact_duration = 1e-4", &format!("inelasticity = {inelasticity}"))
    };
    fs::write(scratch.0.join("plan.toml"), falls("0.4")).unwrap();
    fs::write(scratch.0.join("other.toml"), falls("0.401")).unwrap();
    let output = scratch.runs(&["replay", "plan.toml", "--last", "2"]);
    let told = said(&output);
    let [lines @ .., note] = &told.lines().collect::<Vec<_>>()[..] else { panic!("{told}") };
    assert!(code(&output) == Some(0) && lines.len() == 3, "{told}");
    let id = note.rsplit_once("has the id ").unwrap().1;
    assert!(
        note.contains("the run ended: the run stalled at time ") && note.contains("with the wall \"floor\"")
    );
    assert!(lines.iter().any(|line| line.split(',').nth(2) == Some(id)), "{told}");
}

/// Wishes that no run can grant are refused by name, and no file is left or overwritten.
#[test]
fn wishes_that_cannot_be_are_refused() {
    let scratch = Scratch::new("wishes");
    scratch.small_plan();
    fs::write(scratch.0.join("mine.csv"), "mine").unwrap();
    for (arguments, status, reason) in [
        (["--disk", "21"].as_slice(), 2, "there is no disk 21 among the 20 of the run"),
        (&["--from", "7", "--until", "7"], 2, "no time is after 7 and until 7"),
        (&["--from", "nan"], 2, "no time is after NaN"),
        (&["--until", "1e6"], 2, "it cannot go until 1000000"),
        (&["--until", "-1"], 2, "it cannot go until -1"),
        (&["--ramp", "4"], 2, "index of a ramp must be below the number of ramps, but is 4"),
        (&["--value", "1"], 2, "index of a value"),
        (&["--out", "mine.csv"], 1, "cannot write mine.csv"),
        (&["--out", "no/where.csv"], 1, "cannot write no/where.csv"),
    ] {
        let out = if arguments[0] == "--out" { [].as_slice() } else { &["--out", "new.csv"] };
        let output = scratch.runs(&[&["replay", "plan.toml"], arguments, out].concat());
        assert_eq!(code(&output), Some(status), "{arguments:?} {}", said(&output));
        assert!(said(&output).contains(reason), "{arguments:?} {}", said(&output));
    }
    assert!(!scratch.0.join("new.csv").exists());
    assert_eq!(fs::read_to_string(scratch.0.join("mine.csv")).unwrap(), "mine");
    assert_eq!(code(&scratch.runs(&["run", "plan.toml", "--out", "study", "--ramp", "0"])), Some(0));
    let output = scratch.runs(&["replay", "study", "--value", "1"]);
    assert!(
        code(&output) == Some(1) && said(&output).contains("only 1 values are in the ramp"),
        "{output:?}"
    );
}

/// A signal ends a replay at once, without a file half done.
#[test]
#[cfg(unix)]
fn a_signal_ends_a_replay() {
    let scratch = Scratch::new("replay-signal");
    fs::write(scratch.0.join("plan.toml"), SMALL.replace("every = 2", "every = 10000000")).unwrap();
    for arguments in [
        ["replay", "plan.toml", "--out", "new.csv"].as_slice(),
        &["replay", "plan.toml", "--from", "3e7", "--out", "new.csv"],
    ] {
        let mut child = scratch.command(arguments).stdout(Stdio::null()).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(600));
        assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130));
        assert!(!scratch.0.join("new.csv").exists());
    }
}

/// Files of others are read by their contents and written by the ending of the new name; notes and refusals
/// are on standard error.
#[test]
fn files_of_disks_are_converted() {
    let scratch = Scratch::new("convert");
    let dump = "ITEM: TIMESTEP\n5\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp ff pp\n0 10\n0 5\n-1 1\n\
                ITEM: ATOMS id type x y vx vy radius fx\n9 1 11 2 3 4 0.5 7\n4 2 3 2 0 0 0.5 7\n";
    fs::write(scratch.0.join("soft.txt"), dump.to_owned() + &dump.replace("9 1 11 2", "9 1 12.01 2"))
        .unwrap();
    let of = |arguments: &[&str]| scratch.runs(&[&["convert", "soft.txt"], arguments].concat());
    let output = of(&["first.csv", "--frame", "0"]);
    assert_eq!((code(&output), output.stdout.as_slice()), (Some(0), b"".as_slice()), "{}", said(&output));
    let notes: Vec<String> = said(&output).lines().map(str::to_owned).collect();
    assert_eq!(
        notes,
        [
            "note: ignored: fx",
            "note: disks outside of periodic sides, wrapped: 1",
            "note: first.csv has no place for the box of the file",
        ]
    );
    // A row a disk, in the order of the file.
    let text = fs::read_to_string(scratch.0.join("first.csv")).unwrap();
    let expected = "id,kind,x,y,vx,vy,angle,angular_velocity,radius,mass,inertia_factor,image_x,image_y\n\
                    9,0,1.0,2.0,3.0,4.0,0.0,0.0,0.5,1.0,0.5,1,0\n4,1,3.0,2.0,0.0,0.0,0.0,0.0,0.5,1.0,0.5,0,0\n";
    assert_eq!(text, expected);
    // The last frame has an overlap.
    let output = of(&["last.csv"]);
    assert!(
        code(&output) == Some(1)
            && said(&output).contains("line 22: the disk overlaps the disk of line 21 by 0.01")
    );
    assert_eq!(code(&of(&["last.csv", "--frame", "last", "--tolerance", "0.02"])), Some(0));
    let output = of(&["shrunk.xyz", "--shrink"]);
    assert!(
        code(&output) == Some(0)
            && said(&output).contains("all radii are shrunk by the deepest overlap, a share of 0.01")
    );
    for (name, start) in [
        ("a.extxyz", b"2\nLattice=".as_slice()),
        ("a.xyz.gz", &[0x1f, 0x8b]),
        ("a.lammpstrj", b"ITEM: "),
        ("a.dump", b"ITEM: "),
        ("a.gsd", &[0xdf, 0x65]),
        ("a.pvd", b"<?xml"),
        ("a.vtp", b"<?xml"),
        ("a.data", b"LAMMPS data"),
    ] {
        let output = scratch.runs(&["convert", "shrunk.xyz", name]);
        assert_eq!(code(&output), Some(0), "{name} {}", said(&output));
        assert!(fs::read(scratch.0.join(name)).unwrap().starts_with(start), "{name}");
        assert_eq!(code(&scratch.runs(&["convert", "shrunk.xyz", name])), Some(1), "{name} is overwritten");
    }
    assert_eq!(code(&scratch.runs(&["convert", "a.xyz.gz", "again.csv"])), Some(0));
    for (arguments, status, reason) in [
        (["a.png"].as_slice(), 2, "a.png must end in one of .xyz, .extxyz, .lammpstrj, .dump"),
        (&["xyz"], 2, "xyz must end in one of"),
        (&["b.csv", "--frame", "2"], 1, "there is no frame with number 2: the file has 2"),
        (&["b.csv", "--step", "6"], 1, "there is no frame with step 6: the file has 2"),
        (&["b.csv", "--frame", "first"], 2, "invalid value 'first'"),
        (&["b.csv", "--tolerance", "-1"], 2, "tolerance must be finite and not negative, but is -1"),
        (&["b.csv", "--radius", "0"], 2, "radius must be finite and positive, but is 0"),
    ] {
        let output = of(arguments);
        assert_eq!(code(&output), Some(status), "{arguments:?} {}", said(&output));
        assert!(said(&output).contains(reason), "{arguments:?} {}", said(&output));
    }
    assert!(!scratch.0.join("b.csv").exists());
    assert_eq!(code(&scratch.runs(&["convert", "none.xyz", "b.csv"])), Some(1));
}

/// A trajectory is of the format that its name says.
#[test]
fn a_trajectory_is_what_its_name_says() {
    let scratch = Scratch::new("trajectory-names");
    scratch.small_plan();
    let of = |arguments: &[&str]| {
        scratch.runs(&[&["trajectory", "plan.toml", "--cycles", "2"], arguments].concat())
    };
    assert_eq!(code(&of(&["--out", "run.lammpstrj"])), Some(0));
    let text = fs::read_to_string(scratch.0.join("run.lammpstrj")).unwrap();
    assert_eq!(text.matches("ITEM: TIMESTEP").count(), 2);
    assert_eq!(code(&of(&["--out", "run.pvd"])), Some(0));
    for name in ["run.csv", "run.txt"] {
        let output = of(&["--out", name]);
        assert!(
            code(&output) == Some(2) && said(&output).contains("must end in one of .xyz"),
            "{}",
            said(&output)
        );
        assert!(!scratch.0.join(name).exists());
    }
    assert_eq!(code(&of(&["--out", "run.xyz"])), Some(0));
    let start = scratch.runs(&["convert", "run.xyz", "run-as.csv"]);
    assert!(
        code(&start) == Some(0) && said(&start).contains("no place for the box, time, gravity"),
        "{}",
        said(&start)
    );
}

/// What the format written has no place for is told, each by its name.
#[test]
fn a_conversion_tells_what_it_loses() {
    let scratch = Scratch::new("loses");
    fs::write(scratch.0.join("in.csv"), "x,y,radius,angle,inertia_factor\n1.1,1,0.5,100.5,0.4\n").unwrap();
    let told = |out: &str| said(&scratch.runs(&["convert", "in.csv", out]));
    assert!(told("a.data").contains("has no place for the inertia factors, angles of the file"));
    assert!(told("a.dump").contains("has no place for the inertia factors of the file"));
    let gsd = told("a.gsd");
    assert!(gsd.contains("whole turns of angles, digits beyond single precision"), "{gsd}");
    assert!(!told("a.xyz").contains("no place"));
}

/// Without sides, a rule of the walls is for the others.
#[test]
fn walls_may_differ_between_periodic_sides() {
    let scratch = Scratch::new("sides");
    let plan = SMALL.replace("disks = ", "sides = \"periodic\"\nwall_inelasticity = 0.1\ndisks = ");
    fs::write(scratch.0.join("plan.toml"), plan).unwrap();
    let checked = scratch.runs(&["check", "plan.toml"]);
    assert_eq!(code(&checked), Some(0), "{}", said(&checked));
}
