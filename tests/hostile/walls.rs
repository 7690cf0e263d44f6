//! Every container: each wall with any motion, rule or temperature.

use granular_edmd::boundary::{Container, Thermal, Wall, WallError};
use granular_edmd::wall::{BiParabolic, Sawtooth, Sinusoidal, Triangular};
use proptest::prelude::*;

use crate::laws::{Law, law};
use support::cases::decades;

#[derive(Debug, Clone, Copy)]
enum Shape {
    Fixed,
    BiParabolic,
    Sinusoidal,
    Triangular,
    Sawtooth,
}

/// The response of a wall to a touch.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Conduct {
    /// The law of the disks.
    Shared,
    Own(Law),
    Thermal(Thermal),
}

/// A wall as data.
#[derive(Debug, Clone, Copy)]
struct Plan {
    shape: Shape,
    amplitude: f64,
    frequency: f64,
    conduct: Conduct,
}

/// A container as data.
#[derive(Debug, Clone)]
pub(crate) struct Walls {
    width: f64,
    pub(crate) height: f64,
    open: bool,
    periodic: bool,
    plans: [Plan; 4],
}

const WALLS: [Wall; 4] = [Wall::Floor, Wall::Lid, Wall::Left, Wall::Right];

/// Highest speed of any of these walls.
pub(crate) const FASTEST: f64 = 4.0 * LARGEST_AMPLITUDE * HIGHEST_FREQUENCY / std::f64::consts::PI;
const LARGEST_AMPLITUDE: f64 = 0.3;
const HIGHEST_FREQUENCY: f64 = 20.0;

impl Walls {
    pub(crate) fn container(&self) -> Container {
        let container =
            if self.open { Container::open(self.width) } else { Container::closed(self.width, self.height) };
        let container = container.unwrap();
        let container = if self.periodic { container.with_periodic_sides().unwrap() } else { container };
        WALLS.iter().zip(&self.plans).fold(container, |container, (&wall, plan)| {
            match container.index(wall) {
                Some(_) => plan.apply(container, wall).unwrap(),
                None => container,
            }
        })
    }

    /// Returns the response of the wall of this index.
    pub(crate) fn conduct(&self, wall: usize) -> Conduct {
        let container = self.container();
        let place = WALLS.iter().position(|&kind| container.index(kind) == Some(wall));
        self.plans[place.unwrap()].conduct
    }
}

impl Plan {
    fn apply(&self, container: Container, wall: Wall) -> Result<Container, WallError> {
        let &Self { amplitude, frequency, .. } = self;
        let container = match self.shape {
            Shape::Fixed => container,
            Shape::BiParabolic => {
                container.with_motion(wall, BiParabolic::new(amplitude, frequency).unwrap())?
            }
            Shape::Sinusoidal => {
                container.with_motion(wall, Sinusoidal::new(amplitude, frequency).unwrap())?
            }
            Shape::Triangular => {
                container.with_motion(wall, Triangular::new(amplitude, frequency).unwrap())?
            }
            Shape::Sawtooth => container.with_motion(wall, Sawtooth::new(amplitude, frequency).unwrap())?,
        };
        match self.conduct {
            Conduct::Shared => Ok(container),
            Conduct::Own(law) => container.with_rule(wall, law.rule()),
            Conduct::Thermal(thermal) => container.with_temperature(wall, thermal),
        }
    }
}

fn plan() -> impl Strategy<Value = Plan> {
    let shape = prop_oneof![
        2 => Just(Shape::Fixed),
        1 => Just(Shape::BiParabolic),
        1 => Just(Shape::Sinusoidal),
        1 => Just(Shape::Triangular),
        1 => Just(Shape::Sawtooth),
    ];
    let thermal = (decades(-1.0, 1.0), any::<bool>()).prop_map(|(temperature, slip)| {
        let thermal = Thermal::new(temperature).unwrap();
        if slip { thermal.with_slip() } else { thermal }
    });
    let conduct = prop_oneof![
        2 => Just(Conduct::Shared),
        1 => law().prop_map(Conduct::Own),
        1 => thermal.prop_map(Conduct::Thermal),
    ];
    (shape, 0.01..LARGEST_AMPLITUDE, 1.0..HIGHEST_FREQUENCY, conduct)
        .prop_map(|(shape, amplitude, frequency, conduct)| Plan { shape, amplitude, frequency, conduct })
}

pub(crate) fn walls() -> impl Strategy<Value = Walls> {
    (8.5..16.0f64, 5.0..16.0f64, any::<[bool; 2]>(), [plan(), plan(), plan(), plan()])
        .prop_map(|(width, height, [open, periodic], plans)| Walls { width, height, open, periodic, plans })
}
