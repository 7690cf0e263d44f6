"""Event-driven molecular dynamics of granular disks.

Disks that are inelastic, rotate and have friction move from collision to collision, with no time step. You
choose the units: with the diameter and the mass of a disk as 1, all lengths, masses and energies follow.

>>> import granular_edmd as ge
>>> box = ge.Container.closed(20.0, 20.0)
>>> disks = ge.with_maxwellian_velocities(ge.lattice(box, 100, 0.5), 1.0, 1)
>>> gas = ge.Simulation(ge.Elastic(), box, disks)
>>> gas.run_until(10.0)
'time'
>>> gas.positions.shape
(100, 2)
"""

from ._granular_edmd import *  # noqa: F403
from ._granular_edmd import __version__ as __version__
from .study import read_tables as read_tables
from .study import run_study as run_study
from .study import vibrated_box as vibrated_box
