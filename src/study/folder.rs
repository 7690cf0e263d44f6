//! Where the files of a study are.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::Specification;
use super::errors::StudyError;
use super::file;

/// What a stranger finds in the folder of a study.
const ABOUT: &str = "\
A study by granular-edmd (event-driven molecular dynamics of frictional, inelastic, rotating disks).

specification.toml    what was simulated: system, protocol, ramp, sweep, seed
values.csv            a row for each value: parameters, means, standard errors, counts
samples.csv           a row for each sample
profiles.csv          packing fraction by height, averaged over the samples of each value
ramps/R/V.record      value V of ramp R: samples, counts and last state, with a checksum; read by the library
ramps/R/V.partial     a value half done
log.jsonl             when values were finished, and the seconds that they took; not a result
lock                  held while a process runs the study

Diameter and mass of a disk are the units. Lost or damaged files come back, the same bytes, when the study is run again
by the same version.
";

/// The folder of a study.
#[derive(Debug, Clone)]
pub(super) struct Folder {
    root: PathBuf,
}

impl Folder {
    pub(super) fn new(root: &Path) -> Self {
        Self { root: root.to_owned() }
    }

    pub(super) fn root(&self) -> &Path {
        &self.root
    }

    pub(super) fn file(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }

    fn specification(&self) -> PathBuf {
        self.file("specification.toml")
    }

    fn ramp(&self, ramp: usize) -> PathBuf {
        self.root.join("ramps").join(format!("{ramp:04}"))
    }

    pub(super) fn record(&self, ramp: usize, value: usize) -> PathBuf {
        self.ramp(ramp).join(format!("{value:04}.record"))
    }

    pub(super) fn partial(&self, ramp: usize, value: usize) -> PathBuf {
        self.ramp(ramp).join(format!("{value:04}.partial"))
    }

    pub(super) fn holds_study(&self) -> bool {
        self.specification().exists()
    }

    /// Makes the folder of a new study.
    pub(super) fn create(&self, specification: &Specification) -> Result<(), StudyError> {
        fs::create_dir_all(&self.root).map_err(StudyError::io("create", &self.root))?;
        file::write(&self.file("README.txt"), ABOUT.as_bytes())?;
        file::write(&self.specification(), specification.to_toml()?.as_bytes())
    }

    pub(super) fn read_specification(&self) -> Result<Specification, StudyError> {
        let path = self.specification();
        let text = fs::read_to_string(&path).map_err(StudyError::io("read", &path))?;
        Ok(Specification::from_toml(&text)?)
    }

    /// Makes the folders of all ramps, and removes the temporary files of a killed process.
    pub(super) fn prepare(&self, ramps: usize) -> Result<(), StudyError> {
        file::remove_temporaries(&self.root)?;
        (0..ramps).map(|ramp| self.ramp(ramp)).try_for_each(|folder| {
            fs::create_dir_all(&folder).map_err(StudyError::io("create", &folder))?;
            file::remove_temporaries(&folder)
        })
    }

    /// Adds a line to the log.
    pub(super) fn log(&self, line: &str) -> Result<(), StudyError> {
        let path = self.file("log.jsonl");
        let file = fs::OpenOptions::new().append(true).create(true).open(&path);
        file.and_then(|mut file| file.write_all(format!("{line}\n").as_bytes()))
            .map_err(StudyError::io("write", &path))
    }
}
