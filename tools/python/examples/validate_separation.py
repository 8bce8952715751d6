# %% [markdown]
# # Are two estimators as good as they say?
# The same twin, twenty times with other noise; weighted least squares ("rigorous") and the paper's equations against the errors that were
# put in. Open this file as a notebook (jupytext, VS Code) or run it: `python3 tools/python/examples/validate_separation.py`.

# %%
import pathlib

import numpy as np
import twinbench as tb

SCENARIOS = pathlib.Path(__file__).resolve().parents[3] / "scenarios"
scenario = tb.Scenario(SCENARIOS / "rotary_4dof.toml", {"procedure.positions": 12})
runs = [tb.run(scenario.changed({"repeat": k})) for k in range(20)]

# %% [markdown]
# Errors in stated uncertainties: 1 if the uncertainty is right. Means are taken out, as no index offset shows them.

# %%
def chi2(run: tb.Run, estimator: str) -> float:
    found = tb.separate(run.scenario, run.readings, estimator)["target"]
    truth = run.truth["target"]
    expected = np.interp(found["position_deg"], truth["position_deg"], truth["ez_arcsec"])
    off = found["ez_arcsec"] - expected
    return np.mean(((off - off.mean()) / found["u_ez_arcsec"]) ** 2)


for estimator in ("rigorous", "published"):
    values = [chi2(run, estimator) for run in runs]
    print(f"{estimator:10}: (error / u)^2 of ez = {np.mean(values):.2f} ± {np.std(values) / np.sqrt(len(values)):.2f}")
