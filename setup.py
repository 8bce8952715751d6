"""`pip install .`: CMake builds the package and setuptools packs it (pyproject.toml). CMAKE_ARGS of the environment go to CMake."""

import atexit
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
PYTHON = os.path.realpath(sys.executable)


def is_for_this_python(build: Path) -> bool:
    cache = build / "CMakeCache.txt"
    found = re.search("^Python_EXECUTABLE:.*=(.+)$", cache.read_text(), re.M) if cache.exists() else None
    return found is not None and os.path.realpath(found[1]) == PYTHON and re.search("^pybind11_DIR:.*/", cache.read_text(), re.M) is not None


def configured() -> Path:
    """build/ where that is for this Python, else build-pip/: for another Python only the module is compiled anew."""
    if is_for_this_python(ROOT / "build"):
        return ROOT / "build"
    build = ROOT / "build-pip"
    options = ["--fresh"] if not is_for_this_python(build) else []
    options += [f"-DPython_EXECUTABLE={PYTHON}", "-DCMAKE_BUILD_TYPE=Release", "-DTWINBENCH_TESTS=OFF",
                "-DCMAKE_REQUIRE_FIND_PACKAGE_pybind11=ON", "-DCMAKE_REQUIRE_FIND_PACKAGE_Python=ON"]
    try:
        import pybind11  # of an isolated build

        options.append(f"-Dpybind11_DIR={pybind11.get_cmake_dir()}")
    except ModuleNotFoundError:
        pass
    subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", *options, *shlex.split(os.environ.get("CMAKE_ARGS", ""))], check=True)
    return build


class ByCMake(build_ext):
    """Puts in place what `cmake --install --component python` installs."""

    def build_extension(self, extension):
        build = configured()
        subprocess.run(["cmake", "--build", build, "--target", "twinbench_python", "-j", str(os.cpu_count())], check=True)
        with tempfile.TemporaryDirectory() as prefix:
            subprocess.run(["cmake", "--install", build, "--component", "python", "--prefix", prefix], check=True)
            shutil.copytree(f"{prefix}/lib/python3/dist-packages/twinbench", Path(self.build_lib, "twinbench"), dirs_exist_ok=True)


scratch = tempfile.mkdtemp()  # build/ is CMake's
atexit.register(shutil.rmtree, scratch, ignore_errors=True)
setup(
    version=re.search(r"project\(twinbench VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1],
    packages=["twinbench"],
    package_dir={"": "tools/python"},
    ext_modules=[Extension("twinbench._core", sources=[])],
    cmdclass={"build_ext": ByCMake},
    options={"build": {"build_base": scratch}, "egg_info": {"egg_base": scratch}},
)
