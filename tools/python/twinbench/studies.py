"""What is made of many runs: plans, campaigns, investigations."""

from __future__ import annotations

import io
import os
from typing import TYPE_CHECKING, Any, Callable

from . import _core
from .readings import Readings
from .scenario import Scenario
from .shown import Answer, text
from .units import frame_of

if TYPE_CHECKING:
    import pandas


class Plan(Answer):
    """What `twinbench plan --json` writes, and `next`: scenarios of the runs to be made next, in their order."""

    def __init__(self, made: dict[str, Any], following: list[_core.Scenario]):
        super().__init__(made)
        self.next = [Scenario._of(core) for core in following]


def plan(scenario: Scenario | str | os.PathLike, setups: int = 0, minutes: float = 0.0, readings: float = 0.0, goal: str = "") -> Plan:
    """What a run would give, what it would not see, and which run would give more for its time.

    setups: how many there may be, 0: as many as the scenario has. minutes or readings: budget for further runs, not both.
    goal: the result that counts ("target.ez"), "": all. Raises InputError as the command does.
    """
    if minutes and readings:
        raise _core.InputError("plan: there are two budgets; expected minutes or readings")
    return Plan(*_core.plan(Scenario.of(scenario)._core, setups, minutes, readings, goal))


class Campaign:
    """The table of a campaign: `csv` is what `twinbench campaign --csv` writes, `summary` what it prints, `results` what `--json` has."""

    def __init__(self, table: str, csv: str, summary: str, results: dict[str, Any]):
        self.table = table  # the SQLite file
        self.csv = csv
        self.summary = summary
        self.results = results

    def __repr__(self) -> str:
        return f"<twinbench.Campaign {self.table}: {self.results['trials']} trials>"

    def _repr_html_(self) -> str:
        return text(self.summary)

    def frame(self) -> pandas.DataFrame:
        """A pandas frame with a row a trial, from the text of `csv`; units in ``frame.attrs["units"]``."""
        import pandas

        return frame_of(pandas.read_csv(io.StringIO(self.csv), comment="#", float_precision="round_trip"))


def campaign(study: str | os.PathLike, table: str | os.PathLike, threads: int = 1, resume: bool = False) -> Campaign:
    """Runs a study file (docs/campaign.md) into a SQLite table, which is made. Whatever `threads` is, the numbers are the same.

    resume: go on with a table; trials that are in it are not done again. Raises InputError if the table is there without it.
    """
    table = os.fspath(table)
    return Campaign(table, *_core.campaign(os.fspath(study), table, threads, resume))


class Investigation(Answer):
    """investigation.json, and `extended`: the scenario with the causes that were identified."""

    def __init__(self, found: dict[str, Any], extended: _core.Scenario):
        super().__init__(found)
        self.extended = Scenario._of(extended)


def investigate(
    scenario: Scenario,
    bench: Scenario | Callable[[Scenario], Readings],
    goal: str = "",
    budget_min: float = 120.0,
    conclusive: float = 0.95,
    most_runs: int = 20,
    cache_folder: str | os.PathLike = "",
) -> Investigation:
    """Measures, diagnoses and chooses the run that gives most information per minute, until the causes are resolved.

    scenario: what is believed. bench: a scenario with something hidden, whose twin is measured; or a function that runs the
    scenario that it is given and returns its readings, ``lambda asked: tb.drive(my_bench, asked).readings``. Of a function only runs are asked
    that nobody has to change the bench or its surroundings for. goal: "target.ez 0.1arcsec". budget_min: of the procedures' own clocks.
    cache_folder: where calibrations of thresholds are kept; "" keeps none.
    """
    hidden = bench._core if isinstance(bench, Scenario) else None
    if hidden is None and not callable(bench):
        raise TypeError("bench is neither a Scenario nor a function from a Scenario to Readings")

    def measure(asked: _core.Scenario) -> _core.Readings:
        return bench(Scenario._of(asked))._core

    function = None if hidden else measure
    cache = os.fspath(cache_folder)
    return Investigation(
        *_core.investigate(scenario._core, hidden, function, goal, budget_min, conclusive, most_runs, cache)
    )
