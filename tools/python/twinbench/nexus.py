"""Readings as a NeXus file (HDF5)."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from . import _core
from .units import unit_of

if TYPE_CHECKING:
    from .readings import Readings


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
