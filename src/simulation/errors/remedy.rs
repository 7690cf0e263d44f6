//! The remedies for runs that stall.

use std::fmt;

/// The remedy for a run that stalled, which depends on what the rule does in collisions as slow as the last
/// ones.
///
/// The page `docs/rest.md` of the repository compares the remedies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Remedy {
    /// Slow collisions lose energy, so disks that come to rest collide ever more often. The remedy is to make
    /// slow collisions, or collisions in quick succession, elastic, or to set a least speed at which surfaces
    /// part.
    ElasticWhenSlow,
    /// The contact-duration model is at work, with a duration so short that disks at rest collide too often.
    LongerContactDuration,
    /// Slow collisions already lose no energy, yet the run stalls: a disk is at rest or squeezed, so that its
    /// collisions are too slow, or walls keep driving it.
    FasterDisks,
    /// The rule leaves disks approaching each other.
    PushApart,
    /// The surface of the wall has another velocity than the wall's geometry, so that disks are hit again
    /// immediately.
    WallVelocity,
    /// The wall has a mass and rests on a stop, which absorbs what the disk gives the wall, so the disk loses
    /// energy under any rule ([`Piston`](crate::wall::Piston)).
    WallOnStop,
    /// The rule gains energy, so disks become ever faster.
    EnergyGain,
    /// The run advances, but more slowly than
    /// [`Limits::with_least_progress`](crate::simulation::Limits::with_least_progress) asks.
    LessProgress,
    /// No collision is predicted: the boundary or the scheduler names events that do not advance the run.
    OtherParts,
}

impl fmt::Display for Remedy {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::ElasticWhenSlow => {
                "matter that comes to rest, an inelastic collapse, or disks that walls squeeze; remedies are a contact \
                 duration (the rule ContactDuration), the rules LeastRebound and ElasticBelow, or more room"
            }
            Self::LongerContactDuration => {
                "matter at rest under a short contact duration; a longer one helps, or the rule LeastRebound"
            }
            Self::FasterDisks => {
                "a disk at rest or squeezed, whose collisions lose nothing but are too slow; a faster start, more room, or \
                 the rule LeastRebound with a higher speed helps; a disk that walls drive needs a rule that loses \
                 energy; for custom walls see boundary::laws::check"
            }
            Self::PushApart => "the rule does not push the disks apart; see collision::laws::check",
            Self::WallVelocity => {
                "the wall does not move at the velocity of its surface; boundary::laws::check compares the two"
            }
            Self::WallOnStop => {
                "the wall rests on a stop, which absorbs the impulse of each disk: a disk of mass m leaves a wall of mass M \
                 with (M - m)/(M + m) of its speed, even under Elastic; a wall without a mass, a heavier one, or one \
                 that its force does not press against the stop helps"
            }
            Self::EnergyGain => "the rule gains energy, so disks become ever faster; see collision::laws::check",
            Self::LessProgress => "time advances, but the least progress that was asked for is larger",
            Self::OtherParts => "no collision is in sight; does the boundary or the scheduler advance?",
        })
    }
}
