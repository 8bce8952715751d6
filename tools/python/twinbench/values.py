"""Values of Python as TOML and JSON have them."""

import json
import math
from typing import Any


def plain(value: Any) -> Any:
    """The same without numpy: lists for arrays, None for NaN."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, float) and math.isnan(value):
        return None
    return value


def toml(value: Any) -> str:
    """A number, text, truth value, list or table as TOML writes it in one line.

    Raises TypeError for anything else, and for NaN and infinity, which no key of a scenario may be.
    """
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int) or (isinstance(value, float) and math.isfinite(value)):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml(item) for item in value) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {toml(item)}" for key, item in value.items()) + "}"
    raise TypeError(f"{value!r} cannot stand in a scenario; expected a finite number, text, truth value, list or dict")
