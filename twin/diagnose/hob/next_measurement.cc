#include "twin/diagnose/hob/next_measurement.h"

#include <algorithm>
#include <vector>

namespace twinbench::diagnose::hob {
namespace {

struct Split {
  std::vector<std::string> effects;  // any two of them
  std::string words;
};

/// The first that has both counts.
const std::vector<Split>& Splits() {
  static const std::vector<Split> splits = {
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
      {{"drift", "slip", "tone", "outliers"},
       "a quarter of an hour with the chain at rest, and the same passes again"},
      {{"drift", "backlash", "latency", "hysteresis"}, "more passes in the order + - - +"}};
  return splits;
}

bool Has(const Split& split, const std::string& effect) {
  return std::ranges::find(split.effects, effect) != split.effects.end();
}

}  // namespace

std::string NextMeasurement(const std::string& effect, const std::string& rival) {
  if (effect == "slip" && rival == "slip")
    return "both encoders' reference marks once more: the count that its mark no longer meets has slipped";
  for (const Split& split : Splits()) {
    if (Has(split, effect) && Has(split, rival)) return split.words;
  }
  return "three or more places of ring and head, passes in both directions at two speeds, and the interferometer";
}

}  // namespace twinbench::diagnose::hob
