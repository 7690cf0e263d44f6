"""The programs in the documentation run as they stand, and studies in this process have the tables of the command."""

import doctest
import re
import signal
import threading
from pathlib import Path

import numpy as np
import pytest

import granular_edmd as ge

ROOT = Path(__file__).parents[2]
PLAN = {
    "seed": 1,
    "experiment": {
        "disks": 30, "width": 10, "height": 30, "gravity": 0.0156, "contact_duration": 1e-4,
        "base": ge.BiParabolic(0.1, 10.0),
    },
    "protocol": {"settle": 10, "samples": 4, "every": 5},
    "sweep": [{"parameter": "friction", "values": np.array([0.01, 0.02])}],
}


@pytest.mark.parametrize("page", ["README.md", "python/README.md", "docs/guide/from_python.md"])
def test_the_programs_of_a_page_run(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```python\n(.*?)^```$", (ROOT / page).read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    names = {}
    for block in blocks:
        exec(block, names)
    assert blocks and " ± " in capsys.readouterr().out


def test_the_examples_of_the_module_hold():
    assert doctest.testmod(ge).attempted > 4 and doctest.testmod(ge).failed == 0


def test_the_first_program():
    import math, numpy as np, granular_edmd as ge
    box = ge.Container.closed(60, 150, floor=ge.BiParabolic(0.1, 10.0))
    rule = ge.ContactDuration(ge.Frictional(0.0, 0.0, 0.03), 1e-4)
    disks = ge.with_maxwellian_velocities(ge.lattice(box, 1000, 0.5), 0.5, 1)
    sim = ge.Simulation(rule, box, disks, gravity=0.015625, seed=1)
    period = math.tau / 10
    series = ge.Series(ge.OrderParameters(), every=9.9 * period)
    sim.run_until(300 * period, observe=series)
    assert sim.positions.shape == (1000, 2) and sim.spins.shape == (1000,)
    assert all(len(getattr(sim, name)) == 1000 for name in ["velocities", "angles", "radii", "masses", "kinds"])
    assert len(series.table()["time"]) == 30 and series.mean("one_roll").error > 0
    assert sim.time == 300 * period and sim.collisions > 1000


def test_the_vibrated_box_is_the_composed_one():
    box = ge.Container.closed(60, 150, floor=ge.BiParabolic(0.1, 10.0))
    rule = ge.ContactDuration(ge.Frictional(0.0, 0.0, 0.03), 1e-4)
    disks = ge.with_maxwellian_velocities(ge.lattice(box, 1000, 0.5), 0.5, 7)
    composed = ge.Simulation(rule, box, disks, gravity=0.015625, seed=7)
    named = ge.vibrated_box(
        disks=1000, width=60, height=150, gravity=0.015625, friction=0.03, contact_duration=1e-4,
        initial_temperature=0.5, base=ge.BiParabolic(0.1, 10.0), seed=7,
    )
    for run in [composed, named]:
        run.run_until(20.0)
    assert np.array_equal(composed.positions, named.positions)
    with pytest.raises(ge.ParameterError, match="frictoin"):
        ge.vibrated_box(frictoin=0.1, disks=10, width=5, base=ge.BiParabolic(0.1, 10.0))


def test_a_study_is_run_and_read(tmp_path):
    steps = []
    tables = ge.run_study(PLAN, tmp_path / "study", progress=lambda done, total: steps.append((done, total)))
    assert list(tables["points"]["friction"]) == [0.01, 0.02] and len(tables["samples"]["friction"]) == 8
    assert (tables["points"]["center_of_mass_height_error"] > 0).all() and tables["values"]["state"].dtype.kind == "U"
    assert steps[-1][0] == steps[-1][1]
    again = ge.run_study(PLAN, tmp_path / "study")
    np.testing.assert_equal(again, tables)
    with pytest.raises(ge.FileError, match="another plan"):
        ge.run_study({**PLAN, "seed": 2}, tmp_path / "study")
    with pytest.raises(ge.ParameterError, match="sede"):
        ge.run_study({**PLAN, "sede": 2}, tmp_path / "other")


def test_a_study_is_interrupted_and_continued(tmp_path):
    long = {**PLAN, "protocol": {"settle": 10, "samples": 1_000_000, "every": 5}}
    timer = threading.Timer(0.5, lambda: signal.raise_signal(signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        ge.run_study(long, tmp_path / "study")
    with pytest.raises(ZeroDivisionError):
        ge.run_study(long, tmp_path / "study", progress=lambda *_: 1 / 0)
