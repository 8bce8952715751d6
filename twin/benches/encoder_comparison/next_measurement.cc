#include <vector>

#include "twin/benches/encoder_comparison/bench.h"
#include "twin/diagnose/splits.h"

namespace twinbench::benches::encoder {
namespace {

/// The first that has both counts.
const std::vector<diagnose::Split>& Splits() {
  static const std::vector<diagnose::Split> splits = {
      {{"eccentricity", "signal_offset"},
       "device.signal_periods if its signals have several periods per turn, for an offset then shows in that order; or another "
       "mounting, centred anew, for an eccentricity changes with it and an offset does not; or the raw sine and cosine signals, whose offsets are their means; or a second reading head opposite the first, which sees the "
       "eccentricity with the other sign"},
      {{"ellipticity", "amplitude_mismatch", "quadrature_error"},
       "the raw sine and cosine signals: their sizes and phase are read directly"},
      {{"backlash", "hysteresis"},
       "readings close behind a reversal, every tenth of the way over which the difference builds up"},
      {{"backlash", "latency", "hysteresis"}, "the same passes at half and at twice the speed, and measuring positions at rest"},
      {{"clock_rate", "latency", "scale", "hysteresis", "backlash"},
       "the same passes at another speed, and again after some minutes without a new start of the clocks"},
      {{"settling", "hysteresis", "backlash", "latency"}, "several readings at every measuring position while it comes to rest"},
      {{"interpolation", "gear_mesh", "periodic"}, "the same run with the gear taken out"},
      {{"drift", "slip", "outliers"}, "a quarter of an hour at rest at one angle, and the same passes again"},
      {{"drift", "scale", "backlash"}, "several turns in both directions, with a return to the first angle"}};
  return splits;
}

}  // namespace

std::string NextMeasurement(const std::string& effect, const std::string& rival) {
  if (effect == "reference_fault" || rival == "reference_fault")
    return "a further mounting with the device turned on the shaft: what turns along is the device's";
  return diagnose::WhatSplits(Splits(), effect, rival,
                              "more turns in both directions, at two speeds, at closer angles");
}

}  // namespace twinbench::benches::encoder
