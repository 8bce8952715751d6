"""twinbench: a virtual bench for calibrating rotary tables, in Python.

    import twinbench as tb

    scenario = tb.Scenario("scenarios/rotary_4dof.toml", {"procedure.positions": 12})
    run = tb.run(scenario)                        # on the twin
    run.readings["target_deg"]                    # a numpy array; run.readings.frame(): pandas
    run.results["separation"]["target"]           # as in results.json
    tb.diagnose(scenario, run.readings)["verdict"]

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
from .run import Diagnosis, Follow, Run, diagnose, drive, frame, load, run, score, separate
from .scenario import Scenario
from .studies import Campaign, Investigation, Plan, campaign, investigate, plan

__all__ = [
    "AngleBench", "AxisState", "BenchError", "Campaign", "Diagnosis", "Follow", "InputError", "Investigation", "MachineBench", "Plan", "Readings", "RotaryBench",
    "Run", "Scenario", "TableState", "__version__", "campaign", "diagnose", "drive", "error_motion", "frame", "investigate", "load", "plan", "run", "score",
    "separate",
]
