//! The meanings of the parameters of the box and of the columns of its tables.

pub(super) const MEANINGS: [(&str, &str); 44] = [
    ("disks", "Number of disks, from 1 to 2^24. Their diameter and their mass are the units. Required."),
    ("width", "Width of the box, in diameters. Required."),
    ("height", "Height of the lid, in diameters. Without a value, the box is open."),
    (
        "gravity",
        "Acceleration downwards; below 0 only under a lid. The paper has 0.015625 and 0.002025. 0 if not given.",
    ),
    (
        "inelasticity",
        "q = (1 - r) / 2 of the restitution r, from 0 (elastic) to 0.5: normal, and tangential unless that is given. 0 if not given.",
    ),
    (
        "tangential_inelasticity",
        "Tangential inelasticity, from 0 (sticking reverses the slip) over 0.5 (stops it) to 1 (does nothing). The normal one if not given.",
    ),
    (
        "friction",
        "Coulomb's coefficient, at least 0: static, and dynamic unless that is given. 0 if not given.",
    ),
    (
        "dynamic_friction",
        "Dynamic friction, at most the static one. The same as the static one if not given.",
    ),
    ("wall_inelasticity", "Inelasticity of the walls, normal and tangential. The disks' if not given."),
    ("base_inelasticity", "Inelasticity of the base alone. The walls' if not given."),
    (
        "base_tangential_inelasticity",
        "Tangential inelasticity of the base alone, from 0 to 1. If not given, the same as `base_inelasticity`, or else `wall_inelasticity`; without these, as the disks.",
    ),
    ("wall_friction", "Friction of the walls, static and dynamic. The disks' if not given."),
    (
        "contact_duration",
        "Time after a collision in which the next one of a disk loses nothing, which prevents inelastic collapse; above 0. None if not given.",
    ),
    ("initial_temperature", "Temperature of the velocities at the start. 1 if not given."),
    (
        "sides",
        "`hard` (the rule of the disks), `elastic` (smooth and elastic) or `periodic`. Hard if not given.",
    ),
    ("base", "Source of the motion: one of bi_parabolic, sinusoidal or thermal. Required."),
    ("base.bi_parabolic", "The paper's base, whose motion is made of parabolas."),
    ("base.bi_parabolic.amplitude", "Amplitude of the base, in diameters. Required."),
    (
        "base.bi_parabolic.angular_frequency",
        "Angular frequency of the base: a period is 2 pi divided by it. Required.",
    ),
    ("base.sinusoidal", "A base that moves as a sine."),
    ("base.sinusoidal.amplitude", "Amplitude of the base, in diameters. Required."),
    (
        "base.sinusoidal.angular_frequency",
        "Angular frequency of the base: a period is 2 pi divided by it. Required.",
    ),
    ("base.thermal", "A base at rest that emits disks as a heat bath does."),
    ("base.thermal.temperature", "Temperature of the base. Required."),
    (
        "base.thermal.slip",
        "`true` if the thermal base leaves tangential and angular velocity as they are. `false` if not given.",
    ),
    (
        "state",
        "Convective regime: no roll, one roll, two rolls, coexistence of one roll and two, or collapsed.",
    ),
    (
        "one_roll",
        "First order parameter: above 0 for one clockwise roll, below 0 for a counterclockwise one.",
    ),
    (
        "one_roll_magnitude",
        "Mean of the magnitude of the first order parameter, which does not vanish by reversals.",
    ),
    ("two_rolls", "Second order parameter: above 0 for two rolls that rise in the middle."),
    ("center_of_mass_height", "Height of the center of mass above the middle of the base."),
    ("translational_energy", "Translational energy of a disk."),
    ("rotational_energy", "Rotational energy of a disk."),
    ("vertical_temperature", "Temperature of the vertical velocities."),
    ("collisions", "Number of collisions of two disks: since the sample before, or of the whole value."),
    ("energy_change", "Mean change of the energy in a collision of two disks, the paper's <dE>."),
    ("thermal_noise", "Standard deviation of the order parameters of a gas at rest at the same temperature."),
    ("densest_packing", "Packing fraction of the densest layer."),
    ("densest_height", "Height of the densest layer."),
    ("wall_collisions", "Number of collisions with walls."),
    (
        "contact_duration_collisions",
        "Number of collisions that lost nothing because of the contact duration.",
    ),
    ("max_overlap", "Deepest overlap that rounding has made."),
    ("warnings", "Number of warnings of the run; the log has their words."),
    ("layer_height", "Height of the middle of a layer that is one diameter high."),
    ("packing_fraction", "Part of the layer that disks cover, averaged over the samples."),
];
