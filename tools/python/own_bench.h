#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "twin/core/devices.h"

/// Benches whose devices are methods of a Python object (twinbench/benches.py says which). Each call takes the
/// interpreter's lock for itself, so a procedure runs without it.
namespace twinbench::python {

/// The devices of a rotary bench.
class OwnRotaryBench {
 public:
  /// @throws InputError if the object lacks a method.
  explicit OwnRotaryBench(pybind11::object bench);
  ~OwnRotaryBench();
  RotaryBench Bench();

 private:
  struct Devices;
  std::unique_ptr<Devices> devices_;
};

/// An angle device and its reference: take(time_s, reference_rad, velocity_rad_s, direction) -> what both showed.
class OwnAngleComparator : public AngleComparator {
 public:
  explicit OwnAngleComparator(pybind11::object bench);
  ~OwnAngleComparator() override;
  void Take(Reading& reading) override;

 private:
  pybind11::object bench_;
};

}  // namespace twinbench::python
