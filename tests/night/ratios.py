#!/usr/bin/env python3
"""Benchmarks as ratios, compared with the committed table; docs/speed.md gets its measured tables from here.

    cmake --build build --target benchmarks twinbench && tests/night/ratios.py build

Of a machine that others use too, a time says little, and the quotient of two times of one run much. Every program runs five times, by turns,
and medians count. A row of ratios.csv says what is divided by what, which way is better ("" is shown in docs/speed.md and never fails), what
was asked for, and what was measured on each kind of processor. Exit code 1 if a ratio is worse by more than 15 %.
"""

import argparse
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
        if line.get("error_occurred"):
            continue  # not on this processor
        name = f"{program} {line['name'].removesuffix('/iterations:1').removesuffix('/iterations:2')} "
        figures[name + "cpu_s"] = line["cpu_time"] * SECONDS[line["time_unit"]]
        figures |= {name + key: value for key, value in line.items() if isinstance(value, float) and key not in ("cpu_time", "real_time")}
    return figures


def run_benchmark(build, program, names):
    wanted = "^(" + "|".join(re.escape(name) for name in sorted(names)) + ")(/iterations:.)?$"
    command = [build / "tests/perf" / program, f"--benchmark_filter={wanted}", "--benchmark_min_time=0.2", "--benchmark_format=json"]
    return figures_of(json.loads(subprocess.run(command, check=True, capture_output=True).stdout), program)


def run_command(build, scenario):
    """CPU time of `twinbench run` as a whole process."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([build / "tools/twinbench", "run", ROOT / "scenarios" / scenario, "-o", folder + "/run"], check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return {f"twinbench {scenario} cpu_s": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime}


def measure(build, rows, rounds):
    """@return for every round what was measured in it."""
    programs = {}
    for row in rows:
        for place in filter(None, (row["of"], row["over"])):
            program, name, _ = place.split(" ")
            programs.setdefault(program, set()).add(name)
    measured = []
    for _ in range(rounds):
        figures = {}
        for program, names in programs.items():
            if program == "twinbench":
                for scenario in sorted(names):
                    figures |= run_command(build, scenario)
            else:
                figures |= run_benchmark(build, program, names)
        measured.append(figures)
    return measured


def median_of(row, measured):
    """@return the ratio, or the figure where nothing is divided; None if this processor has no such kernel."""
    values = [
        figures[row["of"]] / (figures[row["over"]] if row["over"] else 1.0)
        for figures in measured
        if row["of"] in figures and (not row["over"] or row["over"] in figures)
    ]
    return statistics.median(values) if values else None


def is_worse(better, now, committed):
    if not better or now is None or not committed:
        return False
    return now > committed * (1.0 + WORSE) if better == "lower" else now < committed * (1.0 - WORSE)


def three_digits(value, counter=""):
    if counter == "cpu_s":
        unit, scale = next((u, s) for u, s in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)) if value >= s or u == "ns")
        return f"{value / scale:.3g} {unit}"
    return f"{value:.3g}" if value < 999.5 else f"{value:,.0f}".replace(",", " ")


def table_of(rows, measured):
    """One group as docs/speed.md shows it: the ratio, and the two figures that it is made of."""
    lines = ["| | ratio | asked for | figures |", "|---|---|---|---|"]
    for row in rows:
        ratio = median_of(row, measured)
        if ratio is None:
            continue
        parts = [row["of"], row["over"]] if row["over"] else [row["of"]]
        shown = [three_digits(statistics.median([f[p] for f in measured]), p.split(" ")[2]) for p in parts]
        is_ratio = bool(row["better"])
        figures = " to ".join(shown) if row["over"] or not is_ratio else ""
        bound = {"lower": "at most ", "higher": "at least ", "": ""}[row["better"]]
        lines.append(f"| {row['what']} | {three_digits(ratio) if is_ratio else ''} | {bound + row['asked'] if row['asked'] else ''} | {figures} |")
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


def report(rows, measured, kind):
    """@return a table of what is compared, and what is worse."""
    lines, worse = [f"Compared with the column {kind} of {TABLE.name}.\n", "| ratio | now | committed | |", "|---|---|---|---|"], []
    for row in filter(lambda row: row["better"], rows):
        now, committed = median_of(row, measured), float(row.get(kind) or 0.0)
        if now is None:
            continue
        word = "nothing to compare with" if not committed else "WORSE" if is_worse(row["better"], now, committed) else ""
        line = f"| {row['group']}: {row['what']} ({row['better']} is better) | {three_digits(now)} | {row.get(kind) or ''} | {word} |"
        lines.append(line)
        if word == "WORSE":
            worse.append(line)
    return "\n".join(lines) + "\n", worse


def accept(rows, measured, kind):
    for row in rows:
        now = median_of(row, measured)
        if row["better"] and now is not None:
            row[kind] = f"{now:.3g}"
    with open(TABLE, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--only", default="", help="groups with this in their name; docs/speed.md keeps the others' tables")
    parser.add_argument("--accept", action="store_true", help="write what is measured into the committed table")
    parser.add_argument("--page", type=pathlib.Path, help="write the comparison here (Markdown)")
    how = parser.parse_args()
    with open(TABLE, newline="") as file:
        every_row = list(csv.DictReader(file))
    rows = [row for row in every_row if how.only in row["group"]]
    kind = kind_of_processor(pathlib.Path("/proc/cpuinfo").read_text())
    measured = measure(how.build, rows, how.rounds)
    groups = dict.fromkeys(row["group"] for row in rows)
    tables = {group: table_of([row for row in rows if row["group"] == group], measured) for group in groups}
    PAGE.write_text(with_tables(PAGE.read_text(), tables | {"conditions": conditions(kind, how.rounds)}))
    text, worse = report(rows, measured, kind)
    if how.accept:
        accept(every_row, measured, kind)
    if how.page:
        how.page.write_text(text)
    print(text)
    for line in worse:
        print(f"ratios: worse by more than {WORSE:.0%}: {line}", file=sys.stderr)
    return 1 if worse and not how.accept else 0


if __name__ == "__main__":
    sys.exit(main())
