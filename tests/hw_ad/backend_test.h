#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "hw_bridge/ad/ad_converter.h"
#include "tests/hw_ad/held_twin.h"
#include "tests/hw_ad/same_block.h"
#include "twin/core/device_fault.h"

namespace twinbench::test {

/// The kind of fault that a call ends in; "none".
template <class Call>
std::string FaultIn(const Call& call) {
  try {
    call();
  } catch (const DeviceFault& fault) {
    return FaultName(fault.kind());
  }
  return "none";
}

inline hw::AdSettings IioSettings(const HeldTwin& served) {
  hw::AdSettings settings;
  settings.kind = "iio";
  settings.uri = "ip:127.0.0.1:" + std::to_string(served.iiod_port());
  settings.device = "psd-adc16";
  settings.channels = {"voltage0", "voltage1", "voltage2", "voltage3"};
  settings.light = "light";
  settings.timeout_s = 0.5;
  return settings;
}

inline hw::AdSettings ComediSettings(const HeldTwin& served) {
  setenv("TWINBENCH_COMEDI_TWIN", ("127.0.0.1:" + std::to_string(served.iiod_port())).c_str(), 1);
  hw::AdSettings settings;
  settings.kind = "comedi";
  settings.device = "/dev/comedi0";
  settings.channels = {"0", "1", "2", "3"};
  settings.light = "1";
  settings.timeout_s = 0.5;
  return settings;
}

/// The same acquisitions, at the same bench times, on a twin in this process and through a backend.
inline void ExpectTheTwinsOwnBlocks(AdConverter& card, HeldTwin& served, const Scenario& scenario) {
  sim::Twin twin(scenario);
  RotaryBench bench = twin.Bench();
  for (const int scans : {100, 1, 2, 1000, 20000}) {
    ExpectSameBlock(card.Acquire(scans, true), bench.adc.Acquire(scans, true));
    bench.clock.Wait(std::chrono::milliseconds(1234));
    served.Wait(std::chrono::milliseconds(1234));
  }
}

}  // namespace twinbench::test
