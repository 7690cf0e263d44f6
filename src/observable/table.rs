//! Series as tables in text.

use std::io::{self, Write};

use super::{Heading, Series, Tabular};

impl<Q: Tabular> Series<Q> {
    /// Writes the series as comma-separated values: a line of headings, such as `center_y [length]`, and a
    /// line for each time.
    ///
    /// The heading of a pure number has no unit. Numbers read back to the same bits. An undefined number is
    /// `NaN`.
    ///
    /// ```
    /// use granular_edmd::boundary::Domain;
    /// use granular_edmd::observable::{
    ///     CenterOfMass, Observer, OrderParameters, SampleTimes, Series, Snapshot,
    /// };
    ///
    /// let mut series = Series::new((OrderParameters, CenterOfMass), SampleTimes::every(0.5)?);
    /// series.on_sample(&Snapshot::new(0.5, &[], Domain::new(0.0, 4.0, 0.0, 6.0), 1.0));
    /// let mut table = Vec::new();
    /// series.write_csv(&mut table)?;
    /// let heading = "time [time],one_roll [length/time],two_rolls [length/time],\
    ///                center_x [length],center_y [length]";
    /// assert_eq!(String::from_utf8(table)?, format!("{heading}\n0.5,0.0,0.0,NaN,NaN\n"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the writer fails, two columns have the same name, or a name or a unit has characters that a table
    /// cannot hold.
    pub fn write_csv(&self, mut out: impl Write) -> io::Result<()> {
        writeln!(out, "{}", self.labels()?.join(","))?;
        for row in self.rows() {
            let cells: Vec<String> = row?.iter().map(|number| format!("{number:?}")).collect();
            writeln!(out, "{}", cells.join(","))?;
        }
        out.flush()
    }

    /// Writes the series as JSON lines: an object for each time, with the headings of
    /// [`write_csv`](Self::write_csv) as keys.
    ///
    /// Numbers read back to the same bits. A number that is not finite is `null`.
    ///
    /// ```
    /// use granular_edmd::boundary::Domain;
    /// use granular_edmd::observable::{CenterOfMass, Observer, SampleTimes, Series, Snapshot};
    ///
    /// let mut series = Series::new(CenterOfMass, SampleTimes::every(0.5)?);
    /// series.on_sample(&Snapshot::new(0.5, &[], Domain::new(0.0, 4.0, 0.0, 6.0), 1.0));
    /// let mut lines = Vec::new();
    /// series.write_json_lines(&mut lines)?;
    /// let line = "{\"time [time]\":0.5,\"center_x [length]\":null,\"center_y [length]\":null}\n";
    /// assert_eq!(String::from_utf8(lines)?, line);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The same as for [`write_csv`](Self::write_csv).
    pub fn write_json_lines(&self, mut out: impl Write) -> io::Result<()> {
        let labels = self.labels()?;
        for row in self.rows() {
            let row = row?;
            let members: Vec<String> = labels.iter().zip(row).map(member).collect();
            writeln!(out, "{{{}}}", members.join(","))?;
        }
        out.flush()
    }

    /// Returns the headings of all columns as they appear in files.
    fn labels(&self) -> io::Result<Vec<String>> {
        let headings = [vec![Heading::new("time", "time")], self.observable().headings()].concat();
        check(&headings)?;
        Ok(headings.iter().map(label).collect())
    }

    /// Returns the rows, each with a number for each heading.
    fn rows(&self) -> impl Iterator<Item = io::Result<Vec<f64>>> {
        let columns = 1 + self.observable().headings().len();
        self.iter().map(move |(time, value)| {
            let mut row = vec![time];
            self.observable().add_numbers(value, &mut row);
            if row.len() == columns {
                return Ok(row);
            }
            let message = format!("a row has {} numbers for {columns} headings", row.len());
            Err(io::Error::new(io::ErrorKind::InvalidInput, message))
        })
    }
}

fn label(heading: &Heading) -> String {
    let (name, unit) = (heading.name(), heading.unit());
    if unit == "1" { name.to_owned() } else { format!("{name} [{unit}]") }
}

fn member((label, number): (&String, f64)) -> String {
    if number.is_finite() { format!("\"{label}\":{number:?}") } else { format!("\"{label}\":null") }
}

/// Checks that all names differ, and that names and units need no quotes.
fn check(headings: &[Heading]) -> io::Result<()> {
    let refuse = |message: String| Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    for (index, heading) in headings.iter().enumerate() {
        let (name, unit) = (heading.name(), heading.unit());
        if name.is_empty() || !name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_') {
            return refuse(format!(
                "the name of a column must be of letters, digits and underscores, but is {name:?}"
            ));
        }
        if unit.contains(['"', ',', '\\', '[', ']']) || unit.chars().any(char::is_control) {
            return refuse(format!("the unit of a column must be in plain words, but is {unit:?}"));
        }
        if headings[..index].iter().any(|other| other.name() == name) {
            return refuse(format!("two columns are named {name:?}"));
        }
    }
    Ok(())
}
