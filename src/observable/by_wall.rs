//! Values of walls and parts, by name.

use super::Snapshot;
use super::snapshot::Mark;
use crate::ParameterError;
use crate::boundary::WallView;

/// Largest number of names that an error lists.
const LISTED: usize = 8;

/// A value for each of some walls and parts. All walls of a part share a value, unless one of them is named
/// by its number, as in "funnel, brick 2".
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub(super) struct ByWall<T> {
    values: Vec<(String, T)>,
    /// For each wall of the present run, the place of its value.
    #[cfg_attr(feature = "serde", serde(skip))]
    places: Vec<Option<usize>>,
    #[cfg_attr(feature = "serde", serde(skip))]
    walls: Mark,
}

impl<T: Default> ByWall<T> {
    /// No walls.
    pub(super) const NONE: Self = Self { values: Vec::new(), places: Vec::new(), walls: Mark::NONE };

    /// Sets the value of a name.
    pub(super) fn insert(&mut self, name: String, value: T) {
        self.values.retain(|(other, _)| *other != name);
        self.values.push((name, value));
        self.walls = Mark::NONE;
    }

    /// Finds the walls of the names in the boundary of a run.
    ///
    /// # Errors
    /// If no wall and no part has one of the names.
    pub(super) fn find(&mut self, start: &Snapshot<'_>) -> Result<(), ParameterError> {
        if self.walls.is_same(start.walls_mark()) {
            return Ok(());
        }
        self.walls = start.walls_mark();
        let place = |name: &str| self.values.iter().position(|(other, _)| other == name);
        let of = |wall: WallView<'_>| place(&wall.name).or_else(|| place(&wall.to_string()));
        self.places = start.walls().map(of).collect();
        let missing = |place: &usize| !self.places.contains(&Some(*place));
        match (0..self.values.len()).find(missing) {
            Some(place) => Err(unknown(&self.values[place].0, start)),
            None => Ok(()),
        }
    }

    /// Finds all walls of a run, and adds the names that are new.
    pub(super) fn find_all(&mut self, start: &Snapshot<'_>) {
        if self.walls.is_same(start.walls_mark()) {
            return;
        }
        self.walls = start.walls_mark();
        self.places.clear();
        for wall in start.walls() {
            // The walls of a part follow each other.
            let last = self.places.last().copied().flatten().filter(|&last| self.values[last].0 == wall.name);
            let known = last.or_else(|| self.values.iter().position(|(other, _)| *other == wall.name));
            if known.is_none() {
                self.values.push((wall.name.into_owned(), T::default()));
            }
            self.places.push(known.or(Some(self.values.len() - 1)));
        }
    }

    /// Returns the value of a wall of the present run.
    #[inline]
    pub(super) fn at(&mut self, wall: usize) -> Option<&mut T> {
        let place = self.places.get(wall).copied().flatten()?;
        self.values.get_mut(place).map(|(_, value)| value)
    }

    /// Iterates over the values, each with the first of its walls in the present run.
    pub(super) fn first_walls(&mut self) -> impl Iterator<Item = (usize, &mut T)> {
        let places = &self.places;
        let first = |place: usize| places.iter().position(|&found| found == Some(place));
        let values = self.values.iter_mut().enumerate();
        values.filter_map(move |(place, (_, value))| Some((first(place)?, value)))
    }

    /// Returns the value of a name.
    pub(super) fn get(&self, name: &str) -> Option<&T> {
        self.values.iter().find(|(other, _)| other == name).map(|(_, value)| value)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    pub(super) fn values(&self) -> impl Iterator<Item = &T> {
        self.values.iter().map(|(_, value)| value)
    }
}

impl<T: PartialEq> PartialEq for ByWall<T> {
    fn eq(&self, other: &Self) -> bool {
        self.values == other.values
    }
}

fn unknown(name: &str, start: &Snapshot<'_>) -> ParameterError {
    let mut names: Vec<String> = start.walls().map(|wall| format!("\"{}\"", wall.name)).collect();
    names.dedup();
    let more = if names.len() > LISTED { ", …" } else { "" };
    names.truncate(LISTED);
    let known = if names.is_empty() { "none".to_owned() } else { names.join(", ") + more };
    let name = format!("number of walls named \"{name}\"");
    ParameterError::new(name, format!("at least 1 (the boundary has {known})"), 0.0)
}
