#!/usr/bin/env python3
"""Every key of every bench at its bounds, beyond them, at 0, tiny, huge and between: `run` and `score` answer in words or in numbers.

    tests/night/schema_walk.py build/tools/twinbench                          every case
    tests/night/schema_walk.py build/tools/twinbench --share 0.1 --bench hob_transmission --key '^mesh'

A fault is: an end by a signal or with a code beside 0 to 3; a message that only the program's authors understand; nan, inf or more than 1e9 as a
result; 20 s without a word; a value beyond its bounds that is taken. Known ones stand in known_faults.csv; exit code 1 if a bench has more of
them. Results further than they say from the truth, mean (error/u)^2 above 4, are listed. A case that talks for longer than 30 s is left.
"""

import argparse
import collections
import concurrent.futures
import csv
import json
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
WEAK_CHI2 = 4.0
MEMORY_B = 6 << 30

# Small runs, 0.1 to 0.3 s each, in which as many keys as possible count: name -> bench, scenario, what is smaller than there.
BASES = {
    "rotary": ("rotary_4dof", "one_of_everything.toml",
               ["procedure.positions=9", "procedure.shifts=[0, 1, 2]", "procedure.stability_s=300.0", "adc.samples=50"]),
    "rotary_bodies": ("rotary_4dof", "rotary_4dof.toml",
                      ["procedure.positions=12", "procedure.shifts=[0, 1, 5]", "procedure.passes=[1, -1]"]),
    "encoder": ("encoder_comparison", "encoder_comparison.toml", ["encoder_procedure.stops_per_turn=24"]),
    "encoder_sweep": ("encoder_comparison", "encoder_comparison.toml", ['encoder_procedure.kind="sweep"']),
    "turntable": ("turntable_autocollimator", "turntable_autocollimator.toml",
                  ["turntable_procedure.positions=36", "turntable_procedure.verification_positions=36"]),
    "polygon": ("turntable_autocollimator", "turntable_polygon.toml", []),
    "hob": ("hob_transmission", "hob_transmission.toml",
            ['mechanics.fidelity="kinematic"', "hob_procedure.turns=2", "hob_procedure.samples_per_turn=360"]),
    "circular": ("circular_motion", "circular_motion.toml",
                 ["circular_procedure.points=36", "circular_procedure.stops=6", "circular_procedure.feeds_mm_min=[1000.0]"]),
    "freeform": ("freeform_five_axis", "freeform_five_axis.toml", ["freeform_procedure.poses=25"]),
}  # fmt: skip

NO_NUMBER = re.compile(r"(?<![\w.])[-+]?(nan|inf)(?!\w)")
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w.])")
INFINITE_BY_RIGHT = re.compile(r"\binf( degrees of freedom|\s+[\d.]+ %)")  # degrees of freedom, and their column in a budget
FOR_AUTHORS = re.compile(r"std::|bad_alloc|basic_string|vector::|json\.exception|Eigen|[Aa]ssert|terminate called|_M_|\.cc:\d|^stod|^stoi")


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
    is_wrong = isinstance(results, float) and not abs(results) <= LARGEST
    return f"{path[1:]} = {results:g}" if is_wrong else None


def wrong_in(text):
    """The first line with something that is no result."""
    for line in INFINITE_BY_RIGHT.sub("", text).splitlines():
        if NO_NUMBER.search(line) or any(abs(float(n)) > LARGEST for n in NUMBER.findall(line)):
            return line.strip()
    return None


def fault_of(kind, code, said, results):
    """@return what is wrong with an answer to `run`, and where; None if nothing is."""
    last = said.strip().splitlines()[-1:] or [""]
    if code == "silent":
        return "silent", last[0]
    if code == "long":
        return None
    if code not in (0, 1, 2, 3):
        return "crash", f"ended by {code}: {last[0]}"
    if code != 0:
        return ("internal message", last[0]) if FOR_AUTHORS.search(last[0].removeprefix("twinbench: ")) else None
    if kind == "out":
        return "taken", "beyond what the schema allows"
    wrong = wrong_in(said) or too_large(results)
    return ("no number", wrong) if wrong else None


def largest_chi2(score):
    if isinstance(score, list):
        return max(map(largest_chi2, score), default=0.0)
    if not isinstance(score, dict):
        return 0.0
    own = score.get("mean_chi2")
    return max([own if isinstance(own, (int, float)) else 0.0] + [largest_chi2(v) for name, v in score.items() if name != "values"])


def walk_one(twinbench, case):
    base, key, value, kind = case
    _, scenario, sets = BASES[base]
    sets = [s for s in sets if not s.startswith(key + "=")] + [f"{key}={value}"]
    row = {"base": base, "key": key, "value": value, "kind": kind}
    with tempfile.TemporaryDirectory() as folder:
        run, said = f"{folder}/run", pathlib.Path(folder, "said.txt")
        begin = time.monotonic()
        row["code"] = spoken([twinbench, "run", ROOT / "scenarios" / scenario, "-o", run, *(w for s in sets for w in ("--set", s))], said)
        row["seconds"] = round(time.monotonic() - begin, 2)
        text = said.read_text(errors="replace")
        written = pathlib.Path(run, "results.json")
        fault = fault_of(kind, row["code"], text, json.loads(written.read_text()) if written.exists() else None)
        if row["code"] == 0 and not fault:
            code = spoken([twinbench, "score", run, "--json", f"{folder}/score.json"], said)
            fault = fault_of("in", code, said.read_text(errors="replace"), None) if code != 0 else None
            row["chi2"] = largest_chi2(json.loads(pathlib.Path(folder, "score.json").read_text())) if code == 0 else None
        elif row["code"] == 1:
            row["said"] = text.strip().splitlines()[-1]
    return row | ({"fault": fault[0], "detail": fault[1]} if fault else {})


def chosen(schema, how):
    """The cases to walk: the same of the same share and seed, whatever else there is."""
    cases = [(base, *case) for base, (bench, *_) in BASES.items() if how.bench in ("", bench) for case in cases_of(schema, bench)]
    cases = [case for case in cases if re.search(how.key, case[1]) and random.Random(f"{how.seed} {case}").random() < how.share]
    random.Random(how.seed).shuffle(cases)  # what fits into --seconds is a sample of all
    return cases


def of_case(row):
    return row["base"], row["key"], row["value"]


def compare(rows, known):
    """@return a line a bench, and the faults of those that have more than are known of the same cases."""
    lines, more = ["| bench | cases | faults | known | weak | long |", "|---|---|---|---|---|---|"], []
    by_bench = collections.defaultdict(list)
    for row in rows:
        by_bench[BASES[row["base"]][0]].append(row)
    known = {of_case(row) for row in known}
    for bench, of_bench in by_bench.items():
        faults = [row for row in of_bench if "fault" in row]
        before = sum(of_case(row) in known for row in of_bench)
        weak = sum((row.get("chi2") or 0.0) > WEAK_CHI2 for row in of_bench)
        lines.append(f"| {bench} | {len(of_bench)} | {len(faults)} | {before} | {weak} | {sum(r['code'] == 'long' for r in of_bench)} |")
        if len(faults) > before:
            more += [row for row in faults if of_case(row) not in known]
    return lines, more


def in_words(row):
    return f"* {row['base']}: `{row['key']} = {row['value'][:80]}`: {row['fault']}: {row['detail'][:160]}"


def page_of(rows, known):
    lines, more = compare(rows, known)
    faults, weak = [r for r in rows if "fault" in r], [r for r in rows if (r.get("chi2") or 0.0) > WEAK_CHI2]
    kinds = collections.Counter(row["fault"] for row in faults)
    lines += ["", "Faults: " + (", ".join(f"{kind} {n}" for kind, n in kinds.most_common()) or "none"), "", *map(in_words, faults[:40])]
    mended = {of_case(row) for row in known} & {of_case(row) for row in rows if "fault" not in row}
    lines += ["", f"Known and right now, so that {KNOWN.name} can lose them: {len(mended)}"] + [f"* {' '.join(one)[:160]}" for one in sorted(mended)]
    worst = sorted(weak, key=lambda row: -row["chi2"])[:10]
    lines += ["", "Furthest from the truth, mean (error/u)^2:"] + [f"* {r['base']}: `{r['key']} = {r['value'][:80]}`: {r['chi2']:.3g}" for r in worst]
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
    parser.add_argument("--share", type=float, default=1.0, help="of all cases, drawn by --seed")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=1e9, help="begin no case after these")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("-o", dest="out", type=pathlib.Path, help="one JSON line a case")
    parser.add_argument("--page", type=pathlib.Path, help="write the summary here (Markdown)")
    parser.add_argument("--accept", action="store_true", help="write known_faults.csv")
    how = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_B, MEMORY_B))  # of every run
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    schema = json.loads(subprocess.run([how.twinbench, "schema"], check=True, capture_output=True).stdout)
    cases, until = chosen(schema, how), time.monotonic() + how.seconds
    with concurrent.futures.ThreadPoolExecutor(how.threads) as pool:
        walked = pool.map(lambda case: walk_one(how.twinbench, case) if time.monotonic() < until else None, cases)
        rows = [row for row in walked if row]
    with open(KNOWN, newline="") as file:
        known = list(csv.DictReader(file))
    if how.out:
        how.out.write_text("".join(json.dumps(row) + "\n" for row in rows))
    text, more = page_of(rows, known)
    if how.accept:
        accept(rows, known)
    if how.page:
        how.page.write_text(text)
    print(f"{len(rows)} of {len(cases)} cases\n\n{text}")
    for row in more:
        print(f"schema_walk: not known: {in_words(row)}", file=sys.stderr)
    return 1 if more and not how.accept else 0


if __name__ == "__main__":
    sys.exit(main())
