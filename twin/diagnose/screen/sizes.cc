#include "twin/diagnose/screen/sizes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace twinbench::diagnose::screen {
namespace {

bool ReadsAngles(const LinearRun& run) {
  return run.unit == "arcsec" || run.unit == "deg" || run.unit == "rad";
}

}  // namespace

std::string Amount(const LinearRun& run, double value_SI) {
  return fmt::format("{:.3g} {}", value_SI / run.to_SI, run.unit);
}

bool IsAngle(const std::string& pattern) {
  return pattern == "yaw" || pattern == "tilt" || pattern == "roll";
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

void SetEffect(const LinearRun& run, const Pattern& pattern, double amplitude, ScreenTest& test) {
  int channel = 0;
  const double shown = pattern.weight.cwiseAbs().maxCoeff(&channel);
  SetEffect(run, channel, shown * amplitude, test);
  if (IsAngle(pattern.name)) test.effect_rad = amplitude;
}

int AnyChannel(const LinearRun& run) {
  int most = 0;
  for (int c = 1; c < run.Channels(); ++c) {
    if (AsAngle(run, c, 1.0) > AsAngle(run, most, 1.0)) most = c;
  }
  return most;
}

double TypicalSigma(const LinearRun& run, int channel) {
  return run.sigma(RowsOf(run, channel)).norm() / std::sqrt(static_cast<double>(run.schedule.Readings()));
}

double Beside(double sigma, double ratio) {
  return sigma * std::sqrt(std::abs(ratio * ratio - 1.0));
}

}  // namespace twinbench::diagnose::screen
