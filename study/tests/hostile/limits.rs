//! Tests in their own processes, which the system limits.

use std::process::{Command, Output};

/// The limits of a process.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    pub(crate) memory_kib: u64,
    pub(crate) seconds: u64,
    /// Largest size of a file. More cannot be written.
    pub(crate) file_kib: Option<u64>,
}

/// The end of a process.
#[derive(Debug)]
pub(crate) struct End(pub(crate) Output);

impl End {
    pub(crate) fn said(&self) -> String {
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        format!("{}\n{}", text(&self.0.stdout), text(&self.0.stderr))
    }
}

/// Runs an ignored test of this executable in a process with these limits.
///
/// A file that grows too large is an error of the write, as on a full disk, not a signal.
pub(crate) fn in_child(test: &str, limits: &Limits, variables: &[(&str, &str)]) -> End {
    let file = limits.file_kib.map_or(String::new(), |kib| format!("trap '' XFSZ; ulimit -f {};", 2 * kib));
    let script = format!(
        "ulimit -v {}; ulimit -t {}; {file} exec \"$0\" --exact {test} --ignored --nocapture",
        limits.memory_kib, limits.seconds
    );
    let executable = std::env::current_exe().unwrap();
    let mut command = Command::new("sh");
    command.arg("-c").arg(script).arg(executable).env("RUST_BACKTRACE", "0");
    // The limits of the process also hold for its children. The cases are those of the child itself.
    command.envs(variables.iter().copied());
    End(command.output().unwrap())
}
