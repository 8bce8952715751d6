"""Readings of a run, as columns."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Mapping

import numpy as np

from . import _core, shown
from .units import frame_of

if TYPE_CHECKING:
    import pandas


class Readings(Mapping):
    """The columns of readings.csv by their names, units in the names: ``readings["target_deg"]``.

    Arrays have one entry a reading: float64 with NaN where nothing was read, int64 of counts, lists of text. The
    same bits as in the file. They are copies: to change readings, use `with_columns`.
    """

    def __init__(self, core: _core.Readings):
        self._core = core
        self._columns = core.columns()

    @classmethod
    def read_csv(cls, path: str | os.PathLike, bench: str = "") -> Readings:
        """Reads readings.csv. `bench`: its name; left out, the one that the columns speak of."""
        with open(path, encoding="utf-8", newline="") as file:
            return cls(_core.Readings.from_csv_text(file.read(), os.fspath(path), bench))

    @classmethod
    def read_parquet(cls, path: str | os.PathLike) -> Readings:
        """Reads a file of `to_parquet`. Needs pyarrow."""
        from .parquet import read

        return cls.from_columns(*read(path))

    @classmethod
    def from_columns(cls, columns: Mapping[str, Any], bench: str) -> Readings:
        """From a dict of arrays, or a pandas frame, with the columns of readings.csv of that bench.

        Raises InputError that names the column and the reading where something is wrong.
        """
        lines = [",".join(columns)]
        lines += [",".join(map(_cell, row)) for row in zip(*(np.asarray(columns[name]).tolist() for name in columns))]
        return cls(_core.Readings.from_csv_text("\n".join(lines) + "\n", "columns", bench))

    @property
    def bench(self) -> str:
        return self._core.bench

    @property
    def count(self) -> int:
        """How many readings there are."""
        return len(self._core)

    def __getitem__(self, column: str) -> Any:
        return self._columns[column]

    def __iter__(self):
        return iter(self._columns)

    def __len__(self) -> int:
        """How many columns there are; of readings: `count`."""
        return len(self._columns)

    def with_columns(self, **columns: Any) -> Readings:
        """The same readings with other columns in place of these."""
        return Readings.from_columns({**self._columns, **columns}, self.bench)

    def frame(self) -> pandas.DataFrame:
        """All columns as a pandas frame, a row a reading; ``frame.attrs["units"]`` has their units."""
        return frame_of(self._columns)

    def to_csv(self, path: str | os.PathLike) -> None:
        """Writes readings.csv, as `twinbench export` does."""
        with open(path, "w", encoding="utf-8", newline="") as file:
            file.write(self._core.csv_text())

    def to_hdf5(self, path: str | os.PathLike) -> None:
        """Writes a NeXus file (NXroot/NXentry/NXdata): one dataset a column, its unit in the attribute `units`.

        Needs h5py. The file must not be there yet.
        """
        from .nexus import write

        write(self, path)

    def to_parquet(self, path: str | os.PathLike) -> None:
        """Writes a Parquet file: one column a column, its unit in the column's metadata `units`.

        Needs pyarrow; raises ModuleNotFoundError that says so where there is none. The file must not be there yet.
        """
        from .parquet import write

        write(self, path)

    def __repr__(self) -> str:
        return f"<twinbench.Readings of {self.bench}: {self.count} readings, {len(self)} columns>"

    def _repr_html_(self) -> str:
        return shown.text(f"{self.count} readings of {self.bench}") + shown.columns(self.items())


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return "" if np.isnan(value) else repr(value)
    return str(value)
