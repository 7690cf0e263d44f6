//! The run: a box of disks, advanced by oscillations, with settings that change at whole ones.

use std::f64::consts::TAU;

use granular_edmd::boundary::Container;
use granular_edmd::observable::{CenterOfMass, on_collision};
use granular_edmd::simulation::{Limits, RunEnd};
use granular_edmd::wall::WallMotion;
use granular_edmd::{Disk, Simulation};

use crate::plan::{Plan, Rule, Setting};
use crate::scene::{Failure, Scene};
use crate::watch::{Mark, Watch};

/// How far a run should go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Advance {
    /// Oscillations since the start, whole or not.
    pub to: f64,
    /// Collisions after which the run pauses before that.
    pub most_collisions: u64,
    /// Keep the collisions, to be marked.
    pub marks: bool,
}

/// A box with settings that change while it runs.
///
/// Settings change at whole oscillations, when the base passes its middle upward, so that it never jumps.
/// The state is then a function of the seed and of the plan alone, not of frames and clicks.
///
/// ```
/// use rolls::{Plan, Run, Scene};
/// let plan: Plan = "0:0.03,0,0.015625,0.1,10;3:0.08,0,0.015625,0.1,12".parse()?;
/// assert_eq!(Run::planned(7, Scene::Rolls, &plan, 6)?, Run::planned(7, Scene::Rolls, &plan, 6)?);
/// assert_ne!(Run::planned(7, Scene::Rolls, &plan, 6)?, Run::planned(8, Scene::Rolls, &plan, 6)?);
/// # Ok::<(), rolls::Failure>(())
/// ```
#[derive(Debug)]
pub struct Run {
    scene: Scene,
    simulation: Simulation<Rule, Container>,
    setting: Setting,
    pending: Option<Setting>,
    /// Time and number of the oscillation at which the present frequency began.
    began: (f64, u64),
    /// Number of whole oscillations so far.
    whole: u64,
    /// True from the end of an oscillation to the first step of the next.
    is_whole: bool,
    watch: Watch,
}

impl Run {
    /// Builds the box with disks on a lattice and velocities drawn with this seed.
    ///
    /// # Errors
    /// If a setting is out of its range.
    pub fn new(seed: u64, scene: Scene, setting: Setting) -> Result<Self, Failure> {
        let container = scene.container(&setting, 0.0)?;
        let disks = scene.disks(&container, &setting, seed)?;
        let builder = Simulation::builder(setting.rule(scene.contact_duration())?, container).disks(disks);
        let mut simulation = builder.gravity(setting.gravity).seed(seed).build()?;
        let mut watch = Watch::new(scene)?;
        watch.look(0, &mut simulation);
        Ok(Self {
            scene,
            simulation,
            setting,
            pending: None,
            began: (0.0, 0),
            whole: 0,
            is_whole: true,
            watch,
        })
    }

    /// Runs a plan for so many oscillations, and returns the hash of the state.
    ///
    /// # Errors
    /// As [`Self::new`] and [`Self::advance`].
    pub fn planned(seed: u64, scene: Scene, plan: &Plan, oscillations: u64) -> Result<String, Failure> {
        let mut run = Self::new(seed, scene, *plan.first())?;
        for &(when, setting) in plan.later().iter().take_while(|step| step.0 <= oscillations) {
            run.advance_to(when)?;
            run.ask(setting)?;
        }
        run.advance_to(oscillations)?;
        Ok(run.hash())
    }

    fn advance_to(&mut self, oscillation: u64) -> Result<bool, Failure> {
        self.advance(Advance { to: oscillation as f64, most_collisions: u64::MAX, marks: false })
    }

    /// Asks for another setting, from the next whole oscillation on, and returns its number.
    ///
    /// # Errors
    /// If the setting is out of its range. It is then not taken.
    pub fn ask(&mut self, setting: Setting) -> Result<u64, Failure> {
        setting.rule(self.scene.contact_duration())?;
        self.scene.container(&setting, self.simulation.time())?;
        self.pending = Some(setting);
        if self.is_whole {
            self.change()?;
            return Ok(self.whole);
        }
        Ok(self.whole + 1)
    }

    /// Advances, and tells whether the run has come as far as it should.
    ///
    /// # Errors
    /// If the run cannot progress.
    pub fn advance(&mut self, advance: Advance) -> Result<bool, Failure> {
        let mut left = advance.most_collisions;
        while self.oscillations() < advance.to {
            let next = advance.to.min((self.whole + 1) as f64);
            let before = self.collisions();
            let end = self.time_of(next);
            if end > self.simulation.time() {
                let limits = Limits::until(end).with_most_collisions(left);
                self.is_whole = false;
                if self.run(&limits, advance.marks)? == RunEnd::Collisions {
                    return Ok(false);
                }
            }
            left = left.saturating_sub(self.collisions() - before);
            if next < (self.whole + 1) as f64 {
                break;
            }
            self.end_oscillation()?;
        }
        Ok(true)
    }

    /// Goes to the next collision and marks it.
    ///
    /// # Errors
    /// If the run cannot progress.
    pub fn step(&mut self) -> Result<(), Failure> {
        self.watch.marks.clear();
        while self.watch.marks.is_empty() {
            let end = self.time_of((self.whole + 1) as f64);
            self.is_whole = false;
            let marks = &mut self.watch.marks;
            let mut marking = on_collision(|collision| marks.push(Mark::of(collision)));
            if self.simulation.step_until(end, &mut marking)?.is_none() {
                self.end_oscillation()?;
            }
        }
        Ok(())
    }

    fn run(&mut self, limits: &Limits<'_>, marks: bool) -> Result<RunEnd, Failure> {
        let Self { simulation, watch, .. } = self;
        let mut marking = marks.then_some(on_collision(|collision| watch.mark(collision)));
        Ok(simulation.run(limits, &mut marking)?)
    }

    fn end_oscillation(&mut self) -> Result<(), Failure> {
        self.whole += 1;
        self.is_whole = true;
        self.watch.look(self.whole, &mut self.simulation);
        self.change()
    }

    /// Takes the setting that was asked for. If the base has no room, the next oscillation tries again.
    fn change(&mut self) -> Result<(), Failure> {
        let Some(setting) = self.pending else { return Ok(()) };
        let time = self.time_of(self.whole as f64);
        let Setting { amplitude, angular_frequency, .. } = self.setting;
        if (setting.amplitude, setting.angular_frequency) != (amplitude, angular_frequency) {
            if self.simulation.set_boundary(self.scene.container(&setting, time)?).is_err() {
                return Ok(());
            }
            self.began = (time, self.whole);
        }
        if setting.gravity != self.setting.gravity {
            self.simulation.set_gravity(setting.gravity)?;
        }
        self.simulation.set_rule(setting.rule(self.scene.contact_duration())?);
        (self.setting, self.pending) = (setting, None);
        self.watch.forget();
        Ok(())
    }

    fn time_of(&self, oscillation: f64) -> f64 {
        let (time, number) = self.began;
        time + (oscillation - number as f64) * (TAU / self.setting.angular_frequency)
    }

    /// Returns the oscillations since the start.
    pub fn oscillations(&self) -> f64 {
        let since = self.simulation.time() - self.time_of(self.whole as f64);
        let share = since * self.setting.angular_frequency / TAU;
        // Rounding must not show an end that is not reached, or a step back.
        self.whole as f64 + if self.is_whole { 0.0 } else { share.clamp(0.0, 1.0 - f64::EPSILON) }
    }

    /// Returns the number of whole oscillations since the start.
    pub const fn whole(&self) -> u64 {
        self.whole
    }

    /// Returns the number of all collisions.
    pub fn collisions(&self) -> u64 {
        self.simulation.counters().disk_collisions + self.simulation.counters().wall_collisions
    }

    /// Returns a name for the state, which depends on its last bit: that of `vibrated_box` of the gallery.
    pub fn hash(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        for disk in self.simulation.disks() {
            for number in numbers(&disk) {
                hasher.update(&number.to_le_bytes());
            }
        }
        hasher.update(&self.simulation.time().to_le_bytes());
        hasher.finalize().to_hex()[..32].to_owned()
    }

    pub(crate) const fn simulation(&self) -> &Simulation<Rule, Container> {
        &self.simulation
    }

    pub(crate) const fn watch(&mut self) -> &mut Watch {
        &mut self.watch
    }

    /// Returns what is plotted, and the height of the center of mass, now.
    pub(crate) fn plotted(&self) -> ([f64; 2], f64) {
        let (plotted, center) = self.simulation.measure(&(self.scene, CenterOfMass));
        (plotted, center.y)
    }

    /// Returns the height of the base now.
    pub(crate) fn base(&self) -> f64 {
        let share = self.oscillations().fract();
        self.setting
            .base()
            .map_or(0.0, |base| base.state(share * TAU / base.angular_frequency()).displacement)
    }
}

fn numbers(disk: &Disk) -> [f64; 6] {
    let (position, velocity) = (disk.position(), disk.velocity());
    [position.x, position.y, velocity.x, velocity.y, disk.angle(), disk.angular_velocity()]
}
