//! Viscoelastic restitution r(v) = 1 - a v^(1/5) + b v^(2/5) with Coulomb friction, and a bulk damping of
//! spins.
use granular_edmd::prelude::*;
use granular_edmd::Fingerprint;
use granular_edmd::collision::Friction;
use granular_edmd::quantity::{non_negative};
use granular_edmd::simulation::Driving;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Visco { a: f64, b: f64, friction: Friction }

impl Visco {
    pub fn new(a: f64, b: f64, friction: Friction) -> Result<Self, ParameterError> {
        Ok(Self { a: non_negative("a", a)?, b: non_negative("b", b)?, friction })
    }
    /// The series is valid up to its minimum only; beyond, r stays at the minimum, and never below 0.
    pub fn restitution(&self, v: f64) -> f64 {
        let mut x = libm::pow(v, 0.2);
        if self.b > 0.0 { x = x.min(self.a / (2.0 * self.b)); }
        (1.0 - self.a * x + self.b * x * x).clamp(0.0, 1.0)
    }
}
impl CollisionRule for Visco {
    fn impulse(&self, c: &Contact) -> Impulse {
        self.friction.impulse(c, c.normal_impulse(self.restitution(c.closing_speed())))
    }
    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("visco 1").number(self.a).number(self.b)
            .number(self.friction.tangential_inelasticity())
            .number(self.friction.static_friction()).number(self.friction.dynamic_friction()))
    }
}
/// A rule cannot exert a couple, so spins are damped in the bulk: omega *= exp(-rate dt).
#[derive(Debug, Clone)]
pub struct SpinDamping { pub clock: SampleTimes, factor: f64 }
impl SpinDamping {
    pub fn new(rate: f64, dt: f64) -> Result<Self, ParameterError> {
        Ok(Self { clock: SampleTimes::every(dt)?, factor: libm::exp(-non_negative("rate", rate)? * dt) })
    }
}
impl Driving for SpinDamping {
    fn times(&mut self) -> &mut SampleTimes { &mut self.clock }
    fn kick(&mut self, disks: &mut [Disk]) -> Result<(), ParameterError> {
        for d in disks { *d = d.with_angular_velocity(d.angular_velocity() * self.factor)?; }
        Ok(())
    }
}
