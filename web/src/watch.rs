//! What the page shows of a run besides the disks: flow, order parameters, state, marks.

use std::collections::VecDeque;

use granular_edmd::analysis::{StateCriteria, thermal_noise};
use granular_edmd::boundary::Container;
use granular_edmd::observable::{
    Accumulator, Collision, ConvectionOrder, DenseLayer, HeightProfile, Observable, OrderParameters, Partner,
    Temperatures,
};
use granular_edmd::{ParameterError, Simulation};

use crate::flow::Flow;
use crate::plan::Rule;
use crate::run::{DISKS, HEIGHT};

/// Oscillations from sample to sample.
const EVERY: u64 = 10;

/// Samples of which the state is named.
const NAMED: usize = 60;

/// Fewest samples that name a state, and samples of one height profile.
const FEWEST: usize = 15;

/// Most samples that wait for the page, which fetches none while it is not seen.
const MOST_FRESH: usize = 1000;

/// Most collisions that are kept to be marked.
const MOST_MARKS: usize = 200;

/// A collision to be marked: where, how hard, and of which disks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mark(pub(crate) [f32; 5]);

impl Mark {
    /// Returns the mark of a collision; the partner is -1 for a wall.
    pub(crate) fn of(collision: &Collision) -> Self {
        let place = collision.position - 0.5 * collision.normal;
        let partner = if let Partner::Disk(disk) = collision.partner { disk as f32 } else { -1.0 };
        let strength = collision.impulse.normal() as f32;
        Self([place.x as f32, place.y as f32, strength, collision.disk as f32, partner])
    }
}

/// A sample of the order parameters.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    pub(crate) oscillation: u64,
    pub(crate) order: ConvectionOrder,
    pub(crate) noise: f64,
}

#[derive(Debug)]
pub(crate) struct Watch {
    pub(crate) flow: Flow,
    pub(crate) marks: Vec<Mark>,
    /// Samples that the page has not fetched.
    pub(crate) fresh: Vec<Sample>,
    recent: VecDeque<Sample>,
    profile: HeightProfile,
    layer: Option<DenseLayer>,
}

impl Watch {
    pub(crate) fn new() -> Result<Self, ParameterError> {
        let profile = HeightProfile::new(0.0, HEIGHT, HEIGHT as usize)?;
        let (marks, fresh, recent) = (Vec::new(), Vec::new(), VecDeque::new());
        Ok(Self { flow: Flow::new(), marks, fresh, recent, profile, layer: None })
    }

    pub(crate) fn mark(&mut self, collision: &Collision) {
        if self.marks.len() < MOST_MARKS {
            self.marks.push(Mark::of(collision));
        }
    }

    /// Looks at the state at the end of an oscillation.
    pub(crate) fn look(&mut self, oscillation: u64, simulation: &mut Simulation<Rule, Container>) {
        let snapshot = simulation.snapshot();
        self.flow.add(&snapshot);
        if !oscillation.is_multiple_of(EVERY) {
            return;
        }
        let order = OrderParameters.measure(&snapshot);
        let noise = thermal_noise(Temperatures.measure(&snapshot).vertical, 1.0, DISKS).unwrap_or(0.0);
        let sample = Sample { oscillation, order, noise };
        if self.fresh.len() >= MOST_FRESH {
            self.fresh.drain(..MOST_FRESH / 2);
        }
        self.fresh.push(sample);
        self.recent.push_back(sample);
        if self.recent.len() > NAMED {
            self.recent.pop_front();
        }
        self.profile.add(&snapshot);
        if self.profile.samples() >= FEWEST as u64 {
            self.layer = self.profile.densest_layer();
            self.profile.clear();
        }
    }

    /// Forgets what named the state, after a change.
    pub(crate) fn forget(&mut self) {
        self.recent.clear();
        self.profile.clear();
        self.layer = None;
    }

    /// Returns the name of the state by the last samples; none while there are few.
    pub(crate) fn state(&self) -> Option<String> {
        if self.recent.len() < FEWEST {
            return None;
        }
        let orders: Vec<ConvectionOrder> = self.recent.iter().map(|sample| sample.order).collect();
        let noise = self.recent.iter().map(|sample| sample.noise).sum::<f64>() / orders.len() as f64;
        let found = StateCriteria::default().classify(&orders, noise, self.layer).ok()?;
        Some(found.state().to_string())
    }
}
