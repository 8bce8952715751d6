"""What a schema says that a key may be, as cases: (key, value as TOML, kind). Kind "in" is allowed, "out" must be refused, "any" may be either."""

import json
import math

TINY = 1e-300
SMALLEST = 5e-324


def keys_of(table, path=()):
    """Every key of a bench's schema with what is said of it."""
    if "properties" not in table:
        return [(".".join(path), table)]
    return [found for name, inner in table["properties"].items() for found in keys_of(inner, (*path, name))]


def bounds_of(number):
    """The first and the last value that are allowed."""
    is_whole = number["type"] == "integer"
    low, high = number.get("minimum", -math.inf), number.get("maximum", math.inf)
    if "exclusiveMinimum" in number:
        above = number["exclusiveMinimum"]
        low = above + 1 if is_whole else math.nextafter(above, math.inf)
    if "exclusiveMaximum" in number:
        below = number["exclusiveMaximum"]
        high = below - 1 if is_whole else math.nextafter(below, -math.inf)
    return low, high


def text_of(number, is_whole):
    return str(int(number)) if is_whole else repr(float(number))


def numbers_within(number):
    is_whole, (low, high) = number["type"] == "integer", bounds_of(number)
    wanted = [low, high, 0.0, TINY, -TINY, 1e-9, 1e300, -1e300, low + 1.0, low + 2.0, 1e3]
    if high > 0.0:
        wanted += [math.sqrt(max(low, 1e-6)) * math.sqrt(min(high, 1e12)), 0.3 * high]
    if is_whole:
        wanted = [math.floor(x) for x in wanted if math.isfinite(x) and (x == 0.0 or abs(x) >= 1.0)]
    else:
        wanted = [x for x in wanted if x not in (low + 1.0, low + 2.0, 1e3)] + [low, high]
    return list(dict.fromkeys(text_of(x, is_whole) for x in wanted if low <= x <= high and math.isfinite(x)))


def numbers_beyond(number):
    is_whole, (low, high) = number["type"] == "integer", bounds_of(number)
    values = ["nan", "inf", "-inf"] + (["1.5"] if is_whole else [])
    if math.isfinite(low):
        values.append(text_of(low - 1 if is_whole else math.nextafter(low, -math.inf), is_whole))
    if math.isfinite(high):
        values.append(text_of(high + 1 if is_whole else math.nextafter(high, math.inf), is_whole))
    return values


def values_of(what):
    """(value, kind) of one key; what has no type of its own here (content of files) has none."""
    kind = what.get("type")
    if "enum" in what:
        return [(json.dumps(one), "in") for one in what["enum"]] + [('"neither"', "out"), ("7", "out")]
    if kind in ("number", "integer"):
        return [(v, "in") for v in numbers_within(what)] + [(v, "out") for v in [*numbers_beyond(what), '"1"', "true"]]
    if kind == "boolean":
        return [("true", "in"), ("false", "in"), ("1", "out"), ('"yes"', "out")]
    if kind == "string":
        return [(v, "any") for v in ('""', '"/dev/null"', '"/"', '"/nowhere/none"')] + [("1", "out")]
    if kind == "array":
        return arrays_of(what)
    return []


def arrays_of(what):
    of, count = what["items"], what.get("minItems")
    if of.get("type") == "object":
        inner = [(name, v, kind) for name, one in of.get("properties", {}).items() for v, kind in values_of(one)]
        return [(f"[{{{name} = {v}}}]", kind) for name, v, kind in inner]
    lengths = [count] if count else [1, 3]
    cases = [("[" + ", ".join([v] * n) + "]", kind) for v, kind in values_of(of) for n in lengths]
    if count:
        first = values_of(of)[0][0]
        return [*cases, ("[" + ", ".join([first] * (count + 1)) + "]", "out"), ("[]", "out")]
    return [*cases, ("[]", "any")]


def cases_of(schema, bench):
    """Every case of every key of a bench."""
    (table,) = [one for one in schema["oneOf"] if one["properties"]["bench"]["const"] == bench]
    return [(key, value, kind) for key, what in keys_of(table) for value, kind in values_of(what)]
