"""Scenarios: one measurement on one bench."""

from __future__ import annotations

import html
import os
import pathlib
import tomllib
from typing import Any, Mapping

from . import _core, shown
from .values import toml

SCENARIOS = pathlib.Path(__file__).with_name("scenarios")  # those that come with the package


class Scenario:
    """A scenario file, with keys as in the file: ``s["laser.wavelength_nm"] = 633.0``.

    Numbers are in the unit of the key's name. A wrong key or value raises InputError with what was expected;
    the scenario stays as it was.
    """

    def __init__(self, path: str | os.PathLike, changes: dict[str, Any] | None = None):
        """Reads a TOML file.

        changes: keys and values that take the place of those in the file, e.g. {"procedure.positions": 12}.
        """
        self._core = _core.Scenario.load(os.fspath(path), overrides(changes or {}))

    @classmethod
    def from_toml(cls, text: str, folder: str | os.PathLike = ".") -> Scenario:
        """From the text of a scenario; files that it names are sought from `folder`."""
        return cls._of(_core.Scenario.parse(text, "scenario", os.fspath(folder)))

    @classmethod
    def of(cls, scenario: Scenario | str | os.PathLike) -> Scenario:
        """The scenario itself, or that of a file."""
        return scenario if isinstance(scenario, Scenario) else cls(scenario)

    @classmethod
    def _of(cls, core: _core.Scenario) -> Scenario:
        scenario = cls.__new__(cls)
        scenario._core = core
        return scenario

    @property
    def bench(self) -> str:
        return self._core.bench

    @property
    def title(self) -> str:
        return self._core.title

    @property
    def seed(self) -> int:
        return self._core.seed

    def __getitem__(self, key: str) -> Any:
        """The value of a key, or a whole table as a dict: ``s["laser"]``."""
        value: Any = self.to_dict()
        for part in key.split("."):
            if not isinstance(value, dict) or part not in value:
                raise KeyError(key)
            value = value[part]
        return value

    def __setitem__(self, key: str, value: Any) -> None:
        self._core = self._core.altered(overrides({key: value}))

    def changed(self, changes: dict[str, Any]) -> Scenario:
        """Another scenario, with other values of these keys."""
        return Scenario._of(self._core.altered(overrides(changes)))

    def to_dict(self) -> dict[str, Any]:
        """Every key of the scenario, with its default where the file says nothing."""
        return tomllib.loads(self.toml())

    def toml(self) -> str:
        """The whole scenario as a file; it stands alone and reads back to the same bits."""
        return self._core.toml()

    def __repr__(self) -> str:
        return f"<twinbench.Scenario {self.bench}: {self.title!r}, seed {self.seed}>"

    def _repr_html_(self) -> str:
        return f"<details><summary>{html.escape(repr(self)[1:-1])}</summary>{shown.text(self.toml())}</details>"


def overrides(changes: Mapping[str, Any]) -> list[str]:
    """Changes as the command line's ``--set`` has them."""
    return [f"{key}={toml(value)}" for key, value in changes.items()]
