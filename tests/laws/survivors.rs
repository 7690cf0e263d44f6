//! Planted faults that the checks do not find, each with the reason.

/// Names of faults, and reasons.
pub(crate) const SURVIVORS: [(&str, &str); 4] = [
    (
        "boundary, blind: velocity: the floor forgets that it slides",
        "a velocity along a straight wall does not show in its geometry",
    ),
    (
        "rule, blind: corners: a reduced mass squared vanishes and divides",
        "no fault: the masses of disks are between 1e-30 and 1e30, and their squares do not vanish",
    ),
    (
        "boundary, informed: rounding: touches are early by 1e-9 of the radius",
        "within the tolerance of the contract",
    ),
    ("rule, informed: after many: after three million calls, nothing is lost", "the check asks less often"),
];
