#!/usr/bin/env python3
"""Writes encoder.csv beside it: a rotary table read by its own encoder and by a better one. Shares nothing with the program.

Two hidden causes: 36 arcsec (0.010 deg) of play, half of it on either side, and a ring that its six screws deform, 14.4 arcsec (0.004 deg).
Noise of the encoder 0.0008 deg, of the reference 0.0002 deg. Stops every 5.1 deg over two turns, forward, back, forward, back.
"""
import math
import pathlib
import random

draw = random.Random(51)
stops_deg = [2.5 + 5.1 * k for k in range(142)]
rows = ["# made by encoder.py, which says what is hidden here", "reference_deg,encoder_deg"]
for direction, passed in [(1, stops_deg), (-1, stops_deg[::-1])] * 2:
    for angle_deg in passed:
        error_deg = 0.004 * math.cos(math.radians(6 * angle_deg + 25)) - direction * 0.010 / 2
        rows.append(f"{angle_deg + draw.gauss(0, 0.0002):.4f},{angle_deg + error_deg + draw.gauss(0, 0.0008):.4f}")
(pathlib.Path(__file__).parent / "encoder.csv").write_text("\n".join(rows) + "\n")
