//! Disks as a table of comma-separated values.

use std::io::{self, BufRead, Write};

use super::entry::{Columns, Entry, Field};
use super::lines::Lines;
use super::{ReadError, State};
use crate::disk::numbered;

impl State {
    /// Reads disks from a table of comma-separated values.
    ///
    /// The first line names the columns: `x`, `y` and `radius`, and any of `id`, `kind`, `vx`, `vy`, `angle`,
    /// `angular_velocity`, `mass`, `inertia_factor`, `image_x` and `image_y`. Where there is no column, a
    /// disk has the value that [`Disk::new`](crate::Disk::new) gives it. A table has no time and no box.
    ///
    /// # Errors
    /// If the input fails, a column is missing, is unknown or appears twice, a number cannot be read or is
    /// out of range, a value is missing, an `id` appears twice, or disks overlap. The error names the line.
    ///
    /// ```
    /// use granular_edmd::trajectory::State;
    /// let error = State::from_csv("x,y,radius,weight\n".as_bytes()).unwrap_err();
    /// let known = "one of id, kind, x, y, vx, vy, angle, angular_velocity, radius, mass, inertia_factor, \
    ///              image_x, image_y";
    /// assert_eq!(error.to_string(), format!("line 1: a column must be {known}, but is \"weight\""));
    /// ```
    pub fn from_csv(input: impl BufRead) -> Result<Self, ReadError> {
        let mut lines = Lines::new(input);
        let (names, line) = lines.need("the names of the columns")?;
        let fields = names.split(',').map(|name| field(name, line)).collect::<Result<_, _>>()?;
        let columns = Columns::new(fields, line)?;
        let mut entries = Vec::new();
        while let Some((text, line)) = lines.next_filled()? {
            entries.push(columns.entry(text.split(','), line)?);
        }
        let disks = Entry::checked(entries, None)?;
        Ok(Self { disks, domain: None, time: None, gravity: None })
    }

    /// Writes the disks as a table that [`from_csv`](Self::from_csv) reads back to the same bits.
    ///
    /// # Errors
    /// If the writer fails.
    pub fn write_csv(&self, mut out: impl Write) -> io::Result<()> {
        writeln!(out, "{}", Field::NAMED.map(|(name, _)| name).join(","))?;
        for (id, disk) in numbered(&self.disks) {
            let (position, velocity, [right, up]) = (disk.position(), disk.velocity(), disk.image());
            write!(out, "{id},{},{:?},{:?},", disk.kind().number(), position.x, position.y)?;
            write!(out, "{:?},{:?},{:?},", velocity.x, velocity.y, disk.angle())?;
            write!(out, "{:?},{:?},{:?},", disk.angular_velocity(), disk.radius(), disk.mass())?;
            writeln!(out, "{:?},{right},{up}", disk.inertia_factor())?;
        }
        out.flush()
    }
}

/// Returns the field of this name.
fn field(name: &str, line: usize) -> Result<Field, ReadError> {
    let name = name.trim();
    let known = Field::NAMED.iter().find(|(known, _)| *known == name).map(|(_, field)| *field);
    known.ok_or_else(|| {
        let names = Field::NAMED.map(|(name, _)| name).join(", ");
        ReadError::unexpected(line, "a column", format!("one of {names}"), name)
    })
}
