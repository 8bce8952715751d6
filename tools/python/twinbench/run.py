"""Runs and what is made of their readings."""

from __future__ import annotations

import os
import pathlib
import warnings
from functools import cached_property
from typing import TYPE_CHECKING, Any, Iterable, Mapping

import numpy as np

from . import _core, shown
from .readings import Readings
from .scenario import Scenario, overrides
from .units import frame_of

if TYPE_CHECKING:
    import pandas


class Run:
    """A scenario and its readings.

    truth: what was injected (truth.json); None where nobody knows. readings_from: what the record says of them, "twin",
    "python", "import: file". folder: where `save` has put it; None: nowhere. story: how a recording was understood.
    """

    def __init__(self, scenario: Scenario, readings: Readings, truth: dict[str, Any] | None = None, readings_from: str = "python"):
        self.scenario = scenario
        self.readings = readings
        self.truth = truth
        self.readings_from = readings_from
        self.folder: str | None = None
        self.story = ""

    @classmethod
    def open(cls, folder: str | os.PathLike) -> Run:
        """A run's folder, with its truth where there is one."""
        opened = load(folder)
        opened.truth = _core.truth_of(opened.folder)
        return opened

    def save(self, folder: str | os.PathLike) -> Run:
        """Writes the folder that `twinbench run -o` or `import -o` leaves: scenario, record, results, tables and the truth, if it is known.

        The record has the readings, not the raw samples and device calls behind them. Raises InputError if the folder holds a run.
        """
        folder = os.fspath(folder)
        _core.save_run(folder, self.readings_from, self.scenario._core, self.readings._core, self.truth)
        if self.story:
            pathlib.Path(folder, "import.txt").write_text(self.story, encoding="utf-8")
        self.folder = folder
        return self

    @cached_property
    def _evaluated(self) -> shown.Results:
        return shown.Results(*_core.evaluate(self.scenario._core, self.readings._core))

    @property
    def results(self) -> shown.Results:
        """results.json: lists of numbers are arrays, units at the ends of names. Evaluated when it is asked for first."""
        return self._evaluated

    @property
    def summary(self) -> str:
        """What `twinbench run` prints of the results."""
        return self._evaluated.summary

    def __repr__(self) -> str:
        return f"<twinbench.Run {self.scenario.bench}: {self.scenario.title!r}, {self.readings.count} readings>"

    def _repr_html_(self) -> str:
        ok = sum(status == "ok" for status in self.readings["status"])
        about = f"{self.scenario.title}\n{self.scenario.bench}, seed {self.scenario.seed}: {self.readings.count} readings, {ok} ok"
        return shown.text(f"{about}\n\n{self.summary}" if "_evaluated" in vars(self) else about)


def run(scenario: Scenario | str | os.PathLike) -> Run:
    """Simulates a scenario, or that of a TOML file, in memory. Same seed, same bits."""
    scenario = Scenario.of(scenario)
    readings, truth = _core.run_twin(scenario._core)
    return Run(scenario, Readings(readings), truth, "twin")


def load(source: str | os.PathLike, scenario: str | os.PathLike = "") -> Run:
    """A run's folder, or a readings.csv with its scenario. The truth is not opened (`Run.open` does)."""
    loaded, readings, readings_from = _core.load_run(os.fspath(source), os.fspath(scenario))
    opened = Run(Scenario._of(loaded), Readings(readings), None, readings_from)
    opened.folder = os.fspath(source) if os.path.isdir(source) else None
    return opened


def import_recording(
    files: str | os.PathLike | Iterable[str | os.PathLike],
    map: str | os.PathLike = "",
    scenario: str | os.PathLike = "",
    columns: Mapping[str, str] | None = None,
    changes: Mapping[str, Any] | None = None,
    most_readings: int = 0,
) -> Run:
    """Imports a recording: readings.csv, or files of any layout, as `twinbench import` does (docs/import.md).

    map: a ready map ("iso230") or a TOML file that says what the files do not. scenario: the bench's TOML file; left out: its usual one.
    columns: {"reference_deg": "Axis 1.ActPos"}. changes: keys of the scenario. most_readings: longer recordings are averaged in blocks, 0:
    none. ``run.story`` says how the files were understood; what speaks against the readings is a warning, and InputError if no result of
    theirs can be trusted.
    """
    paths = [files] if isinstance(files, (str, os.PathLike)) else list(files)
    loaded, readings, story = _core.import_recording(
        [os.fspath(path) for path in paths], os.fspath(scenario), os.fspath(map), overrides(changes or {}),
        [f"{name}={column}" for name, column in (columns or {}).items()], most_readings)
    imported = Run(Scenario._of(loaded), Readings(readings), None, f"import: {os.fspath(paths[0])}")
    imported.story = story
    warn_of(imported)
    return imported


def warn_of(run: Run) -> None:
    """What speaks against the readings, as warnings. Raises InputError if no result from them can be trusted."""
    for line in _core.doubts(run.scenario._core, run.readings._core):
        warnings.warn(line, stacklevel=3)


def drive(bench: Any, scenario: Scenario) -> Run:
    """Runs a scenario's procedure on a bench of one's own: a RotaryBench, a MachineBench or an AngleBench.

    Raises BenchError with what the bench raised. A lost reading has its status; a failing device is tried again as
    on real hardware.
    """
    return Run(scenario, Readings(_core.drive(bench, scenario._core)))


def _parts(source: Run | Scenario, readings: Readings | None) -> tuple[_core.Scenario, _core.Readings]:
    """Of a run its own, where nothing else is stated."""
    if isinstance(source, Run):
        source, readings = source.scenario, readings or source.readings
    if readings is None:
        raise TypeError("a Run, or a Scenario and Readings")
    return source._core, readings._core


def separate(scenario: Run | Scenario, readings: Readings | None = None, estimator: str = "rigorous") -> shown.Answer:
    """separation.json: the errors of what was measured and of what it was measured with, arrays by position.

    estimator: "rigorous" (weighted least squares, exact model), or "published" for the paper's equations. Raises InputError if the
    readings show no errors.
    """
    return shown.Answer(_core.separate(*_parts(scenario, readings), estimator))


def score(run: Run, estimator: str = "rigorous") -> shown.Answer:
    """A simulated run against its truth, as `twinbench score --json`."""
    if run.truth is None:
        raise _core.InputError("score: this run has no truth; expected a run of the twin")
    return shown.Answer(_core.score(run.scenario._core, run.readings._core, run.truth, estimator))


class Diagnosis(shown.Answer):
    """diagnosis.json, and `extended`: the scenario with the causes that were identified."""

    def __init__(self, found: dict[str, Any], extended_toml: str):
        super().__init__(found)
        self._extended_toml = extended_toml

    def __repr__(self) -> str:
        causes = ", ".join(dict.fromkeys(cause["effect"] for cause in self["causes"][:4]))
        return f"<twinbench.Diagnosis: {self['verdict']}{': ' if causes else ''}{causes}>"

    @property
    def extended(self) -> Scenario:
        return Scenario.from_toml(self._extended_toml)


def diagnose(
    scenario: Run | Scenario,
    readings: Readings | None = None,
    model: str = "rigorous",
    exclude: Iterable[str] = (),
    cache_folder: str | os.PathLike = "",
) -> Diagnosis:
    """Identifies the causes by which the readings of a run differ from the scenario, its own or another.

    exclude: effects left out of the catalogue. cache_folder: where calibrations of thresholds are kept; "" keeps none.
    """
    found = _core.diagnose(*_parts(scenario, readings), model, list(exclude), os.fspath(cache_folder))
    return Diagnosis(*found)


class Follow:
    """The twin on the path of a record: what each reading should have shown, without noise.

    Channels are in the bench's own order. Points are the scalar inputs at which a disturbance can enter
    ("laser.yaw", "target.ez"); disturbances are arrays of one value a reading, in SI.
    """

    def __init__(self, scenario: Run | Scenario, readings: Readings | None = None):
        self._core = _core.follow(*_parts(scenario, readings))

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

    ``frame(run.results["separation"]["target"])`` has a row a position; ``frame.attrs["units"]`` has the units of its columns.
    """
    arrays = {name: value for name, value in section.items() if isinstance(value, np.ndarray) and value.ndim == 1}
    if not arrays:
        raise _core.InputError("frame: there are no arrays in it; expected a part of the results with some")
    lengths = [len(value) for value in arrays.values()]
    rows = max(set(lengths), key=lengths.count)
    return frame_of({name: value for name, value in arrays.items() if len(value) == rows})
