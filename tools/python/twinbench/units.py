"""Units at the ends of names."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Mapping

if TYPE_CHECKING:
    import pandas

_UNITS = frozenset(
    "arcsec mrad urad rad deg pm nm um mm m uV mV V K mK degC mT px ms us s min h Hz kHz percent ppm mW".split())


def unit_of(name: str) -> str | None:
    """The unit at the end of a name: "time_s" is in s, "scale_x_um_m" in um/m, "drift_urad_per_h" in urad/h. None: it has none."""
    words = [word for word in name.split("_")[1:] if word != "per"]
    if not words or words[-1] not in _UNITS:
        return None
    return "/".join(words[-2:]) if len(words) > 1 and words[-2] in _UNITS else words[-1]


def frame_of(columns: Mapping[str, Any]) -> pandas.DataFrame:
    """A frame with the units of its columns in ``attrs["units"]``: {column: unit}."""
    import pandas

    frame = pandas.DataFrame(dict(columns))
    frame.attrs["units"] = {name: unit_of(name) for name in frame if unit_of(name)}
    return frame
