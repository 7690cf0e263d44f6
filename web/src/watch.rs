//! What the page shows of a run besides the disks: flow, order parameters, state, marks.

use std::collections::VecDeque;

use granular_edmd::boundary::Container;
use granular_edmd::observable::{
    Accumulator, Collision, ConvectionOrder, DenseLayer, HeightProfile, Observable, OrderParameters, Partner,
    Temperatures,
};
use granular_edmd::{ParameterError, Simulation};
use granular_edmd_study::analysis::{StateCriteria, thermal_noise};

use crate::flow::Flow;
use crate::plan::Rule;
use crate::scene::Scene;

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

/// A sample of what is plotted, and of the order parameters with their noise in a gas at rest.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    pub(crate) oscillation: u64,
    pub(crate) plotted: [f64; 2],
    pub(crate) order: ConvectionOrder,
    pub(crate) noise: f64,
}

#[derive(Debug)]
pub(crate) struct Watch {
    scene: Scene,
    pub(crate) flow: Flow,
    pub(crate) marks: Vec<Mark>,
    /// Samples that the page has not fetched.
    pub(crate) fresh: Vec<Sample>,
    recent: VecDeque<Sample>,
    profile: HeightProfile,
    empty_profile: HeightProfile,
    layer: Option<DenseLayer>,
}

impl Watch {
    pub(crate) fn new(scene: Scene) -> Result<Self, ParameterError> {
        let (_, height) = scene.size();
        let empty_profile = HeightProfile::new(0.0, height, height as usize)?;
        let profile = empty_profile.clone();
        let (marks, fresh, recent) = (Vec::new(), Vec::new(), VecDeque::new());
        Ok(Self { scene, flow: Flow::new(scene), marks, fresh, recent, profile, empty_profile, layer: None })
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
        if !oscillation.is_multiple_of(self.scene.sampled_every()) {
            return;
        }
        let (plotted, order, temperatures) = (self.scene, OrderParameters, Temperatures).measure(&snapshot);
        let noise = thermal_noise(temperatures.vertical, 1.0, self.scene.count()).unwrap_or(0.0);
        let sample = Sample { oscillation, plotted, order, noise };
        if self.fresh.len() >= MOST_FRESH {
            self.fresh.drain(..MOST_FRESH / 2);
        }
        self.fresh.push(sample);
        self.recent.push_back(sample);
        if self.recent.len() > NAMED {
            self.recent.pop_front();
        }
        // A profile of the scene's own box does not fail.
        if self.profile.add(&snapshot).is_ok() && self.profile.samples() >= FEWEST as u64 {
            self.layer = self.profile.densest_layer();
            self.profile = self.empty_profile.clone();
        }
    }

    /// Forgets what named the state, after a change.
    pub(crate) fn forget(&mut self) {
        self.recent.clear();
        self.profile = self.empty_profile.clone();
        self.layer = None;
    }

    /// Returns the name of the state by the last samples; none while there are few, or with a large disk.
    pub(crate) fn state(&self) -> Option<String> {
        if self.recent.len() < FEWEST || self.scene != Scene::Rolls {
            return None;
        }
        let orders: Vec<ConvectionOrder> = self.recent.iter().map(|sample| sample.order).collect();
        let noise = self.recent.iter().map(|sample| sample.noise).sum::<f64>() / orders.len() as f64;
        let found = StateCriteria::default().classify(&orders, noise, self.layer).ok()?;
        Some(found.state().to_string())
    }
}
