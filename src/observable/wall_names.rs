//! The names of walls, by which observers notice that an index means another wall than before.

use super::Snapshot;
use super::marks::Mark;
use crate::ParameterError;

/// The names of all walls in the latest run. Like marks, they are not written to files, and measurements that
/// differ only in these names compare equal.
#[derive(Debug, Clone, Default)]
pub(super) struct WallNames {
    walls: Mark,
    names: Vec<String>,
}

impl WallNames {
    /// No names yet.
    pub(super) const NONE: Self = Self { walls: Mark::NONE, names: Vec::new() };

    /// Checks that the index of each measured wall belongs to the same wall as before, since values of
    /// different walls must not be added.
    ///
    /// # Errors
    /// If the wall of such an index has another name than in the run before.
    pub(super) fn check(
        &mut self,
        start: &Snapshot<'_>,
        is_measured: impl Fn(usize) -> bool,
    ) -> Result<(), ParameterError> {
        if self.walls.is_same(start.walls_mark()) {
            return Ok(());
        }
        let names = start.wall_names();
        let pairs = self.names.iter().zip(&names).enumerate();
        let mut changed = pairs.filter(|&(wall, (before, now))| before != now && is_measured(wall));
        if let Some((wall, (before, now))) = changed.next() {
            let name = format!("index of the wall \"{now}\"");
            let requirement =
                format!("the index of \"{before}\", as before; clear the observer, or take a new one");
            return Err(ParameterError::new(name, requirement, wall as f64));
        }
        // Walls that are absent in a run keep their names: they may come back.
        let known = self.names.len().min(names.len());
        self.names.splice(..known, names);
        self.walls = start.walls_mark();
        Ok(())
    }
}

impl PartialEq for WallNames {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Checks that the boundary of a run has walls with these indices.
pub(super) fn check_walls<'a>(
    start: &Snapshot<'_>,
    walls: impl IntoIterator<Item = &'a usize>,
) -> Result<(), ParameterError> {
    let missing = walls.into_iter().find(|&&wall| wall >= start.wall_count());
    let requirement = "less than the number of walls";
    missing.map_or(Ok(()), |&wall| Err(ParameterError::new("index of a wall", requirement, wall as f64)))
}
