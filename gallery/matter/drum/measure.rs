//! Measures of a drum: its surface, and the flow by depth.

use granular_edmd::Disk;
use granular_edmd::glam::DVec2;

/// Largest distance from the middle at which the surface is fitted, as a fraction of the radius.
const FITTED: f64 = 0.6;

/// Width of the columns in which the highest grain counts, and of the layers of the flow.
const COLUMN: f64 = 1.0;

/// A straight line through the surface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slope {
    /// Angle above the horizontal, in radians.
    pub(crate) angle: f64,
    /// Height above the axis, in the middle.
    pub(crate) middle: f64,
}

impl Slope {
    /// Fits a line to the highest grains of all columns. Grains in flight do not count: they have fewer than
    /// two others nearby.
    pub(crate) fn of(disks: &[Disk], radius: f64) -> Option<Self> {
        let columns = (2.0 * FITTED * radius / COLUMN) as usize;
        let mut tops = vec![None::<DVec2>; columns];
        for disk in disks.iter().filter(|disk| lies(disk, disks)) {
            let (x, top) = (disk.position().x, disk.position().y + disk.radius());
            let column = ((x + FITTED * radius) / COLUMN).floor();
            if let Some(highest) = (column >= 0.0).then(|| tops.get_mut(column as usize)).flatten()
                && highest.is_none_or(|highest| top > highest.y)
            {
                *highest = Some(DVec2::new(x, top));
            }
        }
        let tops: Vec<DVec2> = tops.into_iter().flatten().collect();
        let mean = tops.iter().sum::<DVec2>() / tops.len() as f64;
        let covariance: f64 = tops.iter().map(|top| (top.x - mean.x) * (top.y - mean.y)).sum();
        let variance: f64 = tops.iter().map(|top| (top.x - mean.x).powi(2)).sum();
        let slope = covariance / variance;
        slope.is_finite().then(|| Self { angle: slope.atan(), middle: mean.y - slope * mean.x })
    }
}

/// Returns whether two other grains are near.
fn lies(disk: &Disk, disks: &[Disk]) -> bool {
    let near = |other: &&Disk| {
        let reach = 1.2 * (disk.radius() + other.radius());
        other.position().distance_squared(disk.position()) < reach * reach
    };
    // The disk itself counts as near, too.
    disks.iter().filter(near).take(3).count() == 3
}

/// The mean velocity along the surface by depth in the middle of the drum, and how well the rim grips.
#[derive(Debug, Clone)]
pub(crate) struct Depths {
    radius: f64,
    /// Number of grains in each layer, and the sum of their velocities.
    layers: Vec<(u64, f64)>,
    /// The same for the angular velocities of grains at the rim.
    at_rim: (u64, f64),
}

impl Depths {
    pub(crate) fn new(radius: f64) -> Self {
        Self { radius, layers: vec![(0, 0.0); (1.5 * radius / COLUMN) as usize], at_rim: (0, 0.0) }
    }

    /// Counts grains under a surface at this angle.
    pub(crate) fn add(&mut self, disks: &[Disk], angle: f64) {
        /// Largest distances from the middle, and from the rim, at which grains count.
        const MIDDLE: f64 = 2.5;
        const RIM: f64 = 1.3;
        let (along, up) = (DVec2::from_angle(angle), DVec2::from_angle(angle).perp());
        for disk in disks {
            let (place, velocity) = (disk.position(), disk.velocity());
            let (depth, offset) = (place.dot(up), place.dot(along));
            let layer = (depth + self.radius) / COLUMN;
            if offset.abs() < MIDDLE
                && let Some((count, sum)) = self.layers.get_mut(layer.max(0.0) as usize)
            {
                *count += 1;
                *sum += velocity.dot(along);
            }
            if place.length() > self.radius - RIM && depth < -0.5 * self.radius {
                self.at_rim.0 += 1;
                self.at_rim.1 += place.perp_dot(velocity) / place.length_squared();
            }
        }
    }

    /// Returns the heights above the axis, and the mean velocities up the surface, of all layers with enough
    /// grains.
    pub(crate) fn profile(&self) -> Vec<(f64, f64)> {
        let most = self.layers.iter().map(|(count, _)| *count).max().unwrap_or(0);
        let layers = self.layers.iter().enumerate().filter(|(_, (count, _))| 20 * count > most);
        let height = |layer: usize| (layer as f64 + 0.5) * COLUMN - self.radius;
        layers.map(|(layer, (count, sum))| (height(layer), sum / *count as f64)).collect()
    }

    /// Returns the angular velocity of the grains at the rim about the axis, relative to the drum's.
    pub(crate) fn grip(&self, rate: f64) -> f64 {
        self.at_rim.1 / (self.at_rim.0 as f64 * rate)
    }
}
