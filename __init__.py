"""No package: a folder of the sources, found because it is called twinbench. Instead of an empty module, the package is looked for elsewhere."""

import importlib.machinery
import importlib.util
import os
import sys

_here = os.path.realpath(os.path.dirname(__path__[0]))
_spec = importlib.machinery.PathFinder.find_spec(__name__, [path for path in sys.path if os.path.realpath(path) != _here])
if _spec is None or _spec.origin is None:
    raise ImportError(
        f"twinbench: {__path__[0]} holds sources and is no package; in a clone: tools/quickstart, then PYTHONPATH=build/python /usr/bin/python3, "
        "or `pip install .`"
    )
sys.modules[__name__] = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(sys.modules[__name__])
