//! The machine and the build of a measurement.

use std::fmt;
use std::fs;

use crate::instructions::Instructions;

/// The machine and the build of a measurement. Times from different machines or builds cannot be compared.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Circumstances {
    /// Name of the processor, if the system reports it.
    pub processor: String,
    /// Number of processors.
    pub processors: usize,
    /// Operating system and architecture.
    pub system: String,
    /// Number of processes that ran or waited in the last minute, this one among them; unknown if empty.
    pub load: String,
    /// Version of this crate.
    pub version: String,
    /// Optimization and vector instructions with which the crate was compiled, and the instructions that it
    /// chooses on this processor.
    pub build: String,
}

impl Circumstances {
    /// Returns the present circumstances.
    pub fn present() -> Self {
        let known = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let name = known.lines().find(|line| line.starts_with("model name"));
        let name = name.and_then(|line| line.split_once(':')).map_or("unknown", |(_, name)| name.trim());
        let load = fs::read_to_string("/proc/loadavg").unwrap_or_default();
        let optimized = if cfg!(debug_assertions) { "with debug assertions" } else { "release" };
        let wide = if cfg!(target_feature = "avx2") { "native AVX2" } else { "no flags" };
        Self {
            processor: name.to_owned(),
            processors: std::thread::available_parallelism().map_or(1, usize::from),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            load: load.split_whitespace().next().unwrap_or_default().to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            build: format!("{optimized}, {wide}, runs with {}", Instructions::detected().level().name()),
        }
    }
}

impl fmt::Display for Circumstances {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { processor, processors, system, load, version, build } = self;
        let load = if load.is_empty() { "unknown" } else { load };
        write!(
            formatter,
            "{processor}, {processors} processors, load {load}; {system}; granular-edmd {version}, {build}"
        )
    }
}
