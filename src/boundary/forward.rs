//! Forwarding: a boxed or borrowed boundary is a boundary, too.

use glam::DVec2;

use super::{
    Boundary, Domain, FirstTouch, Impact, Overlap, Probe, Reaction, Region, Surface, Touch, WallView,
};
use crate::forward::forward;
use crate::{Fingerprint, Flight, ParameterError};

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
