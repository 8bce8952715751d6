"""What else is made of a run: uncertainty, budget, compensation, certificate, page."""

from __future__ import annotations

import json
import os
import pathlib
import tempfile
from typing import Any, Mapping

from . import _core
from .run import Run, score, warn_of
from .scenario import Scenario
from .shown import Answer
from .values import plain, toml


class Uncertainty(Answer):
    """What `twinbench uncertainty --json` writes; ``summary`` is its table of sources."""


def uncertainty(run: Run, estimator: str = "rigorous", trials: int = 0, seed: int = 1, threads: int = 1) -> Uncertainty:
    """The uncertainty budget of a run's results, source by source (GUM; docs/uncertainty.md). u is a standard uncertainty, U = k u for 95 %.

    trials: at most so many of a Monte Carlo propagation as well (Supplement 1); 0: none. The same for any number of threads.
    Raises InputError if no result has an uncertainty, or none from the readings can be trusted.
    """
    warn_of(run)
    return Uncertainty(*_core.uncertainty(run.scenario._core, run.readings._core, estimator, trials, seed, threads))


class Budget(Answer):
    """What `twinbench budget --json` writes: the variance contribution of each source, switched off one at a time."""


def budget(scenario: Scenario | str | os.PathLike, of: str = "stability") -> Budget:
    """Simulates a scenario, and again twice for every source of its bench: alone, and without it.

    of: the place in results.json of the figures that are shared out, "stability.range"; each in the unit of its name.
    """
    return Budget(*_core.budget(Scenario.of(scenario)._core, of))


class Compensation(Answer):
    """What `twinbench compensate --json` writes; ``table`` is the text of the controller's table."""

    def __init__(self, made: dict[str, Any], summary: str, table: str):
        super().__init__(made, summary)
        self.table = table


def compensate(run: Run, form: str = "plain", axis: str = "C", points: int = 0, highest_order: int = 200) -> Compensation:
    """The corrections that a table's controller should add to take out its index error (docs/compensation.md).

    form: "plain", "linuxcnc", "twincat" or "heidenhain"; axis: what the controller calls it. points: entries a turn, 0: as the orders and
    the form need. highest_order: lines above it are taken not to exist.
    """
    warn_of(run)
    return Compensation(*_core.compensate(run.folder or "the run", run.scenario._core, run.readings._core, form, axis, points, highest_order))


class Certificate(Answer):
    """What was certified and what was left out; ``xml`` is the certificate."""

    xml = property(lambda self: self.summary)

    def _repr_html_(self) -> str:
        return Answer(self)._repr_html_()


def certificate(run: Run, laboratory: str | os.PathLike | Mapping[str, Any]) -> Certificate:
    """The results of a saved run as a digital calibration certificate (DCC 3.3.0; docs/certificate.md).

    laboratory: the TOML file that `twinbench certificate --template` writes, filled in, or a dict of the same. Digests of the run's files
    stand in it: raises InputError if the run is in no folder (`Run.save`).
    """
    folder = _folder_of(run)
    if folder is None:
        raise _core.InputError("certificate: the run is in no folder, or its scenario was changed since; expected a run after run.save(folder)")
    if isinstance(laboratory, Mapping):
        text, name = "\n".join(f"{key} = {toml(value)}" for key, value in laboratory.items()) + "\n", "laboratory"
    else:
        text, name = pathlib.Path(laboratory).read_text(encoding="utf-8"), os.fspath(laboratory)
    return Certificate(*_core.certificate(folder, text, name))


def report(source: Run | Answer | str | os.PathLike, path: str | os.PathLike) -> None:
    """Writes a page of plots and tables, one file that opens offline, as `twinbench report`: beside the truth where the run has one.

    source: a run; a Diagnosis, Plan or Investigation; or whatever `twinbench report` takes. A page that is there is replaced, no other file.
    """
    with tempfile.TemporaryDirectory() as scratch:
        scored = ""
        if isinstance(source, Run):
            if source.truth is not None:
                scored = _written(score(source), f"{scratch}/score.json")
            source = _folder_of(source) or _copy_of(source).save(f"{scratch}/run").folder
        elif isinstance(source, Answer):
            source = _written(source, f"{scratch}/{type(source).__name__.lower()}.json")
        _core.write_report(os.fspath(source), scored, os.fspath(path))


def _folder_of(run: Run) -> str | None:
    """Where it was saved as it is."""
    if run.folder is None or pathlib.Path(run.folder, "scenario.toml").read_text(encoding="utf-8") != run.scenario.toml():
        return None
    return run.folder


def _copy_of(run: Run) -> Run:
    return Run(run.scenario, run.readings, run.truth, run.readings_from)


def _written(answer: Answer, path: str) -> str:
    pathlib.Path(path).write_text(json.dumps(plain(dict(answer))), encoding="utf-8")
    return path
