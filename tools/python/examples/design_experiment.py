# %% [markdown]
# # Where should the light go to see a laser that turns?
# The twin that follows a record gives the slope of every reading by every input. What a run of a given kind would tell of an
# input is in these slopes: here the least drift of the laser's yaw that stands out, by how long the run takes.

# %%
import pathlib

import numpy as np
import twinbench as tb

SCENARIOS = pathlib.Path(__file__).resolve().parents[3] / "scenarios"


def least_drift_urad_h(dwell_s: float) -> float:
    """Of the laser's yaw, at three standard uncertainties, with the tables' own errors left free at every measuring position."""
    scenario = tb.Scenario(SCENARIOS / "rotary_4dof.toml", {"procedure.positions": 12, "procedure.dwell_s": [dwell_s]})
    readings = tb.run(scenario).readings
    full = np.array([phase == "full_circle" for phase in readings["phase"]])
    hours = readings["time_s"][full] / 3600.0
    signal = tb.Follow(scenario, readings).slope("laser.yaw")[full, 0] * hours  # m per rad/h, on psd_a_x
    angles_deg = np.stack([readings["target_deg"], readings["reference_deg"]])[:, full] % 360.0
    stops = np.unique(angles_deg, axis=1, return_inverse=True)[1]
    left = signal - (np.bincount(stops, signal) / np.bincount(stops))[stops]
    noise_m = np.nanmean(readings["psd_a_x_std_V"][full]) / np.sqrt(readings["n_samples"][full][0]) / 2000.0
    return 3.0 * noise_m / np.sqrt(np.sum(left**2)) * 1e6


# %%
for dwell_s in (1.0, 5.0, 20.0):
    print(f"dwell {dwell_s:4.0f} s: a drift of {least_drift_urad_h(dwell_s):.3f} urad/h stands out")
