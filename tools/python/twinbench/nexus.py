"""Readings as a NeXus file (HDF5)."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from . import _core

if TYPE_CHECKING:
    from .readings import Readings

_UNITS = ("arcsec", "degC", "deg", "rad", "mm", "um", "nm", "V", "s", "K", "mT", "percent")


def unit_of(column: str) -> str | None:
    """The unit at the end of a column's name: "time_s" is in s. None: it has none."""
    ending = column.rsplit("_", 1)[-1]
    return ending if "_" in column and ending in _UNITS else None


def write(readings: Readings, path: str | os.PathLike) -> None:
    """One NXentry with one NXdata, whose axis is the reading. See https://manual.nexusformat.org/."""
    import h5py

    with h5py.File(path, "x") as file:
        file.attrs["NX_class"] = "NXroot"
        file.attrs["default"] = "readings"
        entry = file.create_group("readings")
        entry.attrs["NX_class"] = "NXentry"
        entry.attrs["default"] = "data"
        entry["title"] = f"readings of the bench {readings.bench}"
        entry["program_name"] = "twinbench"
        entry["program_name"].attrs["version"] = _core.__version__
        data = entry.create_group("data")
        data.attrs["NX_class"] = "NXdata"
        data.attrs["axes"] = ["reading"]
        for name, column in readings.items():
            dataset = data.create_dataset(name, data=column)
            if unit := unit_of(name):
                dataset.attrs["units"] = unit
