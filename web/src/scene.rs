//! The scenes: the paper's box, and a large disk among small ones, of which all else is the same.

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::glam::DVec2;
use granular_edmd::initial::{self, Radii};
use granular_edmd::observable::{CenterOfMass, Observable, OfKind, OrderParameters, Snapshot};
use granular_edmd::wall::Combined;
use granular_edmd::{Disk, Kind};

use crate::plan::Setting;

/// An error of any part of the library, for people.
pub type Failure = Box<dyn std::error::Error>;

const RADIUS: f64 = 0.5;

/// The smallest radius of a grain around the large disk.
const SMALLEST: f64 = 0.42;

/// The kind of the large disk.
const LARGE: Kind = Kind::new(1);

/// Its smallest and largest diameter.
const DIAMETERS: (f64, f64) = (1.5, 10.0);

/// What is in the box.
///
/// As text `rolls`, or diameter and density of the large disk: `4,1`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scene {
    /// The paper's box: 1000 equal disks.
    Rolls,
    /// 600 disks, and a large one, on the floor or, if it is denser, on top.
    Nut {
        /// Diameter of the large disk.
        diameter: f64,
        /// Density of the large disk; that of the others is 1.
        density: f64,
    },
}

impl Scene {
    /// Returns the scene with a large disk; without one if its diameter is 0.
    ///
    /// # Errors
    /// If the large disk has no room, or no positive density.
    pub fn with_large_disk(diameter: f64, density: f64) -> Result<Self, Failure> {
        let (least, most) = DIAMETERS;
        if diameter == 0.0 {
            Ok(Self::Rolls)
        } else if !(least..=most).contains(&diameter) {
            Err(format!("the diameter of the large disk is {diameter}, not from {least} to {most}").into())
        } else if !(0.05..=50.0).contains(&density) {
            Err(format!("the density of the large disk is {density}, not from 0.05 to 50").into())
        } else {
            Ok(Self::Nut { diameter, density })
        }
    }

    /// Returns width and height of the box.
    pub(crate) const fn size(self) -> (f64, f64) {
        if let Self::Rolls = self { (60.0, 150.0) } else { (30.0, 50.0) }
    }

    /// Returns the number of disks.
    pub(crate) const fn count(self) -> usize {
        if let Self::Rolls = self { 1000 } else { 601 }
    }

    /// Returns the oscillations from sample to sample of what is plotted.
    pub(crate) const fn sampled_every(self) -> u64 {
        if let Self::Rolls = self { 10 } else { 2 }
    }

    /// Returns the contact duration as a share of the time in which a disk with the speed of the base moves
    /// by its diameter. Grains under a strong gravity lie on each other for moments, and need a longer one.
    pub(crate) const fn contact_duration(self) -> f64 {
        if let Self::Rolls = self { 1e-4 } else { 2e-3 }
    }

    /// Returns the box with its base, which begins an oscillation at this time.
    pub(crate) fn container(self, setting: &Setting, time: f64) -> Result<Container, Failure> {
        let (width, height) = self.size();
        let base = Combined::new(setting.base()?).starting_at(time)?;
        Ok(Container::closed(width, height)?.with_motion(Wall::Floor, base)?)
    }

    /// Returns the disks at the start.
    pub(crate) fn disks(
        self,
        container: &Container,
        setting: &Setting,
        seed: u64,
    ) -> Result<Vec<Disk>, Failure> {
        let disks = match self {
            Self::Rolls => initial::lattice(container, self.count(), RADIUS)?,
            Self::Nut { diameter, density } => {
                let (width, height) = self.size();
                let radius = 0.5 * diameter;
                let level = if density > 1.0 { height - 1.0 - radius } else { 1.0 + radius };
                let large = Disk::new(DVec2::new(0.5 * width, level), radius)?;
                let large = large.with_mass(density * diameter * diameter)?.with_kind(LARGE);
                let around = container.clone().with_pegs([large])?;
                // Equal grains would come to lie in a lattice, in which nothing moves.
                let sites = initial::lattice(&around, self.count() - 1, RADIUS)?;
                let radii = Radii::uniform(SMALLEST, RADIUS)?.draw(sites.len(), seed);
                let grains = sites.iter().zip(radii).map(|(site, radius)| Disk::new(site.position(), radius));
                grains.chain([Ok(large)]).collect::<Result<_, _>>()?
            }
        };
        Ok(initial::with_maxwellian_velocities(disks, setting.temperature(), seed)?)
    }
}

/// What is plotted over time: both order parameters, or the heights of the large disk and of the others.
impl Observable for Scene {
    type Value = [f64; 2];

    fn measure(&self, snapshot: &Snapshot<'_>) -> [f64; 2] {
        if let Self::Rolls = self {
            let order = OrderParameters.measure(snapshot);
            return [order.one_roll, order.two_rolls];
        }
        [LARGE, Kind::DEFAULT].map(|kind| OfKind::new(kind, CenterOfMass).measure(snapshot).y)
    }
}

impl std::str::FromStr for Scene {
    type Err = Failure;

    fn from_str(text: &str) -> Result<Self, Failure> {
        if text == "rolls" {
            return Ok(Self::Rolls);
        }
        let (diameter, density) = text.split_once(',').ok_or("a scene is `rolls`, or DIAMETER,DENSITY")?;
        Self::with_large_disk(diameter.parse()?, density.parse()?)
    }
}
