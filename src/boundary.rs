//! Boundaries: the walls around the disks, and the outcome of a touch.
//!
//! [`Container`] is the rectangular box of the paper, with variations. It has side walls or periodic sides, a
//! floor that is fixed, moving or thermal, and a lid or an open top. Each wall can have its own rule. Walls
//! can slide tangentially, and the box can be shaken as a whole.
//!
//! Named [`Part`]s in it can have any shape: each part consists of [`Brick`]s.
//!
//! | shape | how |
//! |---|---|
//! | hourglass, funnel, any polygon with the disks inside | [`Part::polygon`] |
//! | ramp, hopper side, any polygon with the disks outside | [`Part::block`] |
//! | gate, baffle, any thin wall | [`Part::polyline`] |
//! | drum; round obstacle | [`Part::drum`]; [`Part::peg`], [`Container::with_pegs`] |
//! | segments, arcs, circles and points in any mix | [`Part::new`] of [`Brick`]s |
//! | conveyor | [`Part::with_surface_speed`] |
//! | shear cell | [`Container::with_surface_speed`], [`Container::with_sliding`] |
//! | part that is shaken along any direction | [`Part::with_motion`] |
//! | part that turns: a drum, a stirrer | [`Part::with_rotation`], which combines with a motion |
//! | wall or part that the disks push | [`Container::with_piston`], [`Part::with_piston`] |
//! | box that is shaken as a whole | [`Container::shaken_sideways`], [`Container::shaken_vertically`] |
//!
//! Parts are added and removed by name, even between runs; this is how a gate opens. With the
//! feature `serde`, bricks, parts and containers can be written to files, and reading them repeats their
//! checks. A custom rule or a custom motion cannot be written.
//!
//! A custom geometry implements [`Boundary`]; [`roots`](crate::roots) provides the numerical methods that it
//! needs, and [`laws`] checks it.

mod area;
mod brick;
mod container;
mod domain;
pub mod laws;
mod part;
mod parts;
mod plane;
mod squares;
mod surface;
mod touch;
mod view;
mod wall;

pub use brick::Brick;
#[doc(alias("vessel", "silo", "hopper", "hourglass", "obstacles"))]
pub use container::Container;
pub(crate) use domain::direction;
pub use domain::{Domain, Region};
pub use part::Part;
pub(crate) use squares::Squares;
#[doc(alias("thermostat", "heat bath"))]
pub use surface::Thermal;
pub use surface::{Response, Surface};
pub use touch::Touch;
pub use touch::{Impact, Reaction};
pub use touch::{Overlap, Probe};
pub use view::WallView;
pub use wall::Wall;
pub use wall::WallError;

pub use crate::wall::FirstTouch;

use glam::DVec2;

use crate::forward::forward;
use crate::quantity::accept;
use crate::{Fingerprint, Flight, ParameterError};

/// The walls around the disks.
///
/// # Times
/// All times are *offsets* from the absolute time that was last given to
/// [`set_time_origin`](Self::set_time_origin), 0 at first. Absolute times grow without bound and would lose
/// digits. A boundary whose walls move reduces the origin by whole periods to a phase of their motion, as
/// [`WallMotion`](crate::wall::WallMotion) explains; other boundaries may ignore the origin.
///
/// # Calls of the methods
/// ```text
/// when                          who asks     asks                                for
/// ----------------------------  -----------  ----------------------------------  -------------------------
/// a run is built, or its walls  the engine   set_time_origin, domain, interior,  cells of neighbors; disks
/// are set                                    wall_count, overlap, tight_fit      that do not fit are
///                                                                                refused
/// cells are made                the engine   may_touch of each cell              cells away from walls
/// a disk's flight is predicted  the engine   first_touch (in cells at walls)     the end of the flight
/// the touch is due              the engine   overlap, surface                    the contact, for a rule;
///                                                                                or the wall emits or
///                                                                                absorbs the disk
/// after the rule's impulse      the engine   react; if Moved, may_meet of disks  walls with a mass; flights
///                                            at walls, and first_touch again     that now end otherwise
/// the epoch moves               the engine   set_time_origin, overlap            late times that keep their
///                                                                                digits; disks in walls
/// a checkpoint, a resumption    checkpoints  fingerprint, state; set_state       the same walls, where they
///                                                                                were
/// a sample, a picture           a Snapshot   wall, surface, area                 observables, files and
///                                                                                pictures
/// an initial state              initial      interior, overlap                   places for disks
/// an error                      the engine   wall                                its text
/// ```
///
/// # Contract
/// An implementation guarantees:
/// 1. [`domain`](Self::domain), [`interior`](Self::interior) and [`wall_count`](Self::wall_count) never
///    change. The domain has finite sides and a finite bottom; only its top may be infinite. As long as
///    no disk goes through a wall, all centers stay in the domain.
/// 2. [`may_touch`](Self::may_touch) holds for all times: it is false only for a region in which no disk of
///    this radius, or a smaller one, can touch a wall at any time. If it is true for a region, it is true for
///    every larger region that contains the region.
/// 3. [`first_touch`](Self::first_touch) misses no touch, and finds none where a gap is open. The time of the
///    touch is neither before the flight nor after `until`, and its wall is less than `wall_count`. A search
///    that cannot finish returns a time up to which the path is free, later than the start of the flight.
/// 4. If the disk already touches a wall, even if only by rounding, that touch is found immediately while the
///    disk approaches the wall, and never while the disk leaves it.
/// 5. [`surface`](Self::surface) gives the unit normal that points from the wall to the disk, the gradient of
///    the gap, to $`10^{-8}`$. The velocity is the velocity of the wall's material at the touch, whatever the
///    time origin. Its normal component is the speed at which the wall moves according to `overlap`, to
///    $`10^{-8}`$ of the speeds. Two disks that touch the same point of a wall find the same velocity there.
///    The radius is the surface's radius of curvature at the touch: infinite for a straight surface, negative
///    for a hollow one, never zero. At a tip or a corner, the radius may have any value except zero. The
///    angular velocity is the rate $`\Omega`$ at which these velocities turn the surface: the velocity along
///    the normal is larger by $`-\Omega d`$ at a point at a small distance $`d`$ along `normal.perp()`.
/// 6. [`overlap`](Self::overlap) is `None` for a disk inside. Otherwise, it gives the wall into which the
///    disk reaches deepest, and the depth, which is positive. If several walls are equally deep, it gives
///    any of them; where walls lie in each other, `first_touch` names the same one, or one with the same
///    surface. It agrees with `first_touch` for disks of each kind: at a touch, a disk that is larger by
///    $`10^{-9}`$ of the size of the domain overlaps the wall, and a disk that is smaller by the same amount
///    overlaps none, up to the distance that the surfaces close in 16 roundings of the absolute time. A
///    smaller disk that touches the wall at the same point overlaps as much: a wall that lets some disks pass
///    chooses them by their kind, not by their size. On a periodic side or end, the overlap is the same for
///    both images of the disk: a wall at one side acts on disks at the other.
/// 7. Another origin changes only the numerical values of times: the same flight touches the same wall at the
///    same absolute time.
/// 8. The same calls return the same results, bit for bit, until the origin is set or a wall reacts.
/// 9. [`react`](Self::react) applies the impulse to the wall that was hit. Its velocity changes along the
///    normal by the impulse along the normal divided by the [`mass`](Surface::mass), and along the surface
///    not at all: walls are guided. Only a surface without friction may also move along itself, as on a guide
///    at a slant. No wall jumps. The result is [`Reaction::Moved`] if the velocity changes, which needs a
///    finite mass.
/// 10. [`may_meet`](Self::may_meet) is true for each region in which a disk touches this wall, or another
///     wall that moves with it, at a time up to `until`.
/// 11. [`state`](Self::state) and [`set_state`](Self::set_state) restore walls that have reacted: all results
///     are as before, and `state` returns the state that was set. A state of another length is refused.
/// 12. [`area`](Self::area), if it is known, is the area of the positions at which a disk of the default kind
///     has no `overlap`, and the [`point`](WallView::point) of a wall stays on it.
/// 13. Boundaries with equal [fingerprints](Self::fingerprint) return the same results in the same state, and
///     a boundary keeps its fingerprint, whatever its present state and its origin.
///
/// The engine guarantees:
/// - It sets the origin before any other call except for `state`, and whenever the epoch of the run moves. If
///   the walls are set during a run and have a state, the first origin is the present time. The engine never
///   passes a time before the origin.
/// - All numbers of a flight are finite. A flight begins at the present, inside the domain. It ends (`until`)
///   when the disk leaves its cell or reaches a periodic side or end, at the latest two epochs from now. In
///   an epoch, a typical disk moves tens of diameters.
/// - It calls `first_touch` only in cells for which `may_touch` holds with the largest of all radii. Cells at
///   the edges of the domain reach to infinity.
/// - It calls `surface` for a touch that `first_touch` found, with the disk's position at that time.
///
/// # Boundaries that break the contract
/// [`laws::check`] tests promises 1 to 12, except for the points of walls; `docs/validation.md` says which
/// planted faults it finds. The engine notices many faults, too.
///
/// At each collision with a wall, a disk enlarged by 1e-9 of its radius must overlap a wall, by no more than
/// 1e-6 of its radius. Three things therefore end a run with an error: an early or late touch, a disk that
/// has left the domain by more than its radius (noticed within some collisions of each disk), and a disk that
/// overlaps a wall at the end of a search that found no touch. A missed touch with a thin wall that disks
/// meet from both sides goes unnoticed. A touch with a wall that the disk is leaving comes again immediately,
/// until the run fails for lack of progress. A velocity or a normal that is not finite is an error.
///
/// After each impulse on a wall with a mass, its velocity must be the one that the impulse gives, to 1e-6 of
/// the speeds, or the lower, opposite one of a wall that a stop holds, and it must still touch the disk. A
/// run does not notice what an impulse does to other walls, nor that a wall that keeps a
/// [`state`](Self::state) never leaves its rest, or stops or turns around without a stop.
///
/// ```
/// use granular_edmd::Flight;
/// use granular_edmd::boundary::{Boundary, Domain, FirstTouch, Overlap, Probe, Region};
/// use granular_edmd::boundary::{Surface, Touch, WallView, laws};
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::roots::first_descent_of_quartic;
///
/// /// A round dish about the origin.
/// struct Dish {
///     radius: f64,
/// }
///
/// impl Boundary for Dish {
///     fn domain(&self) -> Domain {
///         Domain::new(-self.radius, self.radius, -self.radius, self.radius)
///     }
///     fn wall_count(&self) -> usize {
///         1
///     }
///     fn wall(&self, _wall: usize, _time: f64) -> WallView<'_> {
///         WallView::new("rim")
///     }
///     fn set_time_origin(&mut self, _origin: f64) {}
///     fn may_touch(&self, region: &Region, radius: f64) -> bool {
///         region.min.abs().max(region.max.abs()).length() + radius >= self.radius
///     }
///     fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
///         let start = flight.time();
///         let (r, v, a) = (flight.position(start), flight.velocity(start), flight.acceleration());
///         let free = self.radius - flight.radius();
///         // The square of `free` less the squared distance from the middle, as a polynomial of the time.
///         let gap = [
///             (free - r.length()) * (free + r.length()),
///             -2.0 * r.dot(v),
///             -(v.length_squared() + r.dot(a)),
///             -v.dot(a),
///             -0.25 * a.length_squared(),
///         ];
///         let wait = first_descent_of_quartic(&gap, until - start);
///         wait.map(|wait| Touch::new((start + wait).min(until), 0)).into()
///     }
///     fn surface(&self, _wall: usize, position: DVec2, _time: f64) -> Surface<'_> {
///         Surface::new(-position.normalize_or(DVec2::Y), DVec2::ZERO).with_radius(-self.radius)
///     }
///     fn overlap(&self, probe: &Probe) -> Option<Overlap> {
///         let depth = probe.position().length() + probe.radius() - self.radius;
///         (depth > 0.0).then_some(Overlap::new(0, depth))
///     }
/// }
///
/// let mut dish = Dish { radius: 6.0 };
/// assert_eq!(laws::check(&mut dish, 0.5, 1.0, 42), Ok(()));
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a boundary",
    label = "not a boundary",
    note = "use a `granular_edmd::boundary::Container`, or implement `Boundary` for a custom geometry"
)]
pub trait Boundary {
    /// Returns the rectangle that holds the centers of all disks at all times.
    fn domain(&self) -> Domain;

    /// Returns the rectangle, inside the domain, in which initial states are placed.
    ///
    /// It excludes the region that moving walls reach.
    fn interior(&self) -> Domain {
        self.domain()
    }

    /// Returns the number of walls; their indices are less than this number.
    fn wall_count(&self) -> usize;

    /// Returns the view of a wall at `time`, for messages, measurements, files and pictures.
    ///
    /// Observers find walls by their [`name`](WallView::name). The default name is the index, and nothing
    /// else is known: a boundary of several walls gives names, such as "floor", and a boundary that knows its
    /// free [`area`](Self::area) the points of walls that move. The library asks for indices below
    /// [`wall_count`](Self::wall_count) only.
    fn wall(&self, wall: usize, time: f64) -> WallView<'_> {
        let _ = time;
        WallView::new(format!("wall {wall}"))
    }

    /// Sets the absolute time from which all times are measured.
    fn set_time_origin(&mut self, origin: f64);

    /// Returns whether a disk with its center in `region` can touch a wall at any time.
    ///
    /// The engine calls [`first_touch`](Self::first_touch) only in such regions. Regions at the edge of the
    /// domain reach to infinity beyond it.
    fn may_touch(&self, region: &Region, radius: f64) -> bool;

    /// Returns the first touch of this flight that is not later than `until`.
    ///
    /// If the disk already touches a wall, that touch is found immediately while the disk approaches the
    /// wall, and never while the disk leaves it.
    ///
    /// An `Option<Touch>` converts into the result with `into`. A search with many steps may return the time
    /// up to which it has found no touch ([`FirstTouch::NotBefore`]). The engine calls again at that time, so
    /// a run can check its limits between two parts of a long search.
    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch>;

    /// Returns the surface that a disk at `position` touches at `time`.
    ///
    /// The wall must exist; for any other index the call may panic.
    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_>;

    /// Returns the wall that a disk overlaps most deeply, and the depth, or `None` if the disk overlaps no
    /// wall.
    ///
    /// A wall that lets disks of the probe's kind pass does not count.
    fn overlap(&self, probe: &Probe) -> Option<Overlap>;

    /// Returns a wall with a hollow that a disk of this radius fills, up to rounding, or `None` if no wall
    /// has such a hollow.
    ///
    /// Rounding alone would decide whether such a disk gets into the hollow, and in which direction the wall
    /// then pushes it. The engine refuses such disks.
    fn tight_fit(&self, radius: f64) -> Option<usize> {
        let _ = radius;
        None
    }

    /// Returns the area of the part of `region` in which the center of a disk of this radius and of the
    /// default kind is free at `time`, or `None` if the boundary does not know the area.
    ///
    /// With a radius of 0, the result is the area that matter can fill. Stresses, densities and profiles
    /// divide by this area. Where walls occupy part of the domain, these observables refuse to measure if the
    /// area is unknown. They may reuse the area as long as the [points](WallView::point) of all walls stay
    /// where they are. The default is `None`; so is a free area that depends on the kind of the matter.
    ///
    /// Containers know the area to 1e-10, even if parts overlap, unless a part with an inside is
    /// [for some kinds only](Part::only_for). The exceptions are parts whose lines end inside the container
    /// with disks on one side only. There, pieces thinner than 1/16 of the distance between the surrounding
    /// walls may be missed.
    fn area(&self, region: &Region, radius: f64, time: f64) -> Option<f64> {
        let _ = (region, radius, time);
        None
    }

    /// Receives the impact of a disk on a wall, and returns whether the wall's motion changes.
    ///
    /// The engine calls this method after each collision with a wall. A wall that reacts has a finite
    /// [mass](Surface::with_mass), and its motion between two impacts is known. If the result is
    /// [`Reaction::Moved`], the engine predicts anew all flights that [`may_meet`](Self::may_meet) names. The
    /// default reacts to nothing, and costs nothing.
    #[inline]
    fn react(&mut self, impact: &Impact) -> Reaction {
        let _ = impact;
        Reaction::None
    }

    /// Returns whether a disk with its center in `region` may touch this wall, or another wall that moves
    /// with it as a part of one body, at any time up to `until`.
    ///
    /// The engine calls this method after a wall has [reacted](Self::react), in order to find the disks whose
    /// flights may now end differently. A narrow result saves predictions; the default is the result of
    /// [`may_touch`](Self::may_touch).
    fn may_meet(&self, wall: usize, region: &Region, radius: f64, until: f64) -> bool {
        let _ = (wall, until);
        self.may_touch(region, radius)
    }

    /// Returns the state of the walls that [react](Self::react) at the time origin, as numbers: positions,
    /// velocities, and everything else that impacts have changed.
    ///
    /// A checkpoint keeps these numbers, since the boundary that the caller gives to a resumed run begins
    /// anew. All later results must be the same bits. A motion that is carried on to the origin would be
    /// rounded: return the time of the last impact instead, and the position and velocity at that time. The
    /// default is empty.
    fn state(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Restores a state that [`state`](Self::state) returned. It describes the walls at the present origin.
    ///
    /// # Errors
    /// If the numbers are not a state of this boundary.
    fn set_state(&mut self, state: &[f64]) -> Result<(), ParameterError> {
        accept(state.is_empty(), "state of the walls", "empty, since no wall reacts", state.len() as f64)
            .map(drop)
    }

    /// Returns the fingerprint of the boundary: its name and everything on which its results depend, but not
    /// its [state](Self::state).
    ///
    /// Checkpoints compare fingerprints when a run is resumed. A boundary without a fingerprint is not
    /// compared.
    fn fingerprint(&self) -> Option<Fingerprint> {
        None
    }
}

forward! { Boundary for [&mut T, Box<T>] {
    fn domain(&self) -> Domain;
    fn interior(&self) -> Domain;
    fn wall_count(&self) -> usize;
    fn wall(&self, wall: usize, time: f64) -> WallView<'_>;
    fn may_touch(&self, region: &Region, radius: f64) -> bool;
    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch>;
    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_>;
    fn overlap(&self, probe: &Probe) -> Option<Overlap>;
    fn tight_fit(&self, radius: f64) -> Option<usize>;
    fn area(&self, region: &Region, radius: f64, time: f64) -> Option<f64>;
    fn may_meet(&self, wall: usize, region: &Region, radius: f64, until: f64) -> bool;
    fn state(&self) -> Vec<f64>;
    fn fingerprint(&self) -> Option<Fingerprint>;
    mut
    fn react(&mut self, impact: &Impact) -> Reaction;
    fn set_state(&mut self, state: &[f64]) -> Result<(), ParameterError>;
    fn set_time_origin(&mut self, origin: f64);
}}
