#pragma once

#include "twin/core/devices.h"

/// Devices that the bench file does not have (kind "none").
namespace twinbench::hw {

/// Nobody knows the temperature: NaN.
class NoThermometer : public Thermometer {
 public:
  double Read_degC() override { return kNaN; }
};

/// @throws DeviceFault kRefused when a procedure needs one.
class NoAutocollimator : public Autocollimator {
 public:
  AutocollimatorReading Read() override;
};

/// @throws DeviceFault kRefused when a procedure needs one.
class NoGoniometer : public Goniometer {
 public:
  void MoveTo(double yaw_rad, double tilt_rad) override;
};

}  // namespace twinbench::hw
