"""Ten systems end in the states of the same systems in Rust, bit for bit: tests/systems.rs of the repository."""

from pathlib import Path

import numpy as np
import pytest
from blake3 import blake3

import granular_edmd as ge

HASHES = dict(line.split() for line in (Path(__file__).parent / "hashes.txt").read_text().splitlines())


def state_hash(run):
    """A name for a state, which depends on its last bit."""
    rows = np.column_stack([run.positions, run.velocities, run.angles, run.spins])
    return blake3(np.append(rows.ravel(), run.time).astype("<f8").tobytes()).hexdigest()[:32]


def warm(boundary, count, temperature):
    return ge.with_maxwellian_velocities(ge.lattice(boundary, count, 0.5), temperature, 1)


def paper_box():
    box = ge.Container.closed(60, 150, floor=ge.BiParabolic(0.1, 10))
    rule = ge.ContactDuration(ge.Frictional(0, 0, 0.03), 1e-4)
    run = ge.Simulation(rule, box, warm(box, 1000, 0.5), gravity=0.015625, seed=7)
    run.run_until(60)
    return run


def cooling_gas():
    box = ge.Container.periodic(30, 30)
    disks = ge.without_drift(ge.with_maxwellian_velocities(ge.even_lattice(box, 200, 0.5), 1, 3))
    run = ge.Simulation(ge.Smooth(restitution=0.9), box, disks, seed=7)
    for _ in run.sample(every=0.7, until=50):
        pass
    return run


def tilted_box():
    motion = (ge.Sinusoidal(0.3, 4) + ge.BiParabolic(0.1, 9)).scaled(1.5)
    box = ge.Container.closed(20, 40).shaken_vertically(motion)
    rule = ge.Rough(restitution=(0.9, 0.4))
    run = ge.Simulation(rule, box, warm(box, 100, 0.5), gravity=(0.02, -0.1), seed=7)
    run.run_until(30)
    return run


def thermal_walls():
    box = ge.Container.closed(20, 20, left=ge.Thermal(2), right=ge.Thermal(1, slip=True)).with_periodic_ends()
    disks = ge.with_maxwellian_velocities(ge.scattered(box, 100, 0.5, 20, 5), 1, 1)
    run = ge.Simulation(ge.Smooth(restitution=0.95), box, disks, seed=7)
    run.run_until(50)
    return run


def silo():
    shelves = [ge.Part.polyline([(start, 8), (end, 8)]) for start, end in [(0, 9), (15, 24)]]
    silo = ge.Container.open(24).with_part("left shelf", shelves[0]).with_part("right shelf", shelves[1])
    silo = silo.with_part("exit", ge.Part.polyline([(0, 2), (24, 2)]).absorbing_centers())
    closed = silo.with_part("gate", ge.Part.block([(0, 0), (24, 0), (24, 8), (0, 8)]))
    rule = ge.LeastRebound(ge.Frictional(0.1, 0.1, 0.4), 0.05)
    run = ge.Simulation(rule, closed, warm(closed, 200, 0.1), gravity=1, seed=7)
    run.run_until(10)
    run.boundary = run.boundary.without_part("gate")
    run.add_inlet(ge.Inlet.refill(((1, 30), (23, 32)), (0, -1), every=0.5, seed=1))
    run.run_until(30)
    return run


def drum():
    drum = ge.Container.around({"drum": ge.Part.drum((0, 0), 8).with_rotation((0, 0), 0.3)})
    disks = ge.disks_from_radii(ge.Radii.two_sizes(0.4, 0.6, 0.5).draw(60, 2), 1)
    rule = ge.LeastRebound(ge.Frictional(0.1, 0.1, 0.5), 0.05)
    run = ge.Simulation(rule, drum, ge.scattered_mix(drum, disks, 3, 1), gravity=1, seed=7)
    run.run_until(20)
    return run


def mixture():
    box = ge.Container.open(20, floor=ge.Sinusoidal(0.5, 3)).with_periodic_sides()
    disks = ge.disks_from_radii(ge.Radii.log_normal(0.5, 0.3, 0.3, 0.9).draw(80, 4), 1)
    disks = ge.packed_mix(box, disks.with_(kinds=np.arange(80) % 2), 12, 1)
    rolling = ge.RollingFriction(ge.Frictional(0.05, 0.1, 0.3), 0.01)
    rules = ge.RulesByKind(ge.Frictional(0.05, 0.05, 0.3), {(0, 1): rolling, (1, ge.WALL): ge.Elastic()})
    disks = ge.with_maxwellian_velocities(disks, 0.2, 1)
    run = ge.Simulation(ge.ContactDuration(rules, 1e-3), box, disks, gravity=0.5, seed=7)
    run.run_until(30, observe=ge.Series(ge.Energies(), every=0.3))
    return run


def piston():
    box = ge.Container.closed(20, 40, lid=ge.Piston(50, [-30, 30], force=1))
    run = ge.Simulation(ge.Elastic(), box, warm(box, 100, 1), seed=7)
    run.run_until(25)
    run = ge.Simulation.resume(run.checkpoint(), ge.Elastic(), box)
    run.run_until(50)
    return run


def white_noise():
    box = ge.Container.periodic(20, 20)
    run = ge.Simulation(ge.Smooth(restitution=0.8), box, ge.even_lattice(box, 100, 0.5), seed=7)
    run.run_until(50, drive=ge.WhiteNoise(0.3, every=0.2, seed=7, rotational_noise=0.1))
    return run


def pegs():
    box = ge.Container.closed(20, 30, left=ge.Smooth(0.3)).with_surface_speed("floor", 0.5)
    box = box.with_pegs(ge.Disks([[5, 5], [15, 5]], 1))
    rule = ge.ElasticBelow(ge.Frictional(0.02, 0.1, 0.2), 0.01)
    run = ge.Simulation(rule, box, warm(box, 80, 1), gravity=0.05, seed=7)
    run.run_until(50)
    return run


SYSTEMS = [
    paper_box, cooling_gas, tilted_box, thermal_walls, silo, drum, mixture, piston, white_noise, pegs
]


@pytest.mark.parametrize("system", SYSTEMS)
def test_the_final_state_is_the_same_as_in_rust(system):
    assert state_hash(system()) == HASHES[system.__name__]
