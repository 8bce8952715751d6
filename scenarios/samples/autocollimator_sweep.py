#!/usr/bin/env python3
"""Writes autocollimator_sweep.csv beside it: an autocollimator against a small angle generator, there and back. Shares nothing with the program.

Hidden: the scale is 1.0042, the pixels make a ripple of 0.21 arcsec with a period of 12.4 arcsec, the crosshair is rolled by 3 mrad. Noise 0.05 arcsec.
"""
import math
import pathlib
import random

draw = random.Random(7)
rows = ["Autocollimator against small angle generator; made by autocollimator_sweep.py, which says what is hidden here",
        "generator [arcsec],autocollimator x [arcsec],autocollimator y [arcsec],direction"]
there = [-120.0 + 1.5 * k for k in range(161)]
for direction, angles in ((1, there), (-1, there[::-1])):
    for angle in angles:
        x = 0.7 + 1.0042 * angle + 0.21 * math.sin(2.0 * math.pi * angle / 12.4 + 0.8) + draw.gauss(0.0, 0.05)
        y = -0.4 + 0.003 * 1.0042 * angle + draw.gauss(0.0, 0.05)
        rows.append(f"{angle:.2f},{x:.3f},{y:.3f},{direction}")
(pathlib.Path(__file__).parent / "autocollimator_sweep.csv").write_text("\n".join(rows) + "\n")
