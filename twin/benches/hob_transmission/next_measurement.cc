#include <vector>

#include "twin/benches/hob_transmission/bench.h"
#include "twin/diagnose/splits.h"

namespace twinbench::benches::hob {
namespace {

/// The first that has both counts.
const std::vector<diagnose::Split>& Splits() {
  static const std::vector<diagnose::Split> splits = {
      {{"hob_runout", "eccentricity", "gear_mesh", "ellipticity"},
       "the same run with the interferometer, which sees the drive but not the encoders; or a second reading head "
       "on "
       "the hob's encoder"},
      {{"backlash", "latency", "hysteresis"},
       "the same passes at half and at twice the speed: a delay grows with it; and samples close behind a "
       "reversal"},
      {{"worm", "gear_mesh", "periodic", "hob_runout"},
       "one more mounting with ring and head at another place: what turns along is the ring's"},
      {{"signal_offset", "amplitude_mismatch", "quadrature_error"},
       "the raw sine and cosine of the hob's encoder, whose offsets, sizes and phase are read directly"},
      {{"tone", "gear_mesh", "worm", "periodic", "hob_runout"},
       "the same passes at half or at twice the speed: a vibration keeps its frequency, what errs with an angle does not"},
      {{"drift", "slip", "tone", "outliers"},
       "a quarter of an hour with the chain at rest, and the same passes again"},
      {{"drift", "backlash", "latency", "hysteresis"}, "more passes in the order + - - +"}};
  return splits;
}

}  // namespace

std::string NextMeasurement(const std::string& effect, const std::string& rival) {
  if (effect == "slip" && rival == "slip")
    return "both encoders' reference marks once more: the count that its mark no longer meets has slipped";
  return diagnose::WhatSplits(
      Splits(), effect, rival,
      "three or more places of ring and head, passes in both directions at two speeds, and the interferometer");
}

}  // namespace twinbench::benches::hob
