"""Runs and what is made of their readings."""

from __future__ import annotations

import os
from functools import cached_property
from typing import TYPE_CHECKING, Any, Iterable, Mapping

import numpy as np

from . import _core
from .readings import Readings
from .scenario import Scenario

if TYPE_CHECKING:
    import pandas


class Run:
    """A scenario and its readings."""

    def __init__(self, scenario: Scenario, readings: Readings, truth: dict[str, Any] | None = None):
        self.scenario = scenario
        self.readings = readings
        self.truth = truth  # what was injected (truth.json); None where nobody knows

    @cached_property
    def results(self) -> dict[str, Any]:
        """results.json: lists of numbers are arrays."""
        return _core.evaluate(self.scenario._core, self.readings._core)

    def __repr__(self) -> str:
        return f"<twinbench.Run of {self.scenario!r}: {self.readings.count} readings>"


def run(scenario: Scenario) -> Run:
    """Carries a scenario out on the twin, in memory. Same seed, same bits."""
    readings, truth = _core.run_twin(scenario._core)
    return Run(scenario, Readings(readings), truth)


def load(source: str | os.PathLike, scenario: str | os.PathLike = "") -> Run:
    """A run's folder, or a readings.csv with its scenario. The truth is not opened."""
    loaded, readings = _core.load_run(os.fspath(source), os.fspath(scenario))
    return Run(Scenario._of(loaded), Readings(readings))


def drive(bench: Any, scenario: Scenario) -> Run:
    """Carries a scenario's procedure out on a bench of one's own: a RotaryBench, a MachineBench or an AngleBench.

    Raises BenchError with what the bench raised. A lost reading has its status; a failing device is tried again as
    on real hardware.
    """
    return Run(scenario, Readings(_core.drive(bench, scenario._core)))


def separate(scenario: Scenario, readings: Readings, estimator: str = "rigorous") -> dict[str, Any]:
    """separation.json: the errors of what was measured and of what it was measured with.

    estimator: "rigorous", or "published" for the paper's own equations. Raises InputError if the readings show no errors.
    """
    return _core.separate(scenario._core, readings._core, estimator)


def score(run: Run, estimator: str = "rigorous") -> dict[str, Any]:
    """A run of the twin against its truth, as `twinbench score --json`."""
    if run.truth is None:
        raise _core.InputError("score: this run has no truth; expected a run of the twin")
    return _core.score(run.scenario._core, run.readings._core, run.truth, estimator)


class Diagnosis(dict):
    """diagnosis.json as a dict, and `extended`: the scenario with the causes that were found."""

    def __init__(self, found: dict[str, Any], extended_toml: str):
        super().__init__(found)
        self._extended_toml = extended_toml

    @property
    def extended(self) -> Scenario:
        return Scenario.from_toml(self._extended_toml)


def diagnose(
    scenario: Scenario,
    readings: Readings,
    model: str = "rigorous",
    strike: Iterable[str] = (),
    cache_folder: str | os.PathLike = "",
) -> Diagnosis:
    """What the scenario gets wrong about the readings, and what causes it.

    strike: effects taken out of the catalogue. cache_folder: where calibrations of thresholds are kept; "" keeps none.
    """
    found = _core.diagnose(scenario._core, readings._core, model, list(strike), os.fspath(cache_folder))
    return Diagnosis(*found)


class Follow:
    """The twin on the course of a record: what each reading should have shown, without noise.

    Channels are in the bench's own order. Points are the scalar inputs at which a disturbance can enter
    ("laser.yaw", "target.ez"); disturbances are arrays of one value a reading, in SI.
    """

    def __init__(self, scenario: Scenario, readings: Readings):
        self._core = _core.follow(scenario._core, readings._core)

    @property
    def points(self) -> dict[str, str]:
        """The points and the unit in which reports give them."""
        return {name: unit for name, unit, _ in self._core.points()}

    @property
    def unfixed(self) -> list[str]:
        """What the record does not fix and what was taken instead."""
        return self._core.unfixed()

    def predict(self, disturbances: Mapping[str, np.ndarray] | None = None) -> np.ndarray:
        """Readings x channels, SI; NaN where nothing would be shown."""
        return self._core.predict(dict(disturbances or {}))

    def slope(self, point: str, disturbances: Mapping[str, np.ndarray] | None = None) -> np.ndarray:
        """d reading / d point, readings x channels, SI, about the disturbances."""
        return self._core.slope(point, dict(disturbances or {}))


def frame(section: Mapping[str, Any]) -> pandas.DataFrame:
    """A pandas frame of those entries of a part of the results that are arrays of its most frequent length.

    ``frame(run.results["separation"]["target"])`` has a row a position.
    """
    import pandas

    arrays = {name: value for name, value in section.items() if isinstance(value, np.ndarray) and value.ndim == 1}
    if not arrays:
        raise _core.InputError("frame: there are no arrays in it; expected a part of the results with some")
    lengths = [len(value) for value in arrays.values()]
    rows = max(set(lengths), key=lengths.count)
    return pandas.DataFrame({name: value for name, value in arrays.items() if len(value) == rows})
