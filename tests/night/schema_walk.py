#!/usr/bin/env python3
"""Every key of every bench at its bounds, beyond them, at 0, tiny, huge and between: `run` and `score` answer in words or in numbers.

    tests/night/schema_walk.py build/tools/twinbench                          every case
    tests/night/schema_walk.py build/tools/twinbench --bench hob_transmission --key '^mesh' --seconds 60

A fault is: an end by a signal or with a code beside 0 to 3; a message that only the program's authors understand; nan, inf or more than 1e9 as a
result; 20 s without a word; a value beyond its bounds that is taken. Known ones stand in known_faults.csv; exit code 1 if a bench has more of
them. Results further than they say from the truth, mean (error/u)^2 above 4, are listed. A case that talks for longer than 30 s is left.
"""

import argparse
import collections
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import random
import re
import resource
import subprocess
import sys
import tempfile
import time

from walk_cases import cases_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
KNOWN = ROOT / "tests/night/known_faults.csv"
SILENT_s, LONG_s = 20.0, 30.0
LARGEST = 1e9
WEAK_CHI2, FEW = 4.0, 8
MEMORY_B = 6 << 30

# Small runs, 0.1 to 0.3 s each, in which as many keys as possible count: name -> bench, scenario, what is smaller than there.
BASES = {
    "rotary": ("rotary_4dof", "one_of_everything.toml",
               ["procedure.positions=9", "procedure.shifts=[0, 1, 2]", "procedure.stability_s=300.0", "adc.samples=50"]),
    "rotary_bodies": ("rotary_4dof", "rotary_4dof.toml",
                      ["procedure.positions=12", "procedure.shifts=[0, 1, 5]", "procedure.passes=[1, -1]"]),
    "encoder": ("encoder_comparison", "encoder_comparison.toml", ["encoder_procedure.stops_per_turn=24"]),
    "encoder_sweep": ("encoder_comparison", "encoder_comparison.toml", ['encoder_procedure.kind="sweep"']),
    "encoder_coast": ("encoder_comparison", "encoder_coast.toml",
                      ["encoder_procedure.turns=4.0", "encoder_procedure.stamps_per_turn=256", "device.graduation_orders=100"]),
    "turntable": ("turntable_autocollimator", "turntable_autocollimator.toml",
                  ["turntable_procedure.positions=36", "turntable_procedure.verification_positions=36"]),
    "polygon": ("turntable_autocollimator", "turntable_polygon.toml", []),
    "hob": ("hob_transmission", "hob_transmission.toml",
            ['mechanics.fidelity="kinematic"', "hob_procedure.turns=2", "hob_procedure.samples_per_turn=360"]),
    "hob_bodies": ("hob_transmission", "hob_transmission.toml", ["hob_procedure.turns=1", "hob_procedure.samples_per_turn=360"]),
    "circular": ("circular_motion", "circular_motion.toml",
                 ["circular_procedure.points=36", "circular_procedure.stops=6", "circular_procedure.feeds_mm_min=[1000.0]"]),
    "circular_bodies": ("circular_motion", "circular_bodies.toml",
                        ["circular_procedure.feeds_mm_min=[1000.0]", "circular_procedure.points=36",
                         'circular_procedure.setups=[{instrument = "bar", radius_mm = 110.23}]']),
    "freeform": ("freeform_five_axis", "freeform_five_axis.toml", ["freeform_procedure.poses=25"]),
}  # fmt: skip

NO_NUMBER = re.compile(r"(?<![\w.])[-+]?(nan|inf)(?!\w)")
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w.])")
INFINITE_BY_RIGHT = re.compile(r"\binf( degrees of freedom|\s+[\d.]+ %)")  # degrees of freedom, and their column in a budget
FOR_AUTHORS = re.compile(r"std::|bad_alloc|basic_string|vector::|json\.exception|Eigen|[Aa]ssert|terminate called|_M_|\.cc:\d|^stod|^stoi")
# What may fail of a bench, told with its name; any other end with code 1 is a condition of some function's that no user can know.
DEVICE = re.compile(r"twinbench: (target|reference|adc|psd_\w+|thermometer|instruments|machine|fixture|indexer|turntable|table|spindle|[XYZABC]): |twinbench: the spindle ")


def spoken(command, said):
    """Runs it with all that it says in a file. @return code, or "silent" or "long"."""
    with open(said, "wb") as file:
        process = subprocess.Popen(command, stdout=file, stderr=file, stdin=subprocess.DEVNULL)
        begin = last = time.monotonic()
        size, wait_s = 0, 0.01
        while process.poll() is None:
            time.sleep(wait_s)
            wait_s = min(2.0 * wait_s, 0.2)
            now, grown = time.monotonic(), said.stat().st_size
            if grown > size:
                last, size = now, grown
            if now - last > SILENT_s or now - begin > LONG_s:
                process.kill()
                process.wait()
                return "silent" if now - last > SILENT_s else "long"
    return process.returncode


def too_large(results, path=""):
    """The first number that is none or is out of all measure, with its place."""
    if isinstance(results, (dict, list)):
        inner = results.items() if isinstance(results, dict) else enumerate(results)
        return next(filter(None, (too_large(one, f"{path}.{name}") for name, one in inner)), None)
    return f"{path[1:]} = {results:g}" if isinstance(results, float) and not abs(results) <= LARGEST else None


def wrong_in(text):
    """The first line with something that is no result."""
    lines = INFINITE_BY_RIGHT.sub("", text).splitlines()
    return next((ln.strip() for ln in lines if NO_NUMBER.search(ln) or any(abs(float(n)) > LARGEST for n in NUMBER.findall(ln))), None)


def fault_of(kind, code, said, results):
    """@return what is wrong with an answer to `run`, and where; None if nothing is."""
    last = (said.strip().splitlines() or [""])[-1]
    if code == "silent":
        return "silent", last
    if code not in (0, 1, 2, 3, "long"):
        return "crash", f"ended by {code}: {last}"
    if code != 0:
        is_internal = FOR_AUTHORS.search(last) or (code == 1 and not DEVICE.match(last))
        return ("internal message", last) if is_internal else None
    if kind == "out":
        return "taken", "beyond what the schema allows"
    wrong = wrong_in(said) or too_large(results)
    return ("no number", wrong) if wrong else None


def largest_chi2(score):
    """The largest mean (error/u)^2; quantities of few values count together under the first word of their names."""
    squares = collections.defaultdict(list)
    for name, of in score.get("values", {}).items():
        errors = [(value - truth, u) for value, truth, u in zip(of["value"], of["truth"], of["u"]) if None not in (value, truth, u)]
        group = name if len(errors) >= FEW else name.split(".")[0]
        squares[group] += [(error / u) ** 2 if u else math.inf for error, u in errors if u or error]
    return max((sum(own) / len(own) for own in squares.values() if own), default=0.0)


def json_of(path):
    return json.loads(path.read_text()) if path.exists() else {}


def walk_one(twinbench, case):
    base, key, value, kind = case
    _, scenario, sets = BASES[base]
    sets = [word for one in sets if not one.startswith(key + "=") for word in ("--set", one)] + ["--set", f"{key}={value}"]
    row, begin = {"base": base, "key": key, "value": value, "kind": kind}, time.monotonic()
    with tempfile.TemporaryDirectory() as name:
        folder, said = pathlib.Path(name), pathlib.Path(name, "said.txt")
        row["code"] = spoken([twinbench, "run", ROOT / "scenarios" / scenario, "-o", folder / "run", *sets], said)
        row["seconds"] = round(time.monotonic() - begin, 2)
        fault = fault_of(kind, row["code"], said.read_text(errors="replace"), json_of(folder / "run/results.json"))
        if row["code"] == 1:
            row["said"] = said.read_text(errors="replace").strip().splitlines()[-1]
        if row["code"] == 0 and not fault:
            code = spoken([twinbench, "score", folder / "run", "--json", folder / "score.json"], said)
            fault = fault_of("in", code, said.read_text(errors="replace"), {})
            row["chi2"] = largest_chi2(json_of(folder / "score.json"))
    return row | ({"fault": fault[0], "detail": fault[1]} if fault else {})


def chosen(schema, how):
    """In an order of --seed, so that what fits into --seconds is a sample of all."""
    cases = [(base, *case) for base, (bench, *_) in BASES.items() if how.bench in ("", bench) for case in cases_of(schema, bench)]
    cases = [case for case in cases if re.search(how.key, case[1])]
    random.Random(how.seed).shuffle(cases)
    return cases


def of_case(row):
    return row["base"], row["key"], row["value"]


def in_words(row):
    return f"* {row['base']}: `{row['key']} = {row['value'][:80]}`: {row['fault']}: {row['detail'][:160]}"


def is_weak(row):
    return row.get("chi2", 0.0) > WEAK_CHI2


def compare(rows, known):
    """@return a line a bench, and the faults of those that have more than are known of the same cases."""
    known, more, lines = {of_case(row) for row in known}, [], ["| bench | cases | faults | known | weak | long |", "|---|---|---|---|---|---|"]
    for bench in sorted({BASES[row["base"]][0] for row in rows}):
        own = [row for row in rows if BASES[row["base"]][0] == bench]
        faults, before = [row for row in own if "fault" in row], sum(of_case(row) in known for row in own)
        lines.append(f"| {bench} | {len(own)} | {len(faults)} | {before} | {sum(map(is_weak, own))} | {sum(r['code'] == 'long' for r in own)} |")
        if len(faults) > before:
            more += [row for row in faults if of_case(row) not in known]
    return lines, more


def page_of(rows, known):
    lines, more = compare(rows, known)
    faults, worst = [row for row in rows if "fault" in row], sorted(filter(is_weak, rows), key=lambda row: -row["chi2"])[:10]
    mended = {of_case(row) for row in known} & {of_case(row) for row in rows if "fault" not in row}
    kinds = collections.Counter(row["fault"] for row in faults).most_common()
    lines += ["", "Faults: " + (", ".join(f"{kind} {n}" for kind, n in kinds) or "none") + "; not known:", "", *map(in_words, more[:40])]
    lines += ["", f"Known and right now, to be taken out of {KNOWN.name}: {len(mended)}", "", *(f"* `{' '.join(one)[:160]}`" for one in sorted(mended))]
    lines += ["", "Furthest from the truth, mean (error/u)^2:", ""]
    lines += [f"* {row['base']}: `{row['key']} = {row['value'][:80]}`: {row['chi2']:.3g}" for row in worst]
    return "\n".join(lines) + "\n", more


def accept(rows, known):
    """What is known of other cases stays."""
    walked = {of_case(row) for row in rows}
    faults = [row for row in known if of_case(row) not in walked] + [row for row in rows if "fault" in row]
    with open(KNOWN, "w", newline="") as file:
        writer = csv.DictWriter(file, ["base", "key", "value", "fault"], extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows(sorted(faults, key=of_case))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("twinbench", type=pathlib.Path)
    parser.add_argument("--bench", default="")
    parser.add_argument("--key", default="", help="a regular expression")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=math.inf, help="begin no case after these")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("-o", dest="out", type=pathlib.Path, default=pathlib.Path(os.devnull), help="one JSON line a case")
    parser.add_argument("--page", type=pathlib.Path, default=pathlib.Path(os.devnull), help="write the summary here (Markdown)")
    parser.add_argument("--accept", action="store_true", help="write known_faults.csv")
    how = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_B, MEMORY_B))  # of every run
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    schema = json.loads(subprocess.run([how.twinbench, "schema"], check=True, capture_output=True).stdout)
    cases, until, rows = chosen(schema, how), time.monotonic() + how.seconds, []
    with concurrent.futures.ThreadPoolExecutor(how.threads) as pool, open(how.out, "w", buffering=1) as out:
        for row in pool.map(lambda case: walk_one(how.twinbench, case) if time.monotonic() < until else None, cases):
            if row:
                rows.append(row)
                out.write(json.dumps(row) + "\n")
    with open(KNOWN, newline="") as file:
        known = list(csv.DictReader(file))
    text, more = page_of(rows, known)
    text = f"{len(rows)} of {len(cases)} cases\n\n{text}"
    how.page.write_text(text)
    print(text, *(f"schema_walk: not known: {in_words(row)}" for row in more), sep="\n")
    if how.accept:
        accept(rows, known)
    return 1 if more and not how.accept else 0


if __name__ == "__main__":
    sys.exit(main())
