"""The module: physics, arrays, runs in pieces, exceptions, pickle, files."""

import copy
import json
import math
import pickle
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import granular_edmd as ge


def gas(rule=None, count=100, side=20.0, **keywords):
    """A gas of temperature 1 in a periodic box."""
    box = ge.Container.periodic(side, side)
    disks = ge.with_maxwellian_velocities(ge.even_lattice(box, count, 0.5), 1.0, 1)
    return ge.Simulation(rule or ge.Elastic(), box, disks, **keywords)


def same(first, second):
    """Whether two simulations have the same bits."""
    columns = ["positions", "velocities", "angles", "spins", "time"]
    return all(np.array_equal(getattr(first, name), getattr(second, name)) for name in columns)


def test_elastic_disks_keep_energy_and_momentum():
    run = gas()
    energy, momentum = (run.velocities**2).sum(), run.velocities.sum(axis=0)
    run.run_until(50.0)
    assert (run.velocities**2).sum() == pytest.approx(energy, rel=1e-12)
    assert np.allclose(run.velocities.sum(axis=0), momentum, atol=1e-10)


def test_arrays_go_in_and_come_back():
    random = np.random.default_rng(0)
    positions = np.stack(np.meshgrid(np.arange(1, 19, 2.0), np.arange(1, 19, 2.0)), -1).reshape(-1, 2)
    count = len(positions)
    disks = ge.Disks(
        positions,
        random.uniform(0.3, 0.9, count),
        velocities=random.normal(size=(count, 2)),
        masses=2,
        kinds=np.arange(count) % 3,
    )
    run = ge.Simulation(ge.Elastic(), ge.Container.closed(20, 20), disks)
    assert np.array_equal(run.positions, positions) and (run.masses == 2.0).all()
    assert np.array_equal(run.kinds, np.arange(count) % 3)
    run.run_until(5.0)
    run.disks = run.disks.with_(spins=1.0)
    assert (run.spins == 1.0).all()
    large = run.remove(run.radii > 0.6)
    assert (large.radii > 0.6).all() and len(large) + len(run) == count
    assert len(disks[disks.kinds == 1]) == count // 3


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: ge.Frictional(0.9, 0.0, 0.1),
        lambda: ge.Container.closed(60, -1),
        lambda: ge.Container.open(60, lid=ge.Thermal(1.0)),
        lambda: ge.Disks([[1, 1]], -0.5),
        lambda: ge.Disks([[1, 1, 1]], 0.5),
        lambda: ge.Disks([[1, 1]], 0.5, kinds=-1),
        lambda: ge.Disks([[1, 1], [3, 1]], [0.5, 0.5, 0.5]),
        lambda: ge.lattice(ge.Container.closed(5, 5), 100, 0.5),
        lambda: ge.Simulation(ge.Elastic(), ge.Container.closed(9, 9), ge.Disks([[1, 1], [1.2, 1]], 0.5)),
        lambda: ge.Rule.from_dict({"smooth": {"normal_inelasticity": 3.0}}),
        lambda: ge.SampleTimes(-1.0),
        lambda: gas(gravity=math.inf),
    ],
)
def test_what_cannot_be_used_is_a_value_error(wrong):
    with pytest.raises(ValueError) as raised:
        wrong()
    assert isinstance(raised.value, ge.ParameterError) and len(str(raised.value)) > 10


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: ge.Simulation("elastic", ge.Container.closed(9, 9), ge.Disks([[1, 1]], 0.5)),
        lambda: ge.Container.open(9, floor="sticky"),
        lambda: ge.Smooth(0.1, restitution=0.9),
        lambda: gas(gravity="down"),
        lambda: gas().run_until(1.0, observe=3),
        lambda: ge.Series(1.0, every=1.0),
    ],
)
def test_what_is_of_another_type_is_a_type_error(wrong):
    with pytest.raises(TypeError):
        wrong()


def test_gravity_is_a_number_downward_or_a_vector():
    assert gas(gravity=1.0).gravity == (0.0, -1.0) == gas(gravity=(0.0, -1.0)).gravity


def test_a_run_in_pieces_has_the_same_bits():
    rule = ge.Smooth(restitution=0.9)
    whole, pieces, samples = gas(rule), gas(rule), gas(rule)
    whole.run_until(40.0)
    while pieces.run_until(40.0, max_collisions=77) == "collisions":
        pass
    times = [snapshot.time for snapshot in samples.sample(every=0.7, until=40.0)]
    assert same(whole, pieces) and same(whole, samples)
    assert len(times) == 57 and times[2] == 2.1


def test_checkpoints_pickle_and_copies_continue_with_the_same_bits():
    rule, box = ge.Frictional(0.1, 0.1, 0.3), ge.Container.closed(20, 30, floor=ge.BiParabolic(0.1, 10.0))
    disks = ge.with_maxwellian_velocities(ge.lattice(box, 100, 0.5), 1.0, 1)
    run = ge.Simulation(ge.ContactDuration(rule, 1e-4), box, disks, gravity=0.02)
    run.run_until(10.0)
    twins = [pickle.loads(pickle.dumps(run)), copy.copy(run)]
    twins.append(ge.Simulation.resume(run.checkpoint(), run.rule, box))
    for each in [run, *twins]:
        each.run_until(20.0)
    assert all(same(run, twin) for twin in twins)
    with pytest.raises(ge.CheckpointError):
        ge.Simulation.resume(run.checkpoint(), ge.Elastic(), box)
    ge.Simulation.resume(run.checkpoint(), ge.Elastic(), box, another_rule=True)


def test_observers_are_saved_with_their_run():
    box = ge.Container.closed(20, 30)
    disks = ge.with_maxwellian_velocities(ge.lattice(box, 60, 0.5), 1.0, 1).with_(kinds=np.arange(60) % 2)
    times = ge.SampleTimes(0.7, start=0.1)
    series = ge.Series([ge.Energies(), ge.HexaticOrder(1.5).of_kind(1)], every=times)
    watches = [series, ge.EnergyChange().between_kinds(0, 1), ge.CollisionCounts(), ge.Stress(0.5)]
    watches += [ge.Series(ge.Energies(), every=1.0).by_collisions(7), ge.WallStress({"floor": 20.0}, 0.9)]
    watches += [ge.PairCorrelation(3.0, 10, 0.5), ge.MeanSquaredDisplacement(5, 0.5), ge.Arrivals(["floor"], 1.0)]
    watches += [ge.VelocityCorrelation(5, 0.5), ge.Crossings(((0, 9), (20, 9)), 1.0), ge.Fields(((0, 0), (20, 30)), 2, 3, 0.5)]
    watches += [ge.CollisionHistograms(3.0, 3.0, 8, walls=["floor"]), ge.VelocityDistribution(4.0, 8, 0.5)]
    watches += [ge.HeightProfile(0, 30, 5, 0.5), ge.EnergyChangeProfile(0, 30, 5, 0.5)]
    run = ge.Simulation(ge.Smooth(restitution=0.9), box, disks, gravity=0.01)
    run.run_until(3.3, observe=watches)
    twin, copies = pickle.loads(pickle.dumps((run, watches)))
    for each, observers in [(run, watches), (twin, copies)]:
        each.run_until(7.9, observe=observers)
    assert same(run, twin) and watches == copies and len(series["time"]) == 12
    for function in [ge.Series(len, every=1.0), ge.OnCollision(print).of_kind(1)]:
        with pytest.raises(ge.ParameterError, match="function of Python"):
            copy.copy(function)


@pytest.mark.parametrize("stop", [ValueError, KeyboardInterrupt])
def test_a_rule_that_raises_once_leaves_the_state_before_the_collision(stop):
    calls = 0

    def rule(contact):
        nonlocal calls
        calls += 1
        if calls == 50:
            raise stop("once")
        return 2.0 * contact.normal_mass * contact.closing_speed

    run, whole = gas(rule), gas(lambda contact: 2.0 * contact.normal_mass * contact.closing_speed)
    with pytest.raises(stop, match="once"):
        run.run_until(20.0)
    assert calls == 50 and run.time < 20.0
    for each in [run, whole]:
        each.run_until(20.0)
    assert same(run, whole)


def test_a_lid_with_a_mass_is_measured():
    lid = ge.Piston(4.0, (-3.0, 3.0), force=0.5, start=(1.0, 0.0))
    box = ge.Container.closed(6, 8, lid=lid)
    run = ge.Simulation(ge.Elastic(), box, ge.Disks([[3, 2]], 0.5))
    run.run_until(2.0)
    assert run.measure(ge.FreeWall("lid"))["displacement_y"] == -1.25
    with pytest.raises(TypeError, match="Series"):
        run.run_until(3.0, observe=ge.FreeWall("lid"))


def test_a_replay_finds_the_collisions_of_a_disk_and_the_first_difference():
    run = gas(ge.Elastic())
    whole = ge.Replay(run, every=1.0)
    whole.run_until(20.0)
    run.run_until(20.0)
    assert same(whole.at(20.0), run) and whole.at(21.0) is None
    number, collision = whole.last_collisions_of(7, until=20.0, count=3)[-1]
    before = whole.before_collision(number)
    assert before.collisions == number - 1 and 7 in collision.ids
    assert before.run_until(20.0, max_collisions=1) == "collisions" and before.time == collision.time
    assert whole.collisions(0.0, 20.0)[-1][0] == run.collisions
    other = gas(ge.Elastic())
    other.disks = other.disks.with_(velocities=other.velocities + np.eye(100, 2) * 1e-10)
    shifted = ge.Replay(other, every=1.0)
    shifted.run_until(20.0)
    apart = whole.differences(shifted, tolerance=1e-6)["apart"]
    assert 0 < apart[1] <= 20.0 and apart[2] > 1e-6
    with pytest.raises(ge.ParameterError, match="interval"):
        ge.Replay(run, every=0.0)


def test_another_seed_is_another_future():
    box = ge.Container.closed(9, 9, floor=ge.Thermal(1.0))
    run = ge.Simulation(ge.Elastic(), box, ge.lattice(box, 20, 0.5), gravity=1.0)
    futures = [ge.Simulation.resume(run.checkpoint(), run.rule, box, seed=seed) for seed in [1, 1, 2]]
    for future in futures:
        future.run_until(9.0)
    assert same(futures[0], futures[1]) and not same(futures[0], futures[2])


@pytest.mark.parametrize(
    "part",
    [
        ge.Frictional(0.1, 0.1, 0.3),
        ge.RulesByKind(ge.Elastic(), {(0, ge.WALL): ge.LeastRebound(ge.Smooth(0.1), 0.05)}),
        (ge.Sinusoidal(0.1, 10.0) + ge.BiParabolic(0.2, 3.0)).scaled(2.0).starting_at(1.0),
        ge.Container.closed(5, 5, floor=[ge.BiParabolic(0.1, 10), ge.Smooth(0.2)]),
        ge.Container.open(9).with_part("gate", ge.Part.polyline([(1, 1), (8, 1)])).with_periodic_sides(),
        ge.Disks([[1, 1], [3, 1]], 0.5, kinds=[0, 7]),
        ge.block_average(np.arange(64.0) % 5),
    ],
)
def test_parts_are_data_and_equal_their_copies(part):
    again = pickle.loads(pickle.dumps(part))
    assert again == part == copy.deepcopy(part) == type(part).from_dict(part.to_dict())
    assert json.dumps(again.to_dict()) == json.dumps(part.to_dict()) and part != 3
    assert repr(part)


def own_rule(contact):
    """Half of the speed is lost."""
    return 1.5 * contact.normal_mass * contact.closing_speed


def test_a_rule_in_python_has_the_bits_of_rust():
    own, known = gas(own_rule), gas(ge.Smooth(restitution=0.5))
    own.run_until(5.0)
    known.run_until(5.0)
    assert np.allclose(own.positions, known.positions, atol=1e-6)
    twin = pickle.loads(pickle.dumps(own))
    own.run_for(1.0)
    twin.run_for(1.0)
    assert same(own, twin)


@pytest.mark.parametrize(
    "keywords",
    [
        lambda broken: {"observe": ge.Series(broken, every=1.0)},
        lambda broken: {"observe": ge.OnCollision(broken)},
        lambda broken: {"observe": ge.StopWhen(broken, every=1.0)},
        lambda broken: {"drive": ge.Kick(broken, every=1.0)},
        lambda broken: {"progress": broken},
    ],
)
def test_exceptions_in_functions_come_through(keywords):
    with pytest.raises(ZeroDivisionError):
        gas().run_until(5.0, **keywords(lambda _: 1 / 0))
    with pytest.raises(ZeroDivisionError):
        gas(lambda _: 1 / 0).run_until(5.0)


def test_observers_continue_and_are_not_given_twice():
    run, series = gas(), ge.Series([ge.Energies(), ge.CenterOfMass()], every=1.0)
    with pytest.raises(RuntimeError):
        run.run_until(1.0, observe=[series, series])
    run.run_until(2.0, observe=series)
    run.run_until(4.0, observe=[series])
    assert list(series["time"]) == [1.0, 2.0, 3.0, 4.0] and series.units["center_x"] == "length"
    with pytest.raises(KeyError):
        series["height"]
    with pytest.raises(ge.RunError):
        gas().run_until(5.0, observe=series)


def test_own_observables():
    run = gas()
    speed = ge.Series(lambda seen: np.hypot(*seen.velocities.T).max(), every=1.0)
    both = ge.Series(lambda seen: {"x": seen.positions[0, 0], "count": len(seen)}, every=1.0)
    energy = ge.Series(lambda seen: 0.5 * (seen.velocities**2).sum() / len(seen), every=1.0)
    known = ge.Series(ge.Energies(), every=1.0)
    run.run_until(20.0, observe=[speed, both, energy, known])
    assert np.allclose(energy["value"], known["translational_energy"])
    assert (both["count"] == 100).all() and speed["value"].shape == (20,)
    assert energy.mean("value").error < 1e-6


def test_stops_and_limits():
    run = gas()
    assert run.run_until(100.0, observe=ge.StopWhen(lambda seen: seen.time >= 3.0, every=1.0)) == "observer"
    assert run.time == 3.0
    assert run.run_for(1.0) == "time"
    assert run.run_until(1e9, max_seconds=0.1) == "wall_clock"


def test_collisions_are_seen():
    run, lost, counts = gas(ge.Smooth(0.1)), ge.EnergyChange(), ge.CollisionCounts()
    seen = []
    run.run_until(5.0, observe=[lost, counts, ge.OnCollision(lambda collision: seen.append(collision.energy_change))])
    assert len(seen) == run.collisions and lost.results["disks"].mean == pytest.approx(np.mean(seen))


def test_white_noise_balances_dissipation():
    run, noise = gas(ge.Smooth(restitution=0.8)), ge.WhiteNoise(0.3, every=0.2, seed=7)
    series = ge.Series(ge.Temperatures(), every=1.0)
    run.run_until(100.0, observe=series, drive=noise)
    assert 0.1 < series["horizontal_temperature"][-20:].mean() < 5
    calls = []
    kick = ge.Kick(lambda disks: calls.append(1) or disks.with_(velocities=1.01 * disks.velocities), every=0.5)
    run.run_for(5.0, drive=kick)
    assert len(calls) == 10


def test_a_silo_runs_empty_through_its_outlet():
    shelf = ge.Part.polyline([(0, 8), (9, 8)]), ge.Part.polyline([(15, 8), (24, 8)])
    silo = ge.Container.open(24).with_part("left shelf", shelf[0]).with_part("right shelf", shelf[1])
    silo = silo.with_part("exit", ge.Part.polyline([(0, 2), (24, 2)]).absorbing_centers())
    closed = silo.with_part("gate", ge.Part.block([(0, 0), (24, 0), (24, 8), (0, 8)]))
    disks = ge.with_maxwellian_velocities(ge.lattice(closed, 200, 0.5), 0.1, 1)
    run = ge.Simulation(ge.LeastRebound(ge.Frictional(0.1, 0.1, 0.4), 0.05), closed, disks, gravity=1.0)
    run.run_until(10.0)
    assert closed.without_part("gate") == silo and len(run) == 200
    run.boundary = silo
    run.add_inlet(ge.Inlet.refill(((1, 30), (23, 32)), (0, -1), every=0.5, seed=1))
    flow = ge.Arrivals(["exit"], every=5.0)
    run.run_for(40.0, observe=flow)
    assert flow.results["rate"].mean > 1.0
    assert run.counters["removals"] - run.counters["insertions"] == 200 - len(run)


def test_a_drum_turns_its_grains():
    drum = ge.Container.around({"drum": ge.Part.drum((0, 0), 8).with_rotation((0, 0), 0.3)})
    disks = ge.scattered_mix(drum, ge.disks_from_radii([0.5] * 60, 1.0), 3.0, 1)
    run = ge.Simulation(ge.LeastRebound(ge.Frictional(0.1, 0.1, 0.5), 0.05), drum, disks, gravity=1.0)
    run.run_until(30.0)
    assert (np.hypot(*run.positions.T) < 7.51).all() and run.positions[:, 0].mean() > 0.2
    assert drum.walls_of("drum") and drum.lines(0.0)[-1].shape[1] == 2


def test_a_piston_falls():
    box = ge.Container.closed(20, 40, lid=ge.Piston(50.0, [-30.0, 30.0], force=1.0))
    run = ge.Simulation(ge.Elastic(), box, ge.with_maxwellian_velocities(ge.lattice(box, 100, 0.5), 1.0, 1))
    run.run_until(20.0)
    assert run.collisions > 100


def test_pegs_and_walls_by_name():
    board = ge.Container.closed(20, 20).with_pegs(ge.Disks([[5, 5], [15, 5]], 1.0))
    assert board.parts == ["peg 0", "peg 1"] == board.walls[-2:]
    disks = ge.with_maxwellian_velocities(ge.lattice(board, 50, 0.5), 1.0, 1)
    run, stress = ge.Simulation(ge.Elastic(), board, disks), ge.WallStress({"left": 20.0}, every=5.0)
    run.run_until(50.0, observe=stress)
    assert stress.table()
    with pytest.raises(ge.RunError, match="north"):
        run.run_for(1.0, observe=ge.Arrivals(["north"], every=1.0))


def test_crossings_are_those_of_a_gas_that_drifts():
    run, crossings = gas(), ge.Crossings(((10, 0), (10, 20)), every=5.0)
    run.run_until(500.0, observe=crossings)
    forward, backward, flux = (crossings.results[name].mean for name in ["forward_rate", "backward_rate", "flux"])
    drift, temperature = run.velocities[:, 0].mean(), run.velocities.var()
    assert 0.5 * (forward + backward) == pytest.approx(5.0 * math.sqrt(temperature / math.tau), rel=0.05)
    assert abs(flux) == pytest.approx(5.0 * abs(drift), rel=0.05) and forward - backward == pytest.approx(flux)


def test_files_are_read_and_converted(tmp_path):
    run, path = gas(), tmp_path / "run.xyz"
    run.run_until(3.0, observe=ge.Recorder(path, every=1.0))
    state = ge.read(path)
    assert state.disks == run.disks and state.time == 3.0 and len(ge.frames(path)) == 3
    assert ge.convert(path, tmp_path / "run.lammpstrj") == 3
    state.write(tmp_path / "last.csv")
    assert np.array_equal(ge.read(tmp_path / "last.csv").positions, run.positions)
    with pytest.raises(OSError):
        ge.Recorder(path, every=1.0)
    with pytest.raises(OSError):
        ge.read(tmp_path / "absent.xyz")


def test_kinetic_theory():
    gas = ge.Maxwellian(1.0)
    exact = ge.mean_energy_change(0.1, 0.1, 0.3, gas)
    drawn = ge.monte_carlo_energy_change(ge.Frictional(0.1, 0.1, 0.3), gas, 1, samples=200_000)
    assert abs(drawn.mean - exact) < 5 * drawn.error
    assert 0.0 < ge.sticking_fraction(0.1, 0.1, 0.3, gas) < 1.0
    mean = ge.block_average(np.random.default_rng(1).normal(size=4096))
    assert abs(mean.mean) < 5 * mean.error and mean.is_converged
    disks = ge.with_maxwellian_velocities(ge.disks_from_radii([0.5] * 500, 1.0), 1.0, 1)
    cooling = ge.DirectSimulation(ge.Smooth(0.1), disks, 0.1, 1)
    cooling.run_until(10.0)
    assert cooling.collisions > 0 and (cooling.velocities**2).sum() < (disks.velocities**2).sum()


def test_threads_run_side_by_side():
    def one(_):
        run = gas(ge.Smooth(restitution=0.9))
        run.run_until(50.0)
        return run

    with ThreadPoolExecutor(4) as pool:
        runs = list(pool.map(one, range(4)))
    assert all(same(runs[0], run) for run in runs)


def test_one_simulation_is_not_run_by_two_threads():
    run, errors = gas(count=300, side=30.0), []

    def go():
        try:
            run.run_until(1e9, max_seconds=0.3)
        except RuntimeError as error:
            errors.append(str(error))

    threads = [threading.Thread(target=go) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(errors) == 1 and "borrowed" in errors[0]
