//! The simulation of the page.

use std::error::Error;

use granular_edmd::prelude::*;

use crate::flow::Flow;
use crate::settings::{DISKS, Settings};

/// Most collisions that are marked from one frame to the next.
const MOST_MARKS: usize = 400;

/// The reason why the page cannot do what it was asked for.
pub type Failure = Box<dyn Error>;

/// A shaken box whose parameters change while it runs.
pub struct Rolls {
    simulation: Simulation<ContactDuration<Frictional>, Container>,
    settings: Settings,
    /// A base that waits until no disk is in its way.
    waiting: Option<Settings>,
    /// Time and number of oscillations at which the present base began.
    origin: (f64, f64),
    oscillation: f64,
    flow: Flow,
    /// Oscillation and order parameters of the samples that were not taken yet.
    history: Vec<f64>,
    /// Places of collisions that were not taken yet.
    marks: Vec<f32>,
}

impl Rolls {
    /// Makes a box of disks on a lattice, with velocities by seed.
    ///
    /// # Errors
    /// If a setting is out of its range.
    pub fn new(settings: Settings, seed: u64) -> Result<Self, Failure> {
        let container = settings.container()?;
        let speed = settings.amplitude * settings.angular_frequency;
        let disks = initial::lattice(&container, DISKS, 0.5)?;
        let disks = initial::with_maxwellian_velocities(disks, 0.5 * speed * speed, seed)?;
        let builder = Simulation::builder(settings.rule()?, container).disks(disks);
        Ok(Self {
            simulation: builder.gravity(settings.gravity).seed(seed).build()?,
            settings,
            waiting: None,
            origin: (0.0, 0.0),
            oscillation: 0.0,
            flow: Flow::default(),
            history: Vec::new(),
            marks: Vec::new(),
        })
    }

    /// Changes the settings at the present time. A base that moves otherwise may have to wait for a moment in
    /// which no disk is where it would be.
    ///
    /// # Errors
    /// If a setting is out of its range. All settings are then as before.
    pub fn set(&mut self, settings: Settings) -> Result<(), Failure> {
        let rule = settings.rule()?;
        settings.container()?;
        self.simulation.set_gravity(settings.gravity)?;
        self.simulation.set_rule(rule);
        let Settings { amplitude, angular_frequency, .. } = self.settings;
        self.settings = Settings { amplitude, angular_frequency, ..settings };
        self.waiting = (!settings.has_the_base_of(&self.settings)).then_some(settings);
        self.try_base();
        Ok(())
    }

    /// Puts in the base that waits, if no disk is in its way.
    fn try_base(&mut self) {
        let Some(waiting) = self.waiting else { return };
        let base = waiting.container().map(|container| self.simulation.set_boundary(container));
        if matches!(base, Ok(Ok(()))) {
            self.origin = (self.simulation.time(), self.oscillation);
            self.settings = waiting;
            self.waiting = None;
        }
    }

    /// Goes on by so many oscillations, or parts of one, and samples at the end of each whole one.
    ///
    /// # Errors
    /// If the run cannot go on.
    pub fn advance(&mut self, oscillations: f64, with_marks: bool) -> Result<(), Failure> {
        let end = self.oscillation + oscillations;
        while self.oscillation < end {
            let next = end.min(self.oscillation.floor() + 1.0);
            self.run_to(next, with_marks)?;
            self.oscillation = next;
            if next == next.floor() {
                self.sample();
            }
            self.try_base();
        }
        Ok(())
    }

    /// Runs to a number of oscillations.
    fn run_to(&mut self, oscillation: f64, with_marks: bool) -> Result<(), Failure> {
        let time = self.origin.0 + (oscillation - self.origin.1) * self.settings.period();
        let time = time.max(self.simulation.time());
        if !with_marks {
            self.simulation.run_until(time, &mut ())?;
            return Ok(());
        }
        let marks = &mut self.marks;
        let mut mark = on_collision(|collision: &Collision| {
            if marks.len() < 2 * MOST_MARKS {
                let place = collision.position - 0.5 * collision.normal;
                marks.extend([place.x as f32, place.y as f32]);
            }
        });
        self.simulation.run_until(time, &mut mark)?;
        Ok(())
    }

    /// Goes to the next collision.
    ///
    /// # Errors
    /// If the run cannot go on.
    pub fn step(&mut self) -> Result<(), Failure> {
        let marks = &mut self.marks;
        let mut mark = on_collision(|collision: &Collision| {
            let place = collision.position - 0.5 * collision.normal;
            marks.extend([place.x as f32, place.y as f32]);
        });
        let longest = self.simulation.time() + self.settings.period();
        self.simulation.step_until(longest, &mut mark)?;
        self.oscillation = self.origin.1 + (self.simulation.time() - self.origin.0) / self.settings.period();
        Ok(())
    }

    fn sample(&mut self) {
        let snapshot = self.simulation.snapshot();
        let order = OrderParameters.measure(&snapshot);
        self.history.extend([self.oscillation, order.one_roll, order.two_rolls]);
        self.flow.add(snapshot.disks());
    }

    /// Returns the number of oscillations since the start.
    #[must_use]
    pub const fn oscillation(&self) -> f64 {
        self.oscillation
    }

    /// Returns the number of collisions of two disks.
    #[must_use]
    pub fn collisions(&self) -> u64 {
        self.simulation.counters().collisions
    }

    /// Returns how far the base is from its middle.
    #[must_use]
    pub fn base_displacement(&self) -> f64 {
        let phase = self.simulation.time() % self.settings.period();
        self.settings.base().map_or(0.0, |base| base.state(phase).displacement)
    }

    /// Tells whether a base waits for room.
    #[must_use]
    pub const fn is_waiting(&self) -> bool {
        self.waiting.is_some()
    }

    /// Returns the disks.
    #[must_use]
    pub fn disks(&self) -> Vec<Disk> {
        self.simulation.disks()
    }

    /// Returns the mean flow of the recent past.
    #[must_use]
    pub const fn flow(&self) -> &Flow {
        &self.flow
    }

    /// Takes oscillation and order parameters of the samples since the last call, three numbers each.
    pub fn take_history(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.history)
    }

    /// Takes the places of marked collisions since the last call, two numbers each.
    pub fn take_marks(&mut self) -> Vec<f32> {
        std::mem::take(&mut self.marks)
    }

    /// Returns a hash of all bits of the time and the disks (FNV-1a).
    #[must_use]
    pub fn hash(&self) -> u64 {
        let of_disk = |disk: &Disk| {
            let (place, velocity) = (disk.position(), disk.velocity());
            [place.x, place.y, velocity.x, velocity.y, disk.angle(), disk.angular_velocity()]
        };
        let numbers = std::iter::once(self.simulation.time())
            .chain(self.disks().iter().flat_map(of_disk).collect::<Vec<_>>());
        numbers
            .flat_map(|number| number.to_bits().to_le_bytes())
            .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
    }
}
