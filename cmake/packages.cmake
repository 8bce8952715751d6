# The Debian packages behind these names are listed in tools/packages.txt.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(Ceres REQUIRED)

find_package(embree 4 QUIET)  # the headers are chosen in the same order
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()
pkg_check_modules(Bullet REQUIRED IMPORTED_TARGET bullet-float64)
# OpenEXR by pkg-config: the CMake files of Debian 12 ask for Python parts of Imath that the package does not bring.
pkg_check_modules(OpenEXR REQUIRED IMPORTED_TARGET OpenEXR)
set_property(TARGET PkgConfig::OpenEXR PROPERTY INTERFACE_COMPILE_OPTIONS)  # -pthread: precompiled headers would have to have it too
pkg_check_modules(SQLite REQUIRED IMPORTED_TARGET sqlite3)
pkg_check_modules(Tomlplusplus REQUIRED IMPORTED_TARGET tomlplusplus)
find_package(pugixml REQUIRED)
find_path(ASIO_INCLUDE asio.hpp REQUIRED)
find_path(BOOST_MATH_INCLUDE boost/math/special_functions/gamma.hpp REQUIRED)  # Boost.Math, headers only

# Campaigns on many machines: a build without MPI refuses --mpi.
option(TWINBENCH_MPI "Campaigns through MPI, if it is installed" ON)
if(TWINBENCH_MPI)
  find_package(MPI COMPONENTS CXX)
endif()
set(TWINBENCH_HAS_MPI ${MPI_CXX_FOUND})

if(TWINBENCH_TESTS)
  find_package(GTest REQUIRED)
  find_package(benchmark REQUIRED)
endif()

# A/D drivers: a build without one refuses bench files that ask for it.
option(TWINBENCH_IIO "A/D cards through libiio, if it is installed" ON)
option(TWINBENCH_COMEDI "A/D cards through comedilib, if it is installed" ON)
if(TWINBENCH_IIO)
  pkg_check_modules(Iio IMPORTED_TARGET libiio)
endif()
if(TWINBENCH_COMEDI)
  pkg_check_modules(Comedi IMPORTED_TARGET comedilib)
endif()
option(TWINBENCH_MODBUS "Instruments behind Modbus gateways through libmodbus, if it is installed" ON)
if(TWINBENCH_MODBUS)
  pkg_check_modules(Modbus IMPORTED_TARGET libmodbus)
endif()
message(STATUS "twinbench drivers: libiio ${Iio_VERSION}, comedilib ${Comedi_VERSION}, libmodbus ${Modbus_VERSION}")

# The Python package is for Debian's Python, not for another one before it on the path: numpy and pandas are Debian's too.
option(TWINBENCH_PYTHON "Build the Python package, if pybind11 is installed" ON)
if(TWINBENCH_PYTHON)
  set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Python that the package is for")
  find_package(Python 3.11 COMPONENTS Interpreter Development.Module OPTIONAL_COMPONENTS Development.Embed)
  find_package(pybind11 CONFIG)
endif()
if(Python_FOUND AND pybind11_FOUND)
  set(TWINBENCH_HAS_PYTHON TRUE)
else()
  message(STATUS "twinbench Python package: not built; it needs pybind11-dev and python3-dev")
endif()

# Pages of results are bundled by Node: a build without it refuses `twinbench report`.
option(TWINBENCH_REPORT "Pages of results (twinbench report); needs npm and, once, its registry" ON)
find_program(NPM npm)
find_program(NODE NAMES node nodejs)
if(TWINBENCH_REPORT AND NPM AND NODE)
  set(TWINBENCH_HAS_REPORT ON)
else()
  set(TWINBENCH_HAS_REPORT OFF)
  message(STATUS "twinbench report: no pages (npm is not installed, or TWINBENCH_REPORT=OFF)")
endif()
