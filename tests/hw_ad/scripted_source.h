#pragma once

#include <optional>
#include <utility>

#include "hw_bridge/ad/ad_source.h"
#include "twin/core/device_fault.h"

namespace twinbench::test {

/// A card whose answers and blocks a test writes down.
class ScriptedSource : public hw::AdSource {
 public:
  struct Script {
    hw::ScanSpec asked;             // what Configure got
    std::optional<double> rate_Hz;  // answers instead of what was asked
    int bits = 16;
    std::optional<double> range_V;
    double zero_V = 0.0;
    std::string serial = "S1";
    std::optional<hw::CalibrationPolynomial> calibration;
    hw::AdBlock block;
    std::optional<FaultKind> fault;
  };
  explicit ScriptedSource(Script& script) : script_(script) {}

  hw::Negotiated Configure(const hw::ScanSpec& spec) override {
    script_.asked = spec;
    hw::Negotiated n;
    n.actual = spec;
    n.actual.scan_rate_Hz = script_.rate_Hz.value_or(spec.scan_rate_Hz);
    n.bits = script_.bits;
    n.identity = "scripted card";
    n.serial = script_.serial;
    n.calibrated = script_.calibration.has_value();
    for (auto& channel : n.actual.channels) {
      channel.range_V = script_.range_V.value_or(channel.range_V);
      n.calibration.push_back(script_.calibration.value_or(hw::CalibrationPolynomial{0.0, {script_.zero_V, 1.0}}));
      n.skew_s.push_back(0.0);
    }
    return n;
  }
  hw::AdBlock Take(int /*scans*/) override {
    if (script_.fault) throw DeviceFault(*script_.fault, "scripted card", "as told");
    return script_.block;
  }

 private:
  Script& script_;
};

/// Stands still until told.
class StandingClock : public Clock {
 public:
  Time Now() const override { return now; }
  void Wait(Duration duration) override { now += duration; }
  Time now{};
};

}  // namespace twinbench::test
