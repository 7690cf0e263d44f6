//! The results of an example: a table, a picture, and numbers as JSON.

use std::error::Error;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::PathBuf;

use clap::Args;

use super::command_line::{Failure, make_folder};

/// The places of the results.
#[derive(Debug, Clone, Args)]
pub(crate) struct Results {
    /// Folder for the results.
    #[arg(long, default_value = "out")]
    out: PathBuf,
    /// File for the numbers as JSON.
    #[arg(long)]
    json: Option<PathBuf>,
}

impl Results {
    /// Makes the folder, if there is none, and checks before a long run that there is one for the JSON.
    pub(crate) fn make_folder(&self) -> Result<(), Failure> {
        let parent = self.json.as_ref().and_then(|path| path.parent());
        if let Some(folder) = parent.filter(|folder| !folder.as_os_str().is_empty() && !folder.is_dir()) {
            return Err(Failure::run(format_args!("--json: there is no folder {}", folder.display())));
        }
        make_folder(&self.out)
    }

    /// Begins the table of this name, with these columns.
    pub(crate) fn table(&self, name: &str, columns: &[&str]) -> Result<csv::Writer<File>, Box<dyn Error>> {
        let mut table = csv::Writer::from_path(self.out.join(name).with_extension("csv"))?;
        table.write_record(columns)?;
        Ok(table)
    }

    /// Ends the table of this name, and writes the picture and the numbers.
    pub(crate) fn finish(
        &self,
        name: &str,
        mut table: csv::Writer<File>,
        png: &[u8],
        numbers: &serde_json::Value,
    ) -> Result<(), Box<dyn Error>> {
        table.flush()?;
        self.finish_picture(name, png, numbers)
    }

    /// Writes a table of this name by a function, the picture and the numbers.
    pub(crate) fn finish_with(
        &self,
        name: &str,
        table: impl FnOnce(&mut dyn Write) -> io::Result<()>,
        png: &[u8],
        numbers: &serde_json::Value,
    ) -> Result<(), Box<dyn Error>> {
        table(&mut File::create(self.out.join(name).with_extension("csv"))?)?;
        self.finish_picture(name, png, numbers)
    }

    fn finish_picture(
        &self,
        name: &str,
        png: &[u8],
        numbers: &serde_json::Value,
    ) -> Result<(), Box<dyn Error>> {
        let path = self.out.join(name);
        fs::write(path.with_extension("png"), png)?;
        println!("wrote {0}.png and {0}.csv", path.display());
        if let Some(path) = &self.json {
            let text = serde_json::to_string_pretty(numbers)?;
            fs::write(path, text).map_err(|error| format!("--json {}: {error}", path.display()))?;
            println!("wrote {}", path.display());
        }
        Ok(())
    }
}
