"""`import twinbench` where there is no package, or one that was not built: it says what to do and is never an empty module."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["TWINBENCH_SCENARIOS"]).parent
BUILT = os.environ["PYTHONPATH"].split(":")[0]


def imported(folder: pathlib.Path | str, python_path: str = "") -> str:
    """What an import from this folder says last, or the folder of the package."""
    code = "import twinbench, twinbench.run; print(twinbench.__path__[0])"
    done = subprocess.run([sys.executable, "-B", "-c", code], cwd=folder, env={**os.environ, "PYTHONPATH": python_path}, capture_output=True, text=True)
    return (done.stdout or done.stderr).splitlines()[-1]


class NotBuilt(unittest.TestCase):
    def test_sources_of_the_package_say_how_it_is_built(self):
        self.assertRegex(imported("/", f"{SOURCE}/tools/python"), "ImportError: .*no compiled module.*tools/quickstart.*pip install")

    def test_folders_that_are_called_so_by_chance_say_it_too(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "twinbench").symlink_to(SOURCE)  # as git clone calls it
            for parent in (folder, SOURCE / "tools"):
                self.assertRegex(imported(parent), "ImportError: .*no package.*tools/quickstart.*pip install")

    def test_and_do_not_hide_the_package_that_was_built(self):
        self.assertEqual(imported(SOURCE / "tools", BUILT), f"{BUILT}/twinbench")


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
