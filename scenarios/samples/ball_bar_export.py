#!/usr/bin/env python3
"""Writes ball_bar.b5r beside it: a ball bar of 150 mm as software of bars exports it, tags and then the values of each run. Shares nothing
with the program. Tags and their order are made up after such files; a program that reads them takes what it knows.

Hidden: the angle from +X to +Y is 30 microradian (6.19 arcsec) too large, X moves 20 um/m too far, Y 10 um/m too little, Y has 5 um of
backlash; the ball stands (10, -4) um off the centre. 180 deg of overshoot before and behind the circle are in the values. Noise 0.1 um.
"""
import math
import pathlib
import random

RADIUS_UM, FEED_MM_MIN, SAMPLES_HZ = 150000.0, 1000.0, 20.0
STEP = FEED_MM_MIN / 60.0 / SAMPLES_HZ / (RADIUS_UM / 1000.0)
draw = random.Random(230)


def deviation_um(angle, direction):
    x, y = RADIUS_UM * math.cos(angle), RADIUS_UM * math.sin(angle)
    along = math.remainder(direction * angle - 0.5 * math.pi, math.pi)  # Y turns round at 90 and at 270 deg
    since = RADIUS_UM * (1.0 - math.cos(along if along >= 0.0 else along + math.pi))
    sense = 1.0 if x * direction > 0.0 else -1.0
    behind = sense * (2.5 - min(since, 5.0))
    return math.hypot(10.0 + x * (1.0 + 20e-6) - 30e-6 * y, -4.0 + y * (1.0 - 10e-6) + behind) - RADIUS_UM + draw.gauss(0.0, 0.1)


lines = ["[BALLBAR TEST]", "VERSION=5.10", "MACHINE=made by ball_bar_export.py, which says what is hidden here", "PLANE=XY", f"RADIUS={RADIUS_UM / 1000.0:.4f}",
         f"FEEDRATE={FEED_MM_MIN:.0f}", "START ANGLE=0", "END ANGLE=360", "OVERSHOOT=180", f"SAMPLE RATE={SAMPLES_HZ:.2f}", "TEMPERATURE=20.4", "COEFFICIENT=11.7", "UNITS=um"]
for number, (direction, name) in enumerate([(1, "CCW"), (-1, "CW")], start=1):
    lines += [f"[RUN {number}]", f"DIRECTION={name}", "[DATA]"]
    count = round(4.0 * math.pi / STEP)
    for k in range(count + 1):
        angle = -math.pi + k * 4.0 * math.pi / count if direction > 0 else 3.0 * math.pi - k * 4.0 * math.pi / count
        lines.append(f"{deviation_um(angle, direction):.2f}")
    lines.append("[END]")
(pathlib.Path(__file__).parent / "ball_bar.b5r").write_text("\n".join(lines) + "\n")
