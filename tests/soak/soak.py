#!/usr/bin/env python3
"""Serve and measure for a long time, with faults at random: same readings every time, memory and handles flat.

    tests/soak/soak.py build/tools/twinbench scenarios/rotary_4dof.toml --minutes 60    (or of any other bench)

One `serve` stays up; `measure` runs on it again and again while faults strike at random moments and some measurements
are killed. Every run is resumed until it is whole, and its readings are compared with those of `run`, text by text.
Exit code 0 if all were equal and neither memory nor handles of the server grew; 1 otherwise.
"""

import argparse
import pathlib
import random
import re
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

# Device and kind of faults after which a reading is taken again: of two tables and a card, and of a machine.
TABLE_FAULTS = [
    "adc,slip", "adc,stuck", "adc,drop", "adc,stall", "adc,short", "adc,error", "clock,step", "target,mute", "reference,late",
    "target,partial", "target,disconnect", "target,restart", "reference,lost_step", "target,not_in_position",
]  # fmt: skip
# A lost word is seen by the channels' levels, where they are not alike (docs/hardware.md, "A/D cards").
LEVELS_APART = "amplifier.offset_mV=[-1500, -500, 500, 1500]"
MACHINE_FAULTS = [
    f"{device},{kind}" for device in ("machine", "instruments") for kind in ("mute", "late", "partial", "disconnect")
] + ["machine,restart", "machine,not_in_position", "instruments,gap"]  # fmt: skip
MOST_RESUMES = 100  # faults that have not struck yet wait for the next attempt
WARM_UP_RUNS = 10
ALLOWED_GROWTH = 0.05  # of the server's memory between the end of the warm-up and the end


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("twinbench", type=pathlib.Path)
    parser.add_argument("scenario")
    parser.add_argument("--set", action="append", default=[], help="as of twinbench run")
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kill-share", type=float, default=0.2, help="of the measurements that are killed once")
    return parser.parse_args()


class Server:
    """`twinbench serve` and what it takes of the machine."""

    def __init__(self, how, folder):
        self.bench = folder / "bench.toml"
        self.log = open(folder / "serve.log", "w")
        command = [how.twinbench, "serve", how.scenario, *sets(how), "--speed", "max", "--no-pty", "--iiod-port", "0",
                   "--scpi-port", "0", "--esp-port", "0", "--write-bench", self.bench]  # fmt: skip
        self.process = subprocess.Popen(command, stdout=self.log, stderr=self.log)
        until = time.monotonic() + 30.0
        while not (self.bench.exists() and "tcp:" in self.bench.read_text()):
            if self.process.poll() is not None or time.monotonic() > until:
                sys.exit("serve did not come up: " + (folder / "serve.log").read_text())
            time.sleep(0.05)
        host, port = re.search(r'kind = "scpi"\naddress = "tcp:([\d.]+):(\d+)"', self.bench.read_text()).groups()
        self.address = (host, int(port))

    def memory_kB(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", status).group(1))

    def handles(self):
        return len(list(pathlib.Path(f"/proc/{self.process.pid}/fd").iterdir()))

    def strike(self, fault):
        try:
            with socket.create_connection(self.address, timeout=5.0) as line:
                line.sendall(f"SIM:FAUL {fault}\n".encode())
                time.sleep(0.02)
        except OSError as refused:
            print(f"no fault {fault}: {refused}", file=sys.stderr)

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=30.0)
        self.log.close()


def has_tables(how):
    return re.search(r'^bench = "rotary_4dof"', pathlib.Path(how.scenario).read_text(), re.MULTILINE) is not None


def sets(how):
    own = [LEVELS_APART] if has_tables(how) else []
    return [word for key in [*own, *how.set] for word in ("--set", key)]


def readings_of(how, run):
    """Of a finished run: what it read and where, without what faults and attempts may change."""
    table = run.parent / (run.name + ".csv")
    subprocess.run([how.twinbench, "export", run, "--readings", table, "--force"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return table.read_text()


def tell_difference(name, table, expected):
    """@return whether there is one; its first lines are printed."""
    if table == expected:
        return False
    apart = [pair for pair in zip(expected.splitlines(), table.splitlines()) if pair[0] != pair[1]]
    print(f"{name}: {len(apart)} lines differ of {len(expected.splitlines())}, {len(table.splitlines())} in all", flush=True)
    for line, other in apart[:3]:
        print(f"  run     {line}\n  measure {other}", flush=True)
    return True


def measure(how, server, run, chance):
    """Until it is whole. @return (faults, kills, resumes), or None if it did not become so."""
    faults = kills = 0
    for attempt in range(MOST_RESUMES + 1):
        command = [how.twinbench, "measure", how.scenario, *sets(how), "--bench", server.bench, "-o", run, "--allow-homing"]
        if attempt > 0:
            command.append("--resume")
        with open(run.parent / "measure.log", "a") as log:
            process = subprocess.Popen(command, stdout=log, stderr=log)
            is_killed = attempt == 0 and chance.random() < how.kill_share
            stop = threading.Event()
            while process.poll() is None:
                stop.wait(chance.uniform(0.1, 1.5))
                if process.poll() is not None:
                    break
                if is_killed and chance.random() < 0.3:
                    process.kill()
                    kills += 1
                elif attempt < 3:  # it must be able to end
                    server.strike(chance.choice(TABLE_FAULTS if has_tables(how) else MACHINE_FAULTS))
                    faults += 1
            if process.wait() == 0:
                return faults, kills, attempt
    return None


def main():
    how = arguments()
    chance = random.Random(how.seed)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([how.twinbench, "run", how.scenario, *sets(how), "-o", folder / "run"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        expected = readings_of(how, folder / "run")
        server = Server(how, folder)
        return soak(how, server, folder, expected, chance)


def soak(how, server, folder, expected, chance):
    begin = time.monotonic()
    runs = different = unfinished = faults = kills = resumes = 0
    warm_kB = warm_handles = largest_kB = 0
    while time.monotonic() - begin < 60.0 * how.minutes:
        run = folder / f"m{runs}"
        done = measure(how, server, run, chance)
        runs += 1
        if done is None:
            unfinished += 1
        else:
            faults, kills, resumes = faults + done[0], kills + done[1], resumes + done[2]
            different += tell_difference(run.name, readings_of(how, run), expected)
        subprocess.run(["rm", "-rf", run, folder / (run.name + ".csv")], check=True)
        largest_kB = max(largest_kB, server.memory_kB())
        if runs == WARM_UP_RUNS:
            warm_kB, warm_handles = server.memory_kB(), server.handles()
        if runs % 25 == 0:
            print(f"{(time.monotonic() - begin) / 60.0:6.1f} min, {runs} runs, {different} different, {unfinished} unfinished, "
                  f"{faults} faults, {kills} kills, {resumes} resumes, {server.memory_kB()} kB, {server.handles()} handles", flush=True)  # fmt: skip
    end_kB, end_handles = server.memory_kB(), server.handles()
    server.stop()
    print(f"{runs} runs: {different} different, {unfinished} unfinished; {faults} faults, {kills} kills, {resumes} resumes")
    print(f"server: {warm_kB} kB and {warm_handles} handles after {WARM_UP_RUNS} runs, {end_kB} kB and {end_handles} at the end, "
          f"{largest_kB} kB at most; ended with {server.process.returncode}")  # fmt: skip
    is_flat = runs > WARM_UP_RUNS and end_kB <= (1.0 + ALLOWED_GROWTH) * warm_kB and end_handles <= warm_handles
    if not is_flat:
        print("memory or handles grew, or there were too few runs to tell")
    return 0 if is_flat and different == 0 and unfinished == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
