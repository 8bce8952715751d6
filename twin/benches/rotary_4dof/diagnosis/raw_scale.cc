#include <algorithm>
#include <cmath>

#include "twin/benches/rotary_4dof/bench.h"
#include "twin/benches/rotary_4dof/settings.h"
#include "twin/core/errors.h"
#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/screen.h"

namespace twinbench::benches::rotary {

diagnose::RawScale RawScaleOf(const Scenario& scenario, const diagnose::LinearRun& run) {
  const RotarySettings& own = RotaryOf(scenario);
  const double code_V = std::ldexp(2.0 * own.adc.range_V, -own.adc.bits);
  diagnose::RawScale scale{{}, {}, own.adc.rate_Hz / kChannels};
  for (const std::string& name : own.adc.scan_list) {
    const auto* found = std::ranges::find(kChannelNames, name);
    Require(found != kChannelNames.end(), "the scan list names the channels of the bench");
    scale.scan.push_back(static_cast<int>(found - kChannelNames.begin()));
  }
  for (int c = 0; c < run.Channels(); ++c) {
    const double code_m = code_V / (c < kChannels / 2 ? own.psd_a.sensitivity_V_m : own.psd_b.sensitivity_V_m);
    scale.channels.push_back({run.channels[c], code_m, diagnose::screen::AsAngle(run, c, code_m)});
  }
  return scale;
}

}  // namespace twinbench::benches::rotary
