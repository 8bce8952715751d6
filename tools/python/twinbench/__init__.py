"""twinbench: a virtual bench for calibrating rotary tables, in Python.

    import twinbench as tb

    run = tb.run("scenarios/rotary_4dof.toml")    # simulated; tb.SCENARIOS is the folder of those that come with the package
    run.readings["target_deg"]                    # a numpy array; run.readings.frame(): pandas
    run.results["separation"]["target"]           # as in results.json
    tb.diagnose(run)["verdict"]
    tb.report(run, "page.html")

Everything is what the command line does, to the same bits. Angles and lengths carry their unit in their name; what has
none in its name is SI. Wrong input raises InputError with where, what and what was expected; a failing bench raises
BenchError. Long calls let other threads run.
"""

try:
    from ._core import BenchError, InputError, __version__
except ModuleNotFoundError as missing:
    if missing.name != f"{__name__}._core":
        raise
    import sys as _sys

    raise ImportError(
        "twinbench: {0} has no compiled module for Python {1.major}.{1.minor}; in a clone: tools/quickstart builds it for Debian's Python "
        "(PYTHONPATH=build/python /usr/bin/python3), `pip install .` for the Python that runs it".format(__path__[0], _sys.version_info)
    ) from None
from .benches import AngleBench, RotaryBench, TableState
from .machines import AxisState, MachineBench
from .motions import error_motion
from .readings import Readings
from .results import Budget, Certificate, Compensation, Uncertainty, budget, certificate, compensate, report, uncertainty
from .run import Diagnosis, Follow, Run, diagnose, drive, frame, import_recording, load, run, score, separate
from .scenario import SCENARIOS, Scenario
from .shown import Results
from .studies import Campaign, Investigation, Plan, campaign, investigate, plan

__all__ = [
    "AngleBench", "AxisState", "BenchError", "Budget", "Campaign", "Certificate", "Compensation", "Diagnosis", "Follow", "InputError",
    "Investigation", "MachineBench", "Plan", "Readings", "Results", "RotaryBench", "Run", "SCENARIOS", "Scenario", "TableState",
    "Uncertainty", "__version__", "budget", "campaign", "certificate", "compensate", "diagnose", "drive", "error_motion", "frame",
    "import_recording", "investigate", "load", "plan", "report", "run", "score", "separate", "uncertainty",
]
