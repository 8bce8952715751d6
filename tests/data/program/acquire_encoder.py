"""A laboratory's own acquisition, in closed form: an encoder that sits off centre and lags behind a play.

usage: acquire_encoder.py scenario.toml stops.csv readings.csv [eccentricity_deg [play_deg [mode]]]
mode: "missing" leaves every tenth stop out, "extra" adds a row that nobody asked for, "hang" never ends,
      "fail" ends with code 3, "silent" writes nothing.
Shares nothing with the twin: error = eccentricity * sin(reference) + play / 2 * direction + noise.
"""
import csv
import hashlib
import math
import random
import sys
import time

scenario, stops, readings = sys.argv[1:4]
eccentricity_deg = float(sys.argv[4]) if len(sys.argv) > 4 else 0.02
play_deg = float(sys.argv[5]) if len(sys.argv) > 5 else 0.0
mode = sys.argv[6] if len(sys.argv) > 6 else ""
NOISE_DEG = 0.002

if mode == "hang":
    time.sleep(3600)
if mode == "fail":
    sys.exit(3)
if mode == "silent":
    sys.exit(0)

with open(scenario, "rb") as file:
    seed = int(hashlib.sha256(file.read()).hexdigest()[:8], 16)
noise = random.Random(seed)

with open(stops, newline="") as file:
    rows = list(csv.DictReader(file))

turned = 1.0
with open(readings, "w", newline="") as file:
    out = csv.writer(file)
    out.writerow(["reading", "measured_deg"])
    for number, row in enumerate(rows):
        if mode == "missing" and number % 10 == 9:
            continue
        reference_deg = float(row["reference_deg"])
        direction = float(row.get("direction") or 0)
        turned = direction if direction else turned
        error_deg = eccentricity_deg * math.sin(math.radians(reference_deg)) - 0.5 * play_deg * turned
        out.writerow([row["reading"], repr(reference_deg + error_deg + noise.gauss(0.0, NOISE_DEG))])
    if mode == "extra":
        out.writerow([len(rows) + 1000, "1.0"])
