"""A laboratory's own acquisition, in closed form: an encoder on a reference, with one fault drawn by a seed.

usage: acquire_hidden.py scenario.toml stops.csv readings.csv seed
What was hidden is written beside the readings, truth.txt: the catalogue's name, or "unlisted", and its size.
Shares nothing with the twin. Sizes are 4 to 20 standard deviations of the noise, all readings of the first run together.
"""
import csv
import hashlib
import math
import os
import random
import re
import sys

NOISE_DEG = 0.002
READINGS, RUN_H, TRAVEL_DEG = 144, 0.158, 710.0  # of the first run: 36 stops a turn, two turns, forth and back

scenario, stops, readings, seed = sys.argv[1:5]
with open(scenario) as file:
    text = file.read()
found = re.search(r"^repeat = (\d+)", text, re.MULTILINE)
run = int(found.group(1)) if found else 0
found = re.search(r"^mounting_deg = \[(.*)\]", text, re.MULTILINE)
mountings_deg = [float(word) for word in found.group(1).split(",")] if found else [0.0]

draw = random.Random(int(seed))
fault = draw.choice(["eccentricity", "ellipticity", "periodic", "drift", "scale", "slip", "backlash", "half order",
                     "one way"])
length_deg = math.exp(draw.uniform(math.log(4.0), math.log(20.0))) * NOISE_DEG / math.sqrt(READINGS)  # rms
phase = draw.uniform(0.0, 2.0 * math.pi)
order = {"eccentricity": 1, "ellipticity": 2, "periodic": draw.randint(5, 9), "half order": draw.randint(2, 9) + 0.5,
         "one way": draw.randint(2, 5)}.get(fault, 0)
slips_at = draw.randint(30, 115)
share = slips_at / READINGS


class Device:
    """What it shows beyond the reference."""

    def __init__(self):
        self.behind_deg = None  # play: how far the device is behind the middle of the gap

    def error_deg(self, number, turned_deg, mounted_deg, time_h, direction):
        device_rad = math.radians(turned_deg + mounted_deg)
        wave = math.sqrt(2.0) * length_deg * math.cos(order * device_rad + phase)
        if fault == "drift":
            return length_deg * math.sqrt(12.0) / RUN_H * time_h
        if fault == "scale":
            return length_deg * math.sqrt(12.0) / TRAVEL_DEG * turned_deg
        if fault == "slip":
            return length_deg / math.sqrt(share * (1.0 - share)) if run > 0 or number >= slips_at else 0.0
        if fault == "backlash":
            if direction:
                self.behind_deg = length_deg * direction
            return -(self.behind_deg or 0.0)
        if fault == "one way":
            return wave * direction
        return wave


with open(stops, newline="") as file:
    rows = list(csv.DictReader(file))
noise = random.Random(int(hashlib.sha256((text + seed).encode()).hexdigest()[:8], 16))
device = Device()
with open(readings, "w", newline="") as file:
    out = csv.writer(file)
    out.writerow(["reading", "measured_deg"])
    for row in rows:
        reference_deg = float(row["reference_deg"])
        mounted_deg = mountings_deg[min(int(row["setup"]), len(mountings_deg) - 1)]
        error_deg = device.error_deg(int(row["reading"]), reference_deg, mounted_deg, float(row["time_s"]) / 3600.0,
                                     int(row["direction"]))
        shown_deg = reference_deg + mounted_deg + error_deg + noise.gauss(0.0, NOISE_DEG)
        out.writerow([row["reading"], repr(shown_deg)])
with open(os.path.join(os.path.dirname(readings), "truth.txt"), "w") as file:
    named = fault if fault not in ("half order", "one way") else "unlisted"
    file.write(f"{named}\n{fault} of {length_deg * math.sqrt(READINGS) / NOISE_DEG:.1f} sigma\n")
