#!/usr/bin/env python3
"""Benchmarks as ratios, compared with the committed table; docs/speed.md gets its measured tables from here.

    cmake --build build --target benchmarks twinbench && tests/night/ratios.py build

Of a machine that others use too, a time says little, and the quotient of two times of one run much. Every program runs five times, by turns,
and medians count. A row of ratios.csv says what is divided by what, which way is better ("" is shown in docs/speed.md and never fails), what
was asked for, and what was measured on each kind of processor. Exit code 1 if a ratio is worse by more than 15 %.
"""

import argparse
import collections
import csv
import datetime
import json
import os
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = ROOT / "tests/night/ratios.csv"
PAGE = ROOT / "docs/speed.md"
WORSE = 0.15
SECONDS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}


def kind_of_processor(cpuinfo):
    """Of those that the program has kernels for."""
    flags = set(re.search(r"^flags\s*:(.*)$", cpuinfo, re.M).group(1).split())
    return next((kind for kind, flag in (("avx512", "avx512f"), ("avx2", "avx2")) if flag in flags), "baseline")


def figures_of(answer, program):
    """What a run of a benchmark says: "program benchmark counter" -> number, times in seconds of CPU time."""
    figures = {}
    for line in answer["benchmarks"]:
        if not line.get("error_occurred"):  # a kernel that this processor does not have
            name = f"{program} {re.sub('/iterations:.*', '', line['name'])} "
            counters = {key: value for key, value in line.items() if isinstance(value, float) and key not in ("cpu_time", "real_time")}
            figures |= {name + key: value for key, value in counters.items()} | {name + "cpu_s": line["cpu_time"] * SECONDS[line["time_unit"]]}
    return figures


def run_benchmark(build, program, names):
    wanted = "^(" + "|".join(map(re.escape, names)) + ")(/iterations:.)?$"
    command = [build / "tests/perf" / program, f"--benchmark_filter={wanted}", "--benchmark_min_time=0.2", "--benchmark_format=json"]
    return figures_of(json.loads(subprocess.run(command, check=True, capture_output=True).stdout), program)


def run_scenario(build, scenario):
    """CPU time of `twinbench run` as a whole process."""
    before = sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([build / "tools/twinbench", "run", ROOT / "scenarios" / scenario, "-o", folder + "/run"], check=True, capture_output=True)
    return {f"twinbench {scenario} cpu_s": sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2]) - before}


def measure(build, rows, rounds):
    """@return for every round what was measured in it."""
    programs = collections.defaultdict(dict)  # names in the order of the table
    for place in [row[end] for row in rows for end in ("of", "over") if row[end]]:
        program, name, _ = place.split(" ")
        programs[program][name] = True
    measured = []
    for _ in range(rounds):
        measured.append({})
        for program, names in programs.items():
            parts = [run_scenario(build, name) for name in names] if program == "twinbench" else [run_benchmark(build, program, names)]
            for part in parts:
                measured[-1] |= part
    return measured


def median_of(row, measured):
    """@return the ratio, or the figure where nothing is divided; None if this processor has no such kernel."""
    whole = [round_ for round_ in measured if all(row[end] in round_ for end in ("of", "over") if row[end])]
    values = [figures[row["of"]] / (figures[row["over"]] if row["over"] else 1.0) for figures in whole]
    return statistics.median(values) if values else None


def is_worse(better, now, committed):
    if not better or not committed:
        return False
    return now > committed * (1.0 + WORSE) if better == "lower" else now < committed * (1.0 - WORSE)


def in_digits(value, counter=""):
    if value is None:
        return ""
    if value >= 1e6:
        return f"{value / 1e6:.0f} M"
    if counter != "cpu_s":
        return f"{value:.3g}" if value < 999.5 else f"{value:,.0f}".replace(",", " ")
    unit = next((unit for unit in ("s", "ms", "us") if value >= SECONDS[unit]), "ns")
    return f"{value / SECONDS[unit]:.3g} {unit}"


def table_of(rows, measured):
    """One group as docs/speed.md shows it: the ratio, and the two figures that it is made of."""
    lines = ["| | ratio | asked for | figures |", "|---|---|---|---|"]
    for row in rows:
        value, is_ratio = median_of(row, measured), bool(row["better"])
        if value is None:
            continue
        ends = [row[end] for end in ("of", "over") if row[end] and (row["over"] or not is_ratio)]
        figures = " to ".join(in_digits(statistics.median(round_[end] for round_ in measured if end in round_), end.split(" ")[2]) for end in ends)
        lines.append(f"| {row['what']} | {in_digits(value) if is_ratio else ''} | {row['asked']} | {figures} |")
    return "\n".join(lines) + "\n"


def with_tables(page, tables):
    """@return the page with what stands between its markers written anew."""
    for group, table in tables.items():
        marked = re.compile(rf"(<!-- measured: {re.escape(group)} -->\n).*?(<!-- end -->)", re.S)
        if not marked.search(page):
            raise SystemExit(f"ratios: {PAGE.name} has no place for {group}")
        page = marked.sub(lambda at, table=table: at.group(1) + table + at.group(2), page)
    return page


def conditions(kind, rounds):
    model = re.search(r"model name\s*:\s*(.*)", pathlib.Path("/proc/cpuinfo").read_text()).group(1)
    return (f"{datetime.date.today()}, {model} ({kind}), {os.cpu_count()} processors under a load of {os.getloadavg()[1]:.1f}; "
            f"CPU time, medians of {rounds} rounds.\n")  # fmt: skip


def compare(rows, measured, kind):
    """@return a table of what is compared, and the lines of it that are worse."""
    lines = []
    for row in rows:
        now, committed = median_of(row, measured), float(row[kind] or 0.0)
        if row["better"] and (committed or now is not None):  # what this kind never had is not missed
            word = "GONE" if now is None else "WORSE" if is_worse(row["better"], now, committed) else "" if committed else "nothing to compare with"
            lines.append(f"| {row['group']}: {row['what']} ({row['better']} is better) | {in_digits(now)} | {row[kind]} | {word} |")
    return ["| ratio | now | committed | |", "|---|---|---|---|", *lines], [line for line in lines if line.endswith(("WORSE |", "GONE |"))]


def accept(rows, measured, kind):
    for row in rows:
        if row["better"] and (now := median_of(row, measured)) is not None:
            row[kind] = f"{now:.3g}"
    with open(TABLE, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--accept", action="store_true", help="write what is measured into the committed table")
    parser.add_argument("--page", type=pathlib.Path, help="write the comparison here (Markdown)")
    how = parser.parse_args()
    with open(TABLE, newline="") as file:
        rows = list(csv.DictReader(file))
    kind = kind_of_processor(pathlib.Path("/proc/cpuinfo").read_text())
    measured = measure(how.build, rows, how.rounds)
    tables = {group: table_of([row for row in rows if row["group"] == group], measured) for group in {row["group"] for row in rows}}
    PAGE.write_text(with_tables(PAGE.read_text(), tables | {"conditions": conditions(kind, how.rounds)}))
    lines, worse = compare(rows, measured, kind)
    text = "\n".join([f"Compared with the column {kind} of {TABLE.name}.\n", *lines, ""])
    if how.accept:
        accept(rows, measured, kind)
    if how.page:
        how.page.write_text(text)
    print(text)
    print(*(f"ratios: worse by more than {WORSE:.0%}, or gone: {line}" for line in worse), sep="\n", file=sys.stderr)
    return 1 if worse and not how.accept else 0


if __name__ == "__main__":
    sys.exit(main())
