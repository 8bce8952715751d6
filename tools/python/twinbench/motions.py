"""Error motions of an axis of rotation that were read by an instrument of one's own."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core


def error_motion(angle_deg: npt.ArrayLike, turns: npt.ArrayLike, axial: bool = False) -> dict[str, Any]:
    """Figures of ISO 230-7 of one sensitive direction: ``{"synchronous": {"value", "u", "bias"}, ...}`` in the unit of `turns`.

    angle_deg: n angles, spread over whole turns. turns: what each turn shows there, turns x n; one row will do, but shows no asynchronous
    motion. Radial motion and tilt are drawn about the centre of the least-squares circle: once a turn is where the artefact stands. With
    `axial` the plot is about the chart's own centre, and "fundamental" (once a turn) and "residual" (without it) are there as well.

    u: standard uncertainty by the scatter of the turns; bias: about what that adds to the value, not taken off. None of one turn (NaN).
    Raises InputError if shapes do not fit or anything is not finite.
    """
    return _core.error_motion(np.radians(np.asarray(angle_deg, dtype=float)), np.atleast_2d(np.asarray(turns, dtype=float)), axial)
