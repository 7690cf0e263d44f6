"""The paper's vibrated box by its parameters, and studies of it: plans as dictionaries, tables as dictionaries of arrays."""

import csv
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._granular_edmd import Simulation, _run_study, _vibrated_box

Tables = dict[str, dict[str, NDArray[Any]]]


def vibrated_box(*, seed: int = 0, **parameters: Any) -> Simulation:
    """Returns the paper's box with these parameters, the fields of `experiment` in a plan.

    `vibrated_box(disks=100, width=20, height=50, gravity=0.0156, friction=0.03, base=BiParabolic(0.1, 10.0))`
    """
    return _vibrated_box(_plain(parameters), seed)


def run_study(
    plan: Mapping[str, Any] | str, out: str | os.PathLike[str], *, progress: Callable[[int, int], object] | None = None
) -> Tables:
    """Runs the study of a plan in the folder `out`, on all cores, and returns its tables.

    The plan is a dictionary with the fields of the plan's file, or the text of such a file. What the folder has already is not run
    again; Ctrl-C saves all work. `progress` is a function of the finished steps and of all steps.
    """
    _run_study(plan if isinstance(plan, str) else _plain(plan), out, progress)
    return read_tables(out)


def read_tables(folder: str | os.PathLike[str]) -> Tables:
    """Returns the tables of a study by their names: columns of numbers (nan where a value is missing), or of text."""
    return {path.stem: _columns(path) for path in sorted(Path(folder).glob("*.csv"))}


def _columns(path: Path) -> dict[str, NDArray[Any]]:
    with path.open(newline="", encoding="utf-8") as file:
        names, *rows = csv.reader(file)
    return {name: _array([row[index] for row in rows]) for index, name in enumerate(names)}


def _array(cells: list[str]) -> NDArray[Any]:
    try:
        return np.array([float(cell or "nan") for cell in cells])
    except ValueError:
        return np.array(cells)


def _plain(value: Any) -> Any:
    """Returns a plan in which parts, such as `BiParabolic(0.1, 10.0)`, are dictionaries."""
    if hasattr(value, "to_dict"):
        return value.to_dict()
    if isinstance(value, Mapping):
        return {name: _plain(part) for name, part in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(part) for part in value]
    return value.item() if isinstance(value, np.generic) else value
