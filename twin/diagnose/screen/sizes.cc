#include "twin/diagnose/screen/sizes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace twinbench::diagnose::screen {

std::string Amount(const LinearRun& run, double value_SI) {
  return fmt::format("{:.3g} {}", value_SI / run.to_SI, run.unit);
}

bool IsAngle(const std::string& pattern) {
  return pattern == "yaw" || pattern == "tilt" || pattern == "roll";
}

bool ReadsAngles(const LinearRun& run) {
  return run.unit == "arcsec" || run.unit == "deg" || run.unit == "rad";
}

double AsAngle(const LinearRun& run, int channel, double size_SI) {
  if (ReadsAngles(run)) return size_SI;
  double shown = 0.0;
  for (const Pattern& p : run.patterns) {
    if (IsAngle(p.name)) shown = std::max(shown, std::abs(p.weight[channel]));
  }
  return shown > 0.0 ? size_SI / shown : kNaN;
}

void SetEffect(const LinearRun& run, int channel, double size_SI, ScreenTest& test) {
  test.effect_m = ReadsAngles(run) ? kNaN : size_SI;
  test.effect_rad = AsAngle(run, channel, size_SI);
}

int AnyChannel(const LinearRun& run) {
  int most = 0;
  for (int c = 1; c < run.Channels(); ++c) {
    if (AsAngle(run, c, 1.0) > AsAngle(run, most, 1.0)) most = c;
  }
  return most;
}

double TypicalSigma(const LinearRun& run, int channel) {
  double squared = 0.0;
  for (int k = channel; k < run.Rows(); k += run.Channels()) squared += run.sigma[k] * run.sigma[k];
  return std::sqrt(squared * run.Channels() / run.Rows());
}

}  // namespace twinbench::diagnose::screen
