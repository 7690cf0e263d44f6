//! Counts, rates and histograms of collisions.

use super::by_wall::ByWall;
use super::table::{Table, histogram_headings, histogram_rows};
use super::{Collision, Heading, Observer, ObserverError, Partner, Snapshot};
use crate::ParameterError;
use crate::collision::Regime;
use crate::statistics::Histogram;

/// An observer that counts collisions by partner and regime, and gives their rates.
///
/// ```
/// use granular_edmd::observable::CollisionCounts;
/// let counts = CollisionCounts::default();
/// assert_eq!(counts.disk_collisions() + counts.wall_collisions(), 0);
/// assert_eq!(counts.collisions_with_wall("lid"), 0);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct CollisionCounts {
    disks: u64,
    walls: ByWall<u64>,
    /// Collisions in each regime.
    regimes: [u64; Regime::LeastRebound as usize + 1],
}

impl CollisionCounts {
    /// Returns the number of collisions of two disks.
    pub const fn disk_collisions(&self) -> u64 {
        self.disks
    }

    /// Returns the number of collisions with any wall.
    pub fn wall_collisions(&self) -> u64 {
        self.walls.values().sum()
    }

    /// Returns the walls that were touched, numbered in the order of the first run's boundary.
    fn touched(&self) -> impl Iterator<Item = (usize, u64)> {
        self.walls.values().copied().enumerate().filter(|&(_, count)| count > 0)
    }

    /// Returns the number of collisions with the wall or part of this name; 0 if it was never touched.
    pub fn collisions_with_wall(&self, name: &str) -> u64 {
        self.walls.get(name).copied().unwrap_or(0)
    }

    /// Returns the number of collisions in this regime, with disks and walls.
    pub const fn collisions_in_regime(&self, regime: Regime) -> u64 {
        self.regimes[regime as usize]
    }
}

impl Observer for CollisionCounts {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.walls.find_all(start);
        Ok(())
    }

    fn on_collision(&mut self, collision: &Collision) {
        match collision.partner {
            Partner::Disk(_) => self.disks += 1,
            Partner::Wall(wall) => self.walls.at(wall).into_iter().for_each(|count| *count += 1),
        }
        self.regimes[collision.impulse.regime() as usize] += 1;
    }
}

impl Table for CollisionCounts {
    fn headings(&self) -> Vec<Heading> {
        let partners = ["disk_collisions", "wall_collisions"].map(str::to_owned).into_iter();
        let regimes = ["sticking", "sliding", "contact_duration", "elastic_below", "least_rebound"];
        let regimes = regimes.map(str::to_owned);
        let walls = self.touched().map(|(number, _)| format!("wall_{number}"));
        partners.chain(regimes).chain(walls).map(|name| Heading::new(name, "1")).collect()
    }

    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        let partners = [self.disks, self.wall_collisions()].into_iter();
        let reported = self.regimes[1..].iter().copied();
        let counts = partners.chain(reported).chain(self.touched().map(|(_, count)| count));
        let row = counts.map(|count| count as f64).collect();
        Box::new(std::iter::once(row))
    }
}

/// An observer that keeps histograms of the obliqueness, the closing speed and the normal impulse of
/// collisions.
///
/// The obliqueness is the sine of the angle of impact, $`b = v_t/\sqrt{v_n^2 + v_t^2}`$ in `[-1, 1]`, from
/// the relative velocity of the *surfaces*: 0 is head-on. For disks that do not rotate, it is the impact
/// parameter divided by the distance between the centers. In a gas of equal disks that do not rotate, at the
/// temperature $`T`$,
///
/// ```math
/// p(b) = \frac12,\qquad p(v_n) = \frac{v_n}{2T/m}\,e^{-m v_n^2/4T} .
/// ```
///
/// Collisions between disks count, unless [`with_wall`](Self::with_wall) chooses a wall. The errors come from
/// blocks of consecutive collisions, and do not assume that collisions are independent.
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse};
/// use granular_edmd::observable::{Collision, CollisionHistograms, Observer, Partner};
///
/// let mut histograms = CollisionHistograms::new(10.0, 20.0, 4)?;
/// let (contact, impulse) = (Contact::new(3.0, 4.0, 0.5, 0.5 / 3.0), Impulse::new(6.0, 0.0));
/// histograms.on_collision(&Collision::new(0.5, 7, Partner::Disk(8), contact, impulse));
/// let obliqueness: Vec<u64> = histograms.obliqueness().bins().map(|bin| bin.count).collect();
/// assert_eq!(obliqueness, [0, 0, 0, 1]);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct CollisionHistograms {
    walls: ByWall<()>,
    obliqueness: Histogram,
    closing_speed: Histogram,
    impulse: Histogram,
}

impl CollisionHistograms {
    /// Creates histograms of closing speeds up to `speed` and impulses up to `impulse`, each in
    /// `bins` bins.
    ///
    /// # Errors
    /// If the speed or the impulse is not finite and positive, or the number of bins is not in `1..=2^20`.
    pub fn new(speed: f64, impulse: f64, bins: usize) -> Result<Self, ParameterError> {
        Ok(Self {
            walls: ByWall::NONE,
            obliqueness: Histogram::new(-1.0, 1.0, bins)?,
            closing_speed: Histogram::new(0.0, speed, bins)?,
            impulse: Histogram::new(0.0, impulse, bins)?,
        })
    }

    /// Returns the same histograms for the collisions with the wall or part of this name.
    ///
    /// A run ends with an error if there is no such wall.
    #[must_use]
    pub fn with_wall(mut self, name: impl Into<String>) -> Self {
        self.walls.insert(name.into(), ());
        self
    }

    /// Returns the histogram of the obliqueness.
    pub const fn obliqueness(&self) -> &Histogram {
        &self.obliqueness
    }

    /// Returns the histogram of the speed at which the surfaces close, v_n.
    pub const fn closing_speed(&self) -> &Histogram {
        &self.closing_speed
    }

    /// Returns the histogram of the normal impulse, Δ_n.
    pub const fn impulse(&self) -> &Histogram {
        &self.impulse
    }
}

impl Observer for CollisionHistograms {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        Ok(self.walls.find(start)?)
    }

    fn on_collision(&mut self, collision: &Collision) {
        let counts = match collision.partner {
            Partner::Disk(_) => self.walls.is_empty(),
            Partner::Wall(wall) => self.walls.at(wall).is_some(),
        };
        if !counts {
            return;
        }
        let (closing, slip) = (collision.contact.closing_speed(), collision.contact.slip_speed());
        // Without a relative velocity there is no angle of impact: the quotient is NaN, which a histogram
        // leaves out.
        self.obliqueness.push(slip / (closing * closing + slip * slip).sqrt());
        self.closing_speed.push(closing);
        self.impulse.push(collision.impulse.normal());
    }
}

impl Table for CollisionHistograms {
    fn headings(&self) -> Vec<Heading> {
        let names = [("obliqueness", "1"), ("closing_speed", "length/time"), ("impulse", "mass length/time")];
        histogram_headings(names)
    }

    fn rows(&self) -> Box<dyn Iterator<Item = Vec<f64>> + '_> {
        histogram_rows([&self.obliqueness, &self.closing_speed, &self.impulse])
    }
}
