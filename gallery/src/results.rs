//! The results of an example: a table, a picture, and numbers as JSON.

use std::error::Error;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Map, Value};

use crate::command_line::make_folder;
use crate::failure::{Failure, named};
use crate::output;
use crate::sheet::Sheet;

/// The places of the results.
#[derive(Debug, Clone, Args)]
pub struct Results {
    /// Folder for the results.
    #[arg(long, value_name = "FOLDER", default_value = "out")]
    out: PathBuf,
    /// File for the numbers as JSON; - is standard output, and the rest goes to standard error.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

impl Results {
    /// Creates the folder if it does not exist, and checks before a long run that the folder of the JSON file
    /// exists.
    pub fn make_folder(&self) -> Result<(), Failure> {
        make_folder(&self.out)?;
        if self.json_is_printed() {
            output::leave_to_json();
        }
        let parent = self.json.as_ref().and_then(|path| path.parent());
        if let Some(folder) = parent.filter(|folder| !folder.as_os_str().is_empty() && !folder.is_dir()) {
            return Err(Failure::run(format_args!("--json: there is no folder {}", folder.display())));
        }
        Ok(())
    }

    fn json_is_printed(&self) -> bool {
        self.json.as_ref().is_some_and(|path| path == "-")
    }

    /// Returns the path of a result of this name.
    pub fn path(&self, name: &str) -> PathBuf {
        self.out.join(name)
    }

    /// Begins the table of this name, with these columns.
    pub fn table(&self, name: &str, columns: &[&str]) -> Result<csv::Writer<File>, Box<dyn Error>> {
        let mut table = table(&self.out.join(name).with_extension("csv"))?;
        table.write_record(columns)?;
        Ok(table)
    }

    /// Ends the table of this name, and writes the picture, as SVG and PNG, and the numbers.
    pub fn finish(
        &self,
        name: &str,
        mut table: csv::Writer<File>,
        picture: &Sheet,
        numbers: &Value,
    ) -> Result<(), Box<dyn Error>> {
        named(&self.out.join(name).with_extension("csv"), table.flush())?;
        self.finish_picture(name, picture, numbers)
    }

    /// Writes a table of this name with a function, and then the picture and the numbers.
    pub fn finish_with(
        &self,
        name: &str,
        table: impl FnOnce(&mut dyn Write) -> io::Result<()>,
        picture: &Sheet,
        numbers: &Value,
    ) -> Result<(), Box<dyn Error>> {
        let path = self.out.join(name).with_extension("csv");
        named(&path, File::create(&path).and_then(|mut file| table(&mut file)))?;
        self.finish_picture(name, picture, numbers)
    }

    fn finish_picture(&self, name: &str, picture: &Sheet, numbers: &Value) -> Result<(), Box<dyn Error>> {
        let path = self.out.join(name);
        picture.write(&path)?;
        crate::say!("wrote {0}.svg, {0}.png and {0}.csv", path.display());
        self.write_json(numbers)
    }

    /// Writes numbers as JSON, if requested.
    pub fn write_json(&self, numbers: &Value) -> Result<(), Box<dyn Error>> {
        let Some(path) = &self.json else { return Ok(()) };
        let text = serde_json::to_string_pretty(numbers)?;
        if self.json_is_printed() {
            output::json(&text).map_err(|error| format!("--json -: {error}"))?;
            return Ok(());
        }
        fs::write(path, text).map_err(|error| format!("--json {}: {error}", path.display()))?;
        crate::say!("wrote {}", path.display());
        Ok(())
    }

    /// Ends the table of this name, writes the picture, if there is one, and the rows of the table as JSON.
    pub fn finish_table(
        &self,
        name: &str,
        mut table: csv::Writer<File>,
        picture: Option<&Sheet>,
    ) -> Result<(), Box<dyn Error>> {
        let path = self.path(name).with_extension("csv");
        named(&path, table.flush())?;
        let table = path;
        if let Some(picture) = picture {
            picture.write(&self.path(name))?;
            crate::say!("wrote {0}.svg and {0}.png", self.path(name).display());
        }
        crate::say!("wrote {}", table.display());
        self.write_tables_as_json(&[(name, table)])
    }

    /// Writes tables as JSON under these names, if requested: each row as an object.
    pub fn write_tables_as_json(&self, tables: &[(&str, PathBuf)]) -> Result<(), Box<dyn Error>> {
        if self.json.is_none() {
            return Ok(());
        }
        let named = tables.iter().map(|(name, table)| Ok(((*name).to_owned(), rows(table)?)));
        self.write_json(&Value::Object(named.collect::<Result<_, Box<dyn Error>>>()?))
    }
}

/// Begins a table.
pub fn table(path: &Path) -> io::Result<csv::Writer<File>> {
    Ok(csv::Writer::from_writer(named(path, File::create(path))?))
}

/// Returns the rows of a table as objects. An empty cell is `null`.
fn rows(table: &Path) -> Result<Value, Box<dyn Error>> {
    let mut table = csv::Reader::from_path(table)?;
    let columns = table.headers()?.clone();
    let row = |row: csv::StringRecord| {
        columns.iter().map(str::to_owned).zip(row.iter().map(cell)).collect::<Map<_, _>>()
    };
    Ok(table.records().map(|record| record.map(row)).collect::<Result<Vec<_>, _>>()?.into())
}

fn cell(text: &str) -> Value {
    let number = || serde_json::from_str(text).ok().filter(Value::is_number);
    if text.is_empty() { Value::Null } else { number().unwrap_or_else(|| text.into()) }
}
