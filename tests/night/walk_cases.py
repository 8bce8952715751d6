"""What a schema says that a key may be, as cases: (key, value as TOML, kind). Kind "in" is allowed, "out" must be refused, "any" may be either."""

import json
import math


def keys_of(table, path=()):
    """Every key of a bench's schema with what is said of it."""
    if "properties" not in table:
        return [(".".join(path), table)]
    return [found for name, inner in table["properties"].items() for found in keys_of(inner, (*path, name))]


def numbers_of(number):
    """At the first and the last value that are allowed, beyond them, at 0, tiny, huge and between."""
    is_whole = number["type"] == "integer"

    def text(value):
        return str(value) if is_whole else repr(float(value))

    def beside(bound, up):
        return int(bound) + (1 if up else -1) if is_whole else math.nextafter(bound, math.inf if up else -math.inf)

    low, high = number.get("minimum", -math.inf), number.get("maximum", math.inf)
    if "exclusiveMinimum" in number:
        low = beside(number["exclusiveMinimum"], up=True)
    if "exclusiveMaximum" in number:
        high = beside(number["exclusiveMaximum"], up=False)
    within = [low, high, 0, 1, 0.3 * high, math.sqrt(max(low, 1e-6) * max(min(high, 1e12), 0.0))]
    within += [low + 1, low + 2, 1000] if is_whole else [1e-300, -1e-300, 1e-9, 1e300, -1e300]
    within = [math.floor(x) if is_whole else x for x in within if math.isfinite(x)]
    beyond = [beside(low, up=False)] * math.isfinite(low) + [beside(high, up=True)] * math.isfinite(high)
    values = [(text(x), "in") for x in within if low <= x <= high] + [(text(x), "out") for x in beyond]
    return values + [(word, "out") for word in ["nan", "inf", "-inf", '"1"', "true"] + ["1.5"] * is_whole]


def values_of(what):
    """(value, kind) of one key; none of what is the content of a file."""
    kind = what.get("type")
    if "enum" in what:
        return [(json.dumps(one), "in") for one in what["enum"]] + [('"neither"', "out"), ("7", "out")]
    if kind in ("number", "integer"):
        return list(dict.fromkeys(numbers_of(what)))
    if kind == "boolean":
        return [("true", "in"), ("false", "in"), ("1", "out"), ('"yes"', "out")]
    if kind == "string":
        return [(v, "any") for v in ('""', '"/dev/null"', '"/"', '"/nowhere/none"')] + [("1", "out")]
    return arrays_of(what["items"], what.get("minItems")) if kind == "array" else []


def arrays_of(of, count):
    """As many as are asked for, or one and three; of tables, one with one key."""
    if of.get("type") == "object":
        return [(f"[{{{name} = {v}}}]", kind) for name, one in of.get("properties", {}).items() for v, kind in values_of(one)]
    cases = [("[" + ", ".join([v] * n) + "]", kind) for v, kind in values_of(of) for n in ([count] if count else [1, 3])]
    one_more = ", ".join([values_of(of)[0][0]] * ((count or 0) + 1))
    return cases + ([(f"[{one_more}]", "out"), ("[]", "out")] if count else [("[]", "any")])


def cases_of(schema, bench):
    """Every case of every key of a bench."""
    (table,) = [one for one in schema["oneOf"] if one["properties"]["bench"]["const"] == bench]
    return [(key, value, kind) for key, what in keys_of(table) for value, kind in values_of(what)]
