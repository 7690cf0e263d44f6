//! Planted faults that the checks do not find, each with the reason.

/// Names of faults, and reasons.
pub(crate) const SURVIVORS: [(&str, &str); 10] = [
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
    (
        "boundary, informed: scatter: the free area is too large by 1e-4",
        "within the scatter of the places at which overlaps are counted",
    ),
    (
        "boundary, informed: sign of a state: a state is set without signs",
        "no blow of the check changes the sign",
    ),
    (
        "fingerprint, informed: kind: the kind of a soft pair above 1000 is forgotten",
        "the check compares rules for its own kinds",
    ),
    ("observer, informed: beyond the script: sample 5000 is asked for again", "the check takes 300 samples"),
    ("rule, informed: unnamed kind: gain of kind 1000, which nobody names", "the author must name the kinds"),
    ("rule, informed: after many: after a million calls, nothing is lost", "the check asks 300 000 times"),
    (
        "scheduler, informed: beyond the scripts: one set in a million is lost",
        "a script has 50 000 operations",
    ),
];
