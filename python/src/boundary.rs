//! Containers and their parts.

use edmd::Kind;
use edmd::boundary::{Boundary as _, Brick, Container, Part, Thermal, Wall, WallError};
use edmd::glam::DVec2;
use numpy::PyArray2;
use pyo3::exceptions::{PyKeyError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

use crate::arguments::{Pair, to_rows, vector};
use crate::data::{Data, data_class, from_data, to_data};
use crate::disks::Disks;
use crate::errors::invalid;
use crate::motion::{Motion, PyPiston};
use crate::rule::AnyRule;

/// A thermal wall of a temperature (energy): disks leave it with random velocities.
///
/// With `slip`, the wall leaves the tangential velocity and the spin as they are.
#[pyclass(name = "Thermal", module = "granular_edmd", frozen, from_py_object)]
#[derive(Clone)]
pub(crate) struct PyThermal(Thermal);

#[pymethods]
impl PyThermal {
    #[new]
    #[pyo3(signature = (temperature, *, slip=false))]
    fn new(temperature: f64, slip: bool) -> PyResult<Self> {
        let thermal = Thermal::new(temperature).map_err(invalid)?;
        Ok(Self(if slip { thermal.with_slip() } else { thermal }))
    }
    fn __repr__(&self) -> String {
        format!("Thermal({}, slip={})", self.0.temperature(), if self.0.slip() { "True" } else { "False" })
    }
}

fn wall(name: &str) -> PyResult<Wall> {
    let found =
        [Wall::Floor, Wall::Lid, Wall::Left, Wall::Right].into_iter().find(|wall| wall.name() == name);
    found.ok_or_else(|| PyKeyError::new_err(format!("no wall {name:?}: expected floor, lid, left or right")))
}

/// Gives a wall a motion, a piston, a temperature, a rule or a sink, or several of these.
fn set(container: Container, name: Wall, setting: &Bound<'_, PyAny>) -> PyResult<Container> {
    if setting.is_instance_of::<PyList>() || setting.is_instance_of::<PyTuple>() {
        return setting.try_iter()?.try_fold(container, |container, one| set(container, name, &one?));
    }
    let changed = if let Ok(motion) = setting.extract::<Motion>() {
        container.with_motion(name, motion.0)
    } else if let Ok(piston) = setting.extract::<PyPiston>() {
        container.with_piston(name, piston.0)
    } else if let Ok(thermal) = setting.extract::<PyThermal>() {
        container.with_temperature(name, thermal.0)
    } else if setting.extract::<&str>().is_ok_and(|text| text == "absorbing") {
        container.absorbing(name)
    } else if let Ok(rule) = setting.extract::<AnyRule>() {
        container.with_rule(name, rule.0.rule)
    } else {
        let expected = "a wall takes a motion, a Piston, a Thermal, a rule or \"absorbing\"";
        return Err(PyTypeError::new_err(format!("{}: {expected}", setting.repr()?)));
    };
    changed.map_err(invalid)
}

/// Sets the walls that keywords name.
fn with_walls(container: Container, walls: Option<&Bound<'_, PyDict>>) -> PyResult<PyContainer> {
    let mut container = container;
    for (name, setting) in walls.into_iter().flatten() {
        container = set(container, wall(name.extract()?)?, &setting)?;
    }
    Ok(PyContainer(container))
}

/// A box for disks, with parts of any shape in it. It never changes: each method returns another one.
///
/// In `closed` and `open`, the keywords `floor`, `lid`, `left` and `right` give a wall a motion, a `Piston`,
/// a `Thermal`, a rule or `"absorbing"`, or a list of these.
#[pyclass(name = "Container", module = "granular_edmd", frozen, from_py_object)]
#[derive(Clone)]
pub(crate) struct PyContainer(pub(crate) Container);

impl Data for PyContainer {
    fn data<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_data(py, &self.0)
    }
    fn of_data(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        from_data(data).map(Self)
    }
}

data_class!(PyContainer);

impl PyContainer {
    fn with(&self, change: impl FnOnce(Container) -> Result<Container, WallError>) -> PyResult<Self> {
        change(self.0.clone()).map(Self).map_err(invalid)
    }
}

#[pymethods]
impl PyContainer {
    /// Creates a closed box of this width and height, with its lower left corner at the origin.
    #[staticmethod]
    #[pyo3(signature = (width, height, **walls))]
    fn closed(width: f64, height: f64, walls: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        with_walls(Container::closed(width, height).map_err(invalid)?, walls)
    }
    /// Creates a box without a lid.
    #[staticmethod]
    #[pyo3(signature = (width, **walls))]
    fn open(width: f64, walls: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        with_walls(Container::open(width).map_err(invalid)?, walls)
    }
    /// Creates a box without walls: what leaves on one side enters on the other.
    #[staticmethod]
    fn periodic(width: f64, height: f64) -> PyResult<Self> {
        with_walls(Container::periodic(width, height).map_err(invalid)?, None)
    }
    /// Creates a container of parts that enclose the disks, from their names: `{"drum": Part.drum(…)}`.
    #[staticmethod]
    fn around(parts: &Bound<'_, PyDict>) -> PyResult<Self> {
        let named = |(name, part): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            Ok((name.extract::<String>()?, part.extract::<PyPart>()?.0))
        };
        let parts = parts.iter().map(named).collect::<PyResult<Vec<_>>>()?;
        Container::around(parts).map(Self).map_err(invalid)
    }
    /// Returns the same container with a motion, a `Piston`, a `Thermal`, a rule or `"absorbing"` at a wall.
    fn with_wall(&self, name: &str, setting: &Bound<'_, PyAny>) -> PyResult<Self> {
        set(self.0.clone(), wall(name)?, setting).map(Self)
    }
    /// Returns the same container with another kind of a wall, which rules by kind read.
    fn with_kind(&self, name: &str, kind: u16) -> PyResult<Self> {
        let name = wall(name)?;
        self.with(|container| container.with_kind(name, Kind::new(kind)))
    }
    /// Returns the same container with a wall whose surface moves along it like a belt (length/time).
    fn with_surface_speed(&self, name: &str, speed: f64) -> PyResult<Self> {
        let name = wall(name)?;
        self.with(|container| container.with_surface_speed(name, speed))
    }
    /// Returns the same container with a wall that slides along itself.
    fn with_sliding(&self, name: &str, motion: Motion) -> PyResult<Self> {
        let name = wall(name)?;
        self.with(|container| container.with_sliding(name, motion.0))
    }
    /// Returns the same container, shaken from side to side as a whole.
    fn shaken_sideways(&self, motion: Motion) -> PyResult<Self> {
        self.with(|container| container.shaken_sideways(motion.0))
    }
    /// Returns the same container, shaken up and down as a whole.
    fn shaken_vertically(&self, motion: Motion) -> PyResult<Self> {
        self.with(|container| container.shaken_vertically(motion.0))
    }
    /// Returns the same container with its left and right sides joined.
    fn with_periodic_sides(&self) -> PyResult<Self> {
        self.with(Container::with_periodic_sides)
    }
    /// Returns the same container with its floor and lid joined.
    fn with_periodic_ends(&self) -> PyResult<Self> {
        self.with(Container::with_periodic_ends)
    }
    /// Returns the same container with an additional part.
    fn with_part(&self, name: String, part: &PyPart) -> PyResult<Self> {
        self.with(|container| container.with_part(name, part.0.clone()))
    }
    /// Returns the same container without this part.
    fn without_part(&self, name: &str) -> PyResult<Self> {
        let mut container = self.0.clone();
        container.remove_part(name).map_err(invalid)?;
        Ok(Self(container))
    }
    /// Returns the same container with a fixed round peg for each disk, with its position, radius and kind.
    ///
    /// The parts are named "peg 0", "peg 1" and so on.
    fn with_pegs(&self, disks: &Disks) -> PyResult<Self> {
        self.with(|container| container.with_pegs(disks.0.iter().copied()))
    }
    /// The names of the parts, in the order of their walls.
    #[getter]
    fn parts(&self) -> Vec<String> {
        self.0.part_names().map(ToOwned::to_owned).collect()
    }
    /// The names of all walls: the container's own, then those of its parts.
    #[getter]
    pub(crate) fn walls(&self) -> Vec<String> {
        (0..self.0.wall_count()).map(|wall| self.0.wall(wall, 0.0).name.into_owned()).collect()
    }
    /// Returns the indices of the walls of a part.
    fn walls_of(&self, part: &str) -> PyResult<Vec<usize>> {
        let walls = self.0.walls_of(part).ok_or_else(|| PyKeyError::new_err(format!("no part {part:?}")))?;
        Ok(walls.collect())
    }
    /// The rectangle of the container: (left, right, bottom, top); the top of an open one is infinite.
    #[getter]
    fn domain(&self) -> (f64, f64, f64, f64) {
        let domain = self.0.domain();
        (domain.left, domain.right, domain.bottom, domain.top)
    }
    /// Returns the lines of all walls at a time, for pictures: arrays of shape (points, 2).
    ///
    /// They are empty for the straight walls of the container, which `domain` has. A part with a mass is
    /// where the run has left it in `simulation.boundary`.
    #[pyo3(signature = (time=0.0))]
    fn lines<'py>(&self, py: Python<'py>, time: f64) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        (0..self.0.wall_count()).map(|wall| to_rows(py, self.0.wall(wall, time).line())).collect()
    }
    fn __repr__(&self) -> String {
        let (left, right, bottom, top) = self.domain();
        let walls: Vec<_> = self.walls();
        format!("<Container [{left}, {right}] x [{bottom}, {top}], walls {walls:?}>")
    }
}

/// A part of a container: walls of any shape. It never changes: each method returns another one.
#[pyclass(name = "Part", module = "granular_edmd", frozen, from_py_object)]
#[derive(Clone)]
pub(crate) struct PyPart(Part);

impl Data for PyPart {
    fn data<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_data(py, &self.0)
    }
    fn of_data(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        from_data(data).map(Self)
    }
}

data_class!(PyPart);

impl PyPart {
    fn checked(part: Result<Part, WallError>) -> PyResult<Self> {
        part.map(Self).map_err(invalid)
    }
}

fn points(points: Vec<Pair>) -> impl Iterator<Item = DVec2> {
    points.into_iter().map(vector)
}

#[pymethods]
impl PyPart {
    /// Creates a closed polygon with the disks inside.
    #[staticmethod]
    fn polygon(corners: Vec<Pair>) -> PyResult<Self> {
        Self::checked(Part::polygon(points(corners)))
    }
    /// Creates a closed polygon with the disks outside: a solid block.
    #[staticmethod]
    fn block(corners: Vec<Pair>) -> PyResult<Self> {
        Self::checked(Part::block(points(corners)))
    }
    /// Creates a thin wall from point to point, with disks on both sides.
    #[staticmethod]
    fn polyline(corners: Vec<Pair>) -> PyResult<Self> {
        Self::checked(Part::polyline(points(corners)))
    }
    /// Creates a circle with the disks inside.
    #[staticmethod]
    fn drum(center: Pair, radius: f64) -> PyResult<Self> {
        Self::checked(Part::drum(vector(center), radius))
    }
    /// Creates a circle with the disks outside.
    #[staticmethod]
    fn peg(center: Pair, radius: f64) -> PyResult<Self> {
        Self::checked(Part::peg(vector(center), radius))
    }
    /// Creates a part of bricks.
    #[staticmethod]
    fn of(bricks: Vec<PyBrick>) -> PyResult<Self> {
        Self::checked(Part::new(bricks.into_iter().map(|brick| brick.0)))
    }
    /// Returns the distance (length) of a point from the part, negative where no disk can be.
    fn signed_distance(&self, point: Pair) -> f64 {
        self.0.signed_distance(vector(point))
    }
    /// Returns the same part as a sink, which removes a disk at its first touch.
    fn absorbing(&self) -> Self {
        Self(self.0.clone().absorbing())
    }
    /// Returns the same part as a sink, which removes a disk when its center arrives.
    fn absorbing_centers(&self) -> Self {
        Self(self.0.clone().absorbing_centers())
    }
    /// Returns the same part for disks of these kinds only; all others pass through.
    fn only_for(&self, kinds: Vec<u16>) -> Self {
        Self(self.0.clone().only_for(kinds.into_iter().map(Kind::new)))
    }
    /// Returns the same part with another kind, which rules by kind read.
    fn with_kind(&self, kind: u16) -> Self {
        Self(self.0.clone().with_kind(Kind::new(kind)))
    }
    /// Returns the same part with its own rule.
    fn with_rule(&self, rule: AnyRule) -> Self {
        Self(self.0.clone().with_rule(rule.0.rule))
    }
    /// Returns the same part as a thermal wall.
    fn with_temperature(&self, thermal: PyThermal) -> Self {
        Self(self.0.clone().with_temperature(thermal.0))
    }
    /// Returns the same part with a surface that moves like a belt (length/time).
    fn with_surface_speed(&self, speed: f64) -> PyResult<Self> {
        Self::checked(self.0.clone().with_surface_speed(speed))
    }
    /// Returns the same part, which moves along a direction.
    fn with_motion(&self, direction: Pair, motion: Motion) -> PyResult<Self> {
        Self::checked(self.0.clone().with_motion(vector(direction), motion.0))
    }
    /// Returns the same part, which disks push along a direction: a `Piston`.
    fn with_piston(&self, direction: Pair, piston: PyPiston) -> PyResult<Self> {
        Self::checked(self.0.clone().with_piston(vector(direction), piston.0))
    }
    /// Returns the same part, which turns about a point at this angular velocity (1/time), counterclockwise.
    fn with_rotation(&self, about: Pair, angular_velocity: f64) -> PyResult<Self> {
        Self::checked(self.0.clone().with_rotation(vector(about), angular_velocity))
    }
    /// Returns the same part, whose motion or rotation has phase 0 at this time.
    fn starting_at(&self, time: f64) -> PyResult<Self> {
        Self::checked(self.0.clone().starting_at(time))
    }
    /// Returns the same part, shifted by a vector.
    fn shifted(&self, by: Pair) -> PyResult<Self> {
        Self::checked(self.0.clone().shifted(vector(by)))
    }
    /// Returns the same part, turned about a point by an angle (radians).
    fn rotated(&self, about: Pair, angle: f64) -> PyResult<Self> {
        Self::checked(self.0.clone().rotated(vector(about), angle))
    }
    fn __repr__(&self) -> String {
        format!("<Part of {} bricks>", self.0.bricks().len())
    }
}

/// A straight or round piece of a part. Disks are on the left of its direction.
#[pyclass(name = "Brick", module = "granular_edmd", frozen, from_py_object)]
#[derive(Clone)]
pub(crate) struct PyBrick(Brick);

impl PyBrick {
    fn checked(brick: Result<Brick, WallError>) -> PyResult<Self> {
        brick.map(Self).map_err(invalid)
    }
}

#[pymethods]
impl PyBrick {
    /// Creates a straight piece.
    #[staticmethod]
    fn segment(start: Pair, end: Pair) -> PyResult<Self> {
        Self::checked(Brick::segment(vector(start), vector(end)))
    }
    /// Creates a circle with the disks inside.
    #[staticmethod]
    fn circle(center: Pair, radius: f64) -> PyResult<Self> {
        Self::checked(Brick::circle(vector(center), radius))
    }
    /// Creates a piece of a circle between two angles (radians).
    #[staticmethod]
    fn arc(center: Pair, radius: f64, start: f64, end: f64) -> PyResult<Self> {
        Self::checked(Brick::arc(vector(center), radius, start, end))
    }
    /// Creates a point.
    #[staticmethod]
    fn point(position: Pair) -> PyResult<Self> {
        Self::checked(Brick::point(vector(position)))
    }
    /// Returns the same brick with the disks on its other side.
    fn reversed(&self) -> Self {
        Self(self.0.reversed())
    }
    /// Returns the same brick with disks on both sides.
    fn two_sided(&self) -> Self {
        Self(self.0.two_sided())
    }
    /// Returns the same brick, shifted by a vector.
    fn shifted(&self, by: Pair) -> PyResult<Self> {
        Self::checked(self.0.shifted(vector(by)))
    }
    /// Returns the same brick, turned about a point by an angle (radians).
    fn rotated(&self, about: Pair, angle: f64) -> PyResult<Self> {
        Self::checked(self.0.rotated(vector(about), angle))
    }
}
