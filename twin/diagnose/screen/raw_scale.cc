#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/diagnose/screen/screen.h"
#include "twin/diagnose/screen/sizes.h"

namespace twinbench::diagnose {
namespace {

std::vector<int> ScanOf(const std::vector<std::string>& scan_list) {
  std::vector<int> scan;
  for (const std::string& name : scan_list) {
    const auto found = std::find(kChannelNames.begin(), kChannelNames.end(), name);
    Require(found != kChannelNames.end(), "the scan list names the channels of the bench");
    scan.push_back(static_cast<int>(found - kChannelNames.begin()));
  }
  return scan;
}

}  // namespace

RawScale RawScaleOf(const Scenario& scenario, const LinearRun& run) {
  const double code_V = std::ldexp(2.0 * scenario.adc.range_V, -scenario.adc.bits);
  RawScale scale{{}, ScanOf(scenario.adc.scan_list), scenario.adc.rate_Hz / kChannels};
  for (int c = 0; c < run.Channels(); ++c) {
    const PsdSettings& psd = c < kChannels / 2 ? scenario.psd_a : scenario.psd_b;
    const double code_m = code_V / psd.sensitivity_V_m;
    scale.channels.push_back({run.channels[static_cast<std::size_t>(c)], code_m, screen::AsAngle(run, c, code_m)});
  }
  return scale;
}

}  // namespace twinbench::diagnose
