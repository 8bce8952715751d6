#!/usr/bin/env python3
"""Writes gear_train.csv beside it: a worm gear of 40 : 1 with an encoder on the motor and one on the table. Shares nothing with the program.

Hidden: the table errs by 42 arcsec once and 9 arcsec twice per turn, by 15 arcsec once per turn of the worm; the way back stays 20 arcsec behind.
Noise 0.5 arcsec.
"""
import math
import pathlib
import random

RATIO, ROWS_A_TURN, TURNS = 40, 360, 3
draw = random.Random(40)


def table_deg(motor_deg, direction):
    even = motor_deg / RATIO
    error = 42.0 * math.cos(math.radians(even + 110.0)) + 9.0 * math.cos(math.radians(2.0 * even + 20.0)) + 15.0 * math.cos(math.radians(motor_deg - 35.0))
    return even + (error - 10.0 * direction + draw.gauss(0.0, 0.5)) / 3600.0


rows = ["Worm gear, motor and table encoder; made by gear_train.py, which says what is hidden here", "time [s];motor [deg];table [deg]"]
rows_a_pass = TURNS * ROWS_A_TURN
for k in range(2 * rows_a_pass):
    direction = 1 if k < rows_a_pass else -1
    step = k if direction > 0 else 2 * rows_a_pass - 1 - k
    motor = step * 360.0 * RATIO / ROWS_A_TURN + 3.0
    rows.append(f"{0.05 * k + (2.0 if direction < 0 else 0.0):.3f};{motor:.4f};{table_deg(motor, direction):.5f}")
(pathlib.Path(__file__).parent / "gear_train.csv").write_text("\n".join(rows) + "\n")
