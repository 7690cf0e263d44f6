//! Overlaps among disks.

use glam::DVec2;

use crate::Disk;
use crate::boundary::Domain;
use crate::disk::TOUCHING;

/// A disk, or the image of one in a periodic box.
struct Image {
    disk: usize,
    position: DVec2,
    radius: f64,
    is_itself: bool,
}

/// Returns two disks that overlap by more than rounding, and the depth of their overlap, if there are such
/// disks.
///
/// A sweep along the longer side of the area that the disks fill compares each disk only with those beside
/// it.
pub(super) fn first(disks: &[Disk], domain: Option<&Domain>) -> Option<(usize, usize, f64)> {
    let images = images(disks, domain);
    let along = longer_side(disks);
    let near_end = |image: &Image| image.position.dot(along) - image.radius;
    let mut order: Vec<&Image> = images.iter().collect();
    order.sort_by(|a, b| near_end(a).total_cmp(&near_end(b)));
    for (place, image) in order.iter().enumerate() {
        let end = image.position.dot(along) + image.radius;
        let beside = order[place + 1..].iter().take_while(|other| near_end(other) < end);
        for other in beside.filter(|other| (image.is_itself || other.is_itself) && image.disk != other.disk) {
            let contact = image.radius + other.radius;
            let depth = contact - image.position.distance(other.position);
            if depth > TOUCHING * contact {
                return Some((image.disk, other.disk, depth));
            }
        }
    }
    None
}

/// Returns the disks, and the images that reach into a periodic box.
fn images(disks: &[Disk], domain: Option<&Domain>) -> Vec<Image> {
    let shifts: Vec<DVec2> = domain.map_or_else(|| vec![DVec2::ZERO], |domain| domain.images().collect());
    let reach = disks.iter().map(Disk::radius).fold(0.0, f64::max);
    let mut images = Vec::with_capacity(disks.len());
    for (disk, body) in disks.iter().enumerate() {
        for &shift in &shifts {
            let (position, radius, is_itself) =
                (body.position() + shift, body.radius(), shift == DVec2::ZERO);
            let reach = radius + reach;
            let is_near = |domain: &Domain| {
                (domain.left - reach..=domain.right + reach).contains(&position.x)
                    && (domain.bottom - reach..=domain.top + reach).contains(&position.y)
            };
            if is_itself || domain.is_some_and(is_near) {
                images.push(Image { disk, position, radius, is_itself });
            }
        }
    }
    images
}

/// Returns the direction in which the disks extend further.
fn longer_side(disks: &[Disk]) -> DVec2 {
    let places = || disks.iter().map(Disk::position);
    let low = places().fold(DVec2::INFINITY, DVec2::min);
    let size = places().fold(DVec2::NEG_INFINITY, DVec2::max) - low;
    if size.x > size.y { DVec2::X } else { DVec2::Y }
}
