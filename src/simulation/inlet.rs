//! Inlets, which let disks into a run.

use std::collections::VecDeque;

use glam::DVec2;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::observable::SampleTimes;
use crate::quantity::{accept, finite};
use crate::random::{Stream, generator_at, uniform};
use crate::{Disk, Kind, ParameterError};

/// An inlet: it lets disks into a run, at set times and at random positions in a rectangle.
///
/// At each opening, an inlet from [`new`](Self::new) lets in one disk, and an inlet from
/// [`refill`](Self::refill) lets in all disks that sinks have removed since the last opening. A disk for
/// which it finds no room waits until the inlet opens again, and the other disks wait behind it. A disk that
/// enters has a new [id](Disk::id) and the largest index, and has collided with nothing yet. An insertion
/// takes the same time however many disks there are.
///
/// The random numbers of an opening follow from the seed, the number of the inlet in its run and the time of
/// the opening. Several inlets of a run may therefore have the same seed.
///
/// An inlet and its waiting disks are part of the state of a run, and therefore of its checkpoints.
///
/// ```
/// use granular_edmd::prelude::*;
/// use granular_edmd::simulation::Inlet;
///
/// // A shower of four grains per unit of time, onto a floor that takes them out.
/// let container = Container::open(10.0)?.absorbing(Wall::Floor)?;
/// let mut run = Simulation::builder(Elastic, container).gravity(1.0).build()?;
/// let grain = Disk::new(DVec2::ZERO, 0.5)?.with_velocity(DVec2::new(0.0, -2.0))?;
/// let places = [DVec2::new(1.0, 8.0), DVec2::new(9.0, 9.0)];
/// run.add_inlet(Inlet::new(places, [grain], SampleTimes::every(0.25)?, 7)?)?;
/// run.run_until(100.0, &mut ())?;
/// let counters = run.counters();
/// assert_eq!(counters.insertions, 400);
/// assert_eq!(counters.insertions - counters.removals, run.len() as u64);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Inlet {
    /// Lower left and upper right corners of the rectangle that holds the new centers.
    places: [DVec2; 2],
    source: Source,
    pub(super) times: SampleTimes,
    pub(super) seed: u64,
    pub(super) waiting: VecDeque<Disk>,
}

/// The disks that enter through the inlet.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
enum Source {
    New(Vec<Disk>),
    TakenOut { velocity: DVec2, kind: Option<Kind> },
}

crate::gate::from_file! {
    Inlet {
        places: [DVec2; 2], source: Source, times: SampleTimes, seed: u64, waiting: VecDeque<Disk>
    } => Self { places, source, times, seed, waiting }.checked()
}

impl Inlet {
    /// Creates an inlet that lets in one disk at each of these times: a copy of one of the models, drawn at
    /// random.
    ///
    /// Its center is in the rectangle with the corners `places`: first the lower left, then the upper right.
    /// The copy has the radius, mass, inertia, kind, velocity and spin of its model; the positions of models
    /// have no meaning. For a distribution of sizes, give a list of disks, for example with radii that
    /// [`Radii`](crate::initial::Radii) draws.
    ///
    /// # Errors
    /// If there are no models, or the corners are not finite or not in this order.
    pub fn new(
        places: [DVec2; 2],
        models: impl IntoIterator<Item = Disk>,
        times: SampleTimes,
        seed: u64,
    ) -> Result<Self, ParameterError> {
        Self::of(places, Source::New(models.into_iter().collect()), times, seed)
    }

    /// Creates an inlet that puts back the disks that sinks have removed, at each of these times.
    ///
    /// A disk comes back at the given velocity and without a spin, and keeps its radius, mass, inertia and
    /// kind. If there are several such inlets, the inlet with the fewest waiting disks gets the next disk.
    ///
    /// # Errors
    /// If a disk cannot have the velocity, or the corners are not finite or not in this order.
    pub fn refill(
        places: [DVec2; 2],
        velocity: DVec2,
        times: SampleTimes,
        seed: u64,
    ) -> Result<Self, ParameterError> {
        Self::of(places, Source::TakenOut { velocity, kind: None }, times, seed)
    }

    /// Returns the same inlet, whose disks all enter with this kind.
    #[must_use]
    pub fn with_kind(mut self, new: Kind) -> Self {
        match &mut self.source {
            Source::New(models) => models.iter_mut().for_each(|model| *model = model.with_kind(new)),
            Source::TakenOut { kind, .. } => *kind = Some(new),
        }
        self
    }

    /// Returns the number of disks that wait for room, or for the next opening.
    pub fn waiting(&self) -> usize {
        self.waiting.len()
    }

    /// Returns the corners of the rectangle.
    pub const fn places(&self) -> [DVec2; 2] {
        self.places
    }

    fn of(places: [DVec2; 2], source: Source, times: SampleTimes, seed: u64) -> Result<Self, ParameterError> {
        Self { places, source, times, seed, waiting: VecDeque::new() }.checked()
    }

    fn checked(self) -> Result<Self, ParameterError> {
        let [low, high] = self.places;
        for (from, to) in [(low.x, high.x), (low.y, high.y)] {
            finite("place of an inlet", from)?;
            accept(to.is_finite() && to >= from, "end of an inlet", "finite, and not before its start", to)?;
        }
        match &self.source {
            Source::New(models) => {
                let count = models.len();
                accept(count > 0, "number of models of an inlet", "positive", count as f64)?;
            }
            Source::TakenOut { velocity, .. } => {
                Disk::new(DVec2::ZERO, 1.0)?.with_velocity(*velocity)?;
            }
        }
        Ok(self)
    }

    /// Returns the models, whose copies enter.
    pub(super) fn models(&self) -> &[Disk] {
        if let Source::New(models) = &self.source { models } else { &[] }
    }

    /// Returns the diameter of the largest model; 0 without models.
    pub(super) fn largest_diameter(&self) -> f64 {
        2.0 * self.models().iter().map(Disk::radius).fold(0.0, f64::max)
    }

    /// Returns the velocity of returning disks if the inlet puts back disks that sinks remove.
    pub(super) fn velocity_of_return(&self) -> Option<DVec2> {
        if let Source::TakenOut { velocity, .. } = self.source { Some(velocity) } else { None }
    }

    /// Receives a disk that a sink has removed.
    pub(super) fn take_back(&mut self, gone: &Disk) {
        if let Source::TakenOut { velocity, kind } = self.source {
            let model = Disk::at_rest(gone.radius(), gone.mass(), gone.inertia_factor(), gone.kind());
            let model = model.with_kind(kind.unwrap_or(gone.kind()));
            self.waiting.extend(model.with_velocity(velocity));
        }
    }

    /// Starts an opening at this time, and advances to the next opening. Returns the random numbers of the
    /// opening, which differ between the inlets of a run by their `number`.
    pub(super) fn open(&mut self, time: f64, number: usize) -> Xoshiro256PlusPlus {
        let mut random = generator_at(self.seed, Stream::Inlets, number as u64, time);
        self.times.advance_past(time);
        if let Source::New(models) = &self.source {
            let drawn = (uniform(&mut random) * models.len() as f64) as usize;
            self.waiting.extend(models.get(drawn));
        }
        random
    }

    /// Returns a disk without an id at a random position of the inlet.
    pub(super) fn placed(&self, disk: &Disk, random: &mut Xoshiro256PlusPlus) -> Option<Disk> {
        let [low, high] = self.places;
        let mut along = |low: f64, high: f64| low + (high - low) * uniform(random);
        let place = DVec2::new(along(low.x, high.x), along(low.y, high.y));
        disk.with_image([0; 2]).identified(0).with_position(place).ok()
    }
}
