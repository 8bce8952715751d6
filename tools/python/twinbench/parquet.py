"""Readings as a Parquet file."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from . import _core
from .units import unit_of

if TYPE_CHECKING:
    from .readings import Readings


def _pyarrow() -> Any:
    try:
        import pyarrow.parquet
    except ModuleNotFoundError as missing:
        raise ModuleNotFoundError(
            "Parquet needs pyarrow, which this Python does not have; expected one with it (pip install pyarrow: Debian 12 has no package), "
            "or to_hdf5 or to_csv", name="pyarrow") from missing
    return pyarrow


def write(readings: Readings, path: str | os.PathLike) -> None:
    """One column a column, to the bit: float64 with NaN, int64, text. Its unit is its metadata "units"; bench and program that of the file."""
    pa = _pyarrow()
    arrays = [pa.array(column) for column in readings.values()]
    fields = [
        pa.field(name, array.type, metadata={"units": unit_of(name)} if unit_of(name) else None)
        for name, array in zip(readings, arrays)
    ]
    about = {"twinbench.bench": readings.bench, "twinbench.version": _core.__version__}
    with open(path, "xb") as file:
        pa.parquet.write_table(pa.Table.from_arrays(arrays, schema=pa.schema(fields, metadata=about)), file)


def read(path: str | os.PathLike) -> tuple[dict[str, Any], str]:
    """Columns of a file of `write`, and its bench."""
    pa = _pyarrow()
    table = pa.parquet.read_table(os.fspath(path))
    bench = (table.schema.metadata or {}).get(b"twinbench.bench")
    if bench is None:
        raise _core.InputError(f"{os.fspath(path)}: the file does not say which bench its readings are of; expected one of to_parquet")
    return {name: table.column(name).to_pylist() for name in table.column_names}, bench.decode()
