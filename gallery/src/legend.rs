//! Places for legends: corners of a panel where nothing is drawn.

use crate::panel::{Panel, Place};

/// Space between a legend and the edges of its panel, and between its columns.
const INSET: f64 = 12.0;

/// Space around a legend that is free of lines and of the middles of marks.
const CLEAR: f64 = 6.0;

/// Largest distance between the points that stand for a line.
const STEP: f64 = 3.0;

/// Points of a sheet at which something is drawn in its panels.
#[derive(Default)]
pub struct Drawn {
    places: Vec<(f64, f64)>,
}

impl Drawn {
    /// Adds a line through these corners; a single corner is a mark.
    pub fn add(&mut self, corners: &[(f64, f64)]) {
        self.places.extend(corners.first());
        for ends in corners.windows(2) {
            let (from, way) = (ends[0], (ends[1].0 - ends[0].0, ends[1].1 - ends[0].1));
            let steps = (way.0.hypot(way.1) / STEP).ceil().max(1.0) as u32;
            let share = (1..=steps).map(|step| f64::from(step) / f64::from(steps));
            self.places.extend(share.map(|share| (from.0 + share * way.0, from.1 + share * way.1)));
        }
    }

    /// Returns the places of the columns of a legend, one or two, in the first corner of a panel where it
    /// hides nothing. The pair is the width of a column and the height of an entry.
    pub fn free_corner(
        &self,
        panel: &Panel,
        (column, line): (f64, f64),
        entries: usize,
    ) -> Option<Vec<(f64, f64)>> {
        let inside = panel.place;
        let corner = |columns: usize| {
            let width = columns as f64 * (column + INSET) - INSET;
            let height = line * entries.div_ceil(columns) as f64;
            let [left, high] = [inside.x, inside.y].map(|edge| edge + INSET);
            let (right, low) =
                (inside.x + inside.width - INSET - width, inside.y + inside.height - INSET - height);
            let fits = right >= left && low >= high;
            let corners = [(left, high), (right, high), (left, low), (right, low)];
            let free = |&(x, y): &(f64, f64)| fits && self.is_free(Place { x, y, width, height });
            let (x, y) = corners.into_iter().find(free)?;
            Some((0..columns).map(|k| (x + (column + INSET) * k as f64, y)).collect())
        };
        [1, 2].into_iter().find_map(corner)
    }

    fn is_free(&self, place: Place) -> bool {
        let across = place.x - CLEAR..=place.x + place.width + CLEAR;
        let down = place.y - CLEAR..=place.y + place.height + CLEAR;
        !self.places.iter().any(|(x, y)| across.contains(x) && down.contains(y))
    }
}
