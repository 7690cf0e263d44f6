//! Collision rules.

use std::sync::Arc;

use edmd::collision::{
    CollisionRule, Contact, ContactDuration, Elastic, ElasticBelow, Friction, Frictional, Impulse, KnownRule,
    LeastRebound, RollingFriction, Rough, RulesByKind, Smooth, SpeedDependent,
};
use edmd::{Fingerprint, Kind, ParameterError};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::data::{described, from_data, to_data};
use crate::errors::{call, invalid, or_raised};

/// A rule of any type, which a simulation shares with the object in Python.
pub(crate) type SharedRule = Arc<dyn CollisionRule + Send + Sync>;

/// The rule of a collision, which decides its impulse.
///
/// `Frictional(0.0, 0.0, 0.03)` and the like create one. Wherever a rule is expected, a function of a
/// `Contact` can stand, too: it returns the normal impulse (mass length/time), or a pair of the normal and
/// the tangential impulse. Such a function takes 0.2 to 0.3 µs more for each collision.
#[pyclass(name = "Rule", module = "granular_edmd", frozen)]
#[derive(Clone)]
pub(crate) struct PyRule {
    pub(crate) rule: SharedRule,
    /// The function, if the rule is one.
    function: Option<Arc<Py<PyAny>>>,
}

impl PyRule {
    pub(crate) fn of(rule: impl CollisionRule + Send + Sync + 'static) -> Self {
        Self { rule: Arc::new(rule), function: None }
    }

    fn checked<R>(rule: Result<R, ParameterError>) -> PyResult<Self>
    where
        R: CollisionRule + Send + Sync + 'static,
    {
        rule.map(Self::of).map_err(invalid)
    }
}

/// An argument that is a rule, or a function as a rule.
pub(crate) struct AnyRule(pub(crate) PyRule);

impl<'py> FromPyObject<'_, 'py> for AnyRule {
    type Error = PyErr;

    fn extract(any: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(rule) = any.cast::<PyRule>() {
            return Ok(Self(rule.get().clone()));
        }
        if any.is_callable() && !any.is_instance_of::<pyo3::types::PyType>() {
            let function = Arc::new(any.to_owned().unbind());
            let rule = Arc::new(Function(function.clone()));
            return Ok(Self(PyRule { rule, function: Some(function) }));
        }
        let message =
            format!("{}: a rule is expected, such as Frictional(0.0, 0.0, 0.1), or a function", any.repr()?);
        Err(PyTypeError::new_err(message))
    }
}

/// A rule in Python.
struct Function(Arc<Py<PyAny>>);

impl CollisionRule for Function {
    /// Returns an impulse that is not a number if the function fails: the engine ends the run, and the run
    /// raises the function's exception.
    fn impulse(&self, contact: &Contact) -> Impulse {
        let impulse = call(|py| {
            let answer = self.0.call1(py, (PyContact(*contact),))?;
            let pair = answer.extract::<(f64, f64)>(py);
            pair.or_else(|_| Ok((answer.extract::<f64>(py)?, 0.0)))
        });
        let (normal, tangential) = impulse.unwrap_or((f64::NAN, f64::NAN));
        Impulse::new(normal, tangential)
    }
    fn fingerprint(&self) -> Option<Fingerprint> {
        None
    }
    fn known(&self) -> Option<KnownRule> {
        None
    }
}

/// The contact of two partners in a collision, before it.
#[pyclass(name = "Contact", module = "granular_edmd", frozen)]
#[derive(Clone, Copy)]
pub(crate) struct PyContact(pub(crate) Contact);

#[pymethods]
impl PyContact {
    /// Creates a contact, to try rules.
    #[new]
    fn new(closing_speed: f64, slip_speed: f64, normal_mass: f64, tangential_mass: f64) -> Self {
        Self(Contact::new(closing_speed, slip_speed, normal_mass, tangential_mass))
    }
    /// The speed at which the partners approach each other (length/time).
    #[getter]
    fn closing_speed(&self) -> f64 {
        self.0.closing_speed()
    }
    /// The speed at which the surfaces slide along each other (length/time).
    #[getter]
    fn slip_speed(&self) -> f64 {
        self.0.slip_speed()
    }
    /// The reduced mass along the normal.
    #[getter]
    fn normal_mass(&self) -> f64 {
        self.0.normal_mass()
    }
    /// The reduced mass along the tangent, which contains the moments of inertia.
    #[getter]
    fn tangential_mass(&self) -> f64 {
        self.0.tangential_mass()
    }
    /// The kinds of both partners.
    #[getter]
    fn kinds(&self) -> (u16, u16) {
        let [first, second] = self.0.kinds();
        (first.number(), second.number())
    }
    fn __repr__(&self) -> String {
        format!("Contact(closing_speed={}, slip_speed={})", self.0.closing_speed(), self.0.slip_speed())
    }
}

#[pymethods]
impl PyRule {
    /// Creates a rule from its data, as `to_dict` returns them. The same checks are made.
    #[staticmethod]
    fn from_dict(data: &Bound<'_, PyAny>) -> PyResult<Self> {
        from_data::<KnownRule>(data).map(Self::of)
    }
    /// Creates a rule from a function of a `Contact`.
    #[staticmethod]
    fn from_function(function: AnyRule) -> Self {
        function.0
    }
    /// Returns the rule as dictionaries and numbers, for example for JSON.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let known = self.rule.known();
        let known =
            known.ok_or_else(|| PyTypeError::new_err("a rule that contains a function is not data"))?;
        to_data(py, &known)
    }
    /// Returns the normal and the tangential impulse (mass length/time) of a contact.
    fn impulse(&self, contact: &PyContact) -> PyResult<(f64, f64)> {
        let impulse = self.rule.impulse(&contact.0);
        or_raised(Ok((impulse.normal(), impulse.tangential())))
    }
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        match &self.function {
            Some(function) => Ok(format!("Rule.from_function({})", function.bind(py).repr()?)),
            None => self.to_dict(py).map_or(Ok("Rule with a function".into()), |data| described(&data)),
        }
    }
    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        let Ok(other) = other.cast::<Self>() else { return false };
        let known = self.rule.known();
        Arc::ptr_eq(&self.rule, &other.get().rule) || (known.is_some() && known == other.get().rule.known())
    }
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyAny>,))> {
        let class = py.get_type::<Self>();
        Ok(match &self.function {
            Some(function) => (class.getattr("from_function")?, (function.bind(py).clone(),)),
            None => (class.getattr("from_dict")?, (self.to_dict(py)?,)),
        })
    }
}

fn one_of<T>(inelasticity: Option<T>, restitution: Option<T>) -> PyResult<Result<T, T>> {
    match (inelasticity, restitution) {
        (Some(inelasticity), None) => Ok(Ok(inelasticity)),
        (None, Some(restitution)) => Ok(Err(restitution)),
        _ => Err(PyTypeError::new_err(
            "give either all inelasticities q = (1 - r)/2 or restitution=r, for Frictional and Rough a pair",
        )),
    }
}

fn both<T>(normal: Option<T>, tangential: Option<T>) -> Option<(T, T)> {
    normal.zip(tangential)
}

/// Returns the rule of perfectly elastic, smooth disks.
#[pyfunction]
#[pyo3(name = "Elastic")]
pub(crate) fn elastic() -> PyRule {
    PyRule::of(Elastic)
}

/// Returns the rule of smooth disks with the inelasticity q = (1 - r)/2, or with `restitution=r`.
#[pyfunction]
#[pyo3(name = "Smooth", signature = (normal=None, *, restitution=None))]
pub(crate) fn smooth(normal: Option<f64>, restitution: Option<f64>) -> PyResult<PyRule> {
    PyRule::checked(match one_of(normal, restitution)? {
        Ok(inelasticity) => Smooth::from_inelasticity(inelasticity),
        Err(restitution) => Smooth::from_restitution(restitution),
    })
}

/// Returns the rule of rough disks, which never slide.
///
/// The inelasticities are normal and tangential, or `restitution=(normal, tangential)`. The tangential
/// inelasticity 0 is perfectly rough.
#[pyfunction]
#[pyo3(name = "Rough", signature = (normal=None, tangential=None, *, restitution=None))]
pub(crate) fn rough(
    normal: Option<f64>,
    tangential: Option<f64>,
    restitution: Option<(f64, f64)>,
) -> PyResult<PyRule> {
    PyRule::checked(match one_of(both(normal, tangential), restitution)? {
        Ok((normal, tangential)) => Rough::from_inelasticity(normal, tangential),
        Err((normal, tangential)) => Rough::from_restitution(normal, tangential),
    })
}

/// Returns the rule of the paper: normal and tangential inelasticity, and static friction.
///
/// `restitution=(normal, tangential)` stands for the inelasticities. The dynamic friction is the static one
/// unless `dynamic_friction` is given.
#[pyfunction]
#[pyo3(
    name = "Frictional",
    signature = (normal=None, tangential=None, friction=0.0, *, restitution=None, dynamic_friction=None)
)]
pub(crate) fn frictional(
    normal: Option<f64>,
    tangential: Option<f64>,
    friction: f64,
    restitution: Option<(f64, f64)>,
    dynamic_friction: Option<f64>,
) -> PyResult<PyRule> {
    let rule = match one_of(both(normal, tangential), restitution)? {
        Ok((normal, tangential)) => Frictional::from_inelasticity(normal, tangential, friction),
        Err((normal, tangential)) => Frictional::from_restitution(normal, tangential, friction),
    };
    let dynamic = dynamic_friction.unwrap_or(friction);
    PyRule::checked(rule.and_then(|rule| rule.with_dynamic_friction(dynamic)))
}

/// Returns a rule whose restitution falls with the closing speed: the greatest inelasticity, and the speed
/// (length/time) over which it is reached.
///
/// `friction` adds tangential inelasticity and friction as a pair.
#[pyfunction]
#[pyo3(name = "SpeedDependent", signature = (normal=None, speed=1.0, *, restitution=None, friction=None))]
pub(crate) fn speed_dependent(
    normal: Option<f64>,
    speed: f64,
    restitution: Option<f64>,
    friction: Option<(f64, f64)>,
) -> PyResult<PyRule> {
    let rule = match one_of(normal, restitution)? {
        Ok(inelasticity) => SpeedDependent::from_inelasticity(inelasticity, speed),
        Err(restitution) => SpeedDependent::from_restitution(restitution, speed),
    };
    let Some((tangential, friction)) = friction else { return PyRule::checked(rule) };
    let friction = Friction::from_inelasticity(tangential, friction);
    PyRule::checked(rule.and_then(|rule| Ok(rule.with_friction(friction?))))
}

/// Returns a rule with a contact duration (time): a disk that collides again within it does so elastically.
#[pyfunction]
#[pyo3(name = "ContactDuration")]
pub(crate) fn contact_duration(rule: AnyRule, duration: f64) -> PyResult<PyRule> {
    match rule.0.rule.known() {
        Some(known) => PyRule::checked(ContactDuration::new(known, duration)),
        None => PyRule::checked(ContactDuration::new(rule.0.rule, duration)),
    }
}

/// Creates functions of a rule and a number.
macro_rules! remedies {
    ($($function:ident, $remedy:ident, $name:literal, $number:ident, $what:literal;)+) => {$(
        #[doc = $what]
        #[pyfunction]
        #[pyo3(name = $name)]
        pub(crate) fn $function(rule: AnyRule, $number: f64) -> PyResult<PyRule> {
            PyRule::checked($remedy::new(rule.0.rule, $number))
        }
    )+};
}

remedies! {
    elastic_below, ElasticBelow, "ElasticBelow", speed,
        "Returns a rule that is elastic below a closing speed (length/time).";
    least_rebound, LeastRebound, "LeastRebound", speed,
        "Returns a rule whose partners part at least at this speed (length/time).";
    rolling_friction, RollingFriction, "RollingFriction", coefficient,
        "Returns a rule with rolling friction of this coefficient (length).";
}

/// Returns a table of rules for pairs of kinds, `{(0, 1): rule, (1, WALL): rule}`, and a rule for all others.
///
/// The order within a pair does not matter; of two rules for a pair, the later one counts.
#[pyfunction]
#[pyo3(name = "RulesByKind")]
pub(crate) fn rules_by_kind(otherwise: AnyRule, pairs: &Bound<'_, PyDict>) -> PyResult<PyRule> {
    let mut rules = RulesByKind::new(otherwise.0.rule);
    for (pair, rule) in pairs {
        let (first, second) = pair.extract::<(u16, u16)>()?;
        rules = rules.with(Kind::new(first), Kind::new(second), rule.extract::<AnyRule>()?.0.rule);
    }
    Ok(PyRule::of(rules))
}
