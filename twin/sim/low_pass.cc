#include "twin/sim/low_pass.h"

#include <algorithm>
#include <cmath>

#include "twin/core/units.h"
#include "twin/sim/first_order_lag.h"

namespace twinbench::sim {
namespace {

/// What has been behind one pole when the block begins: turned about its first value, the course of the block lies
/// before it too, and the chord before that.
FirstOrderLag Turned(const BlockCourse& course, std::size_t c, double step_s, int steps, const LowPass& low_pass) {
  FirstOrderLag lag(low_pass.Lag_s());
  const double first_V = course.At_V(c, 0.0);
  const auto before_V = [&](double ago_s) { return 2.0 * first_V - course.At_V(c, ago_s); };
  const int back = std::min(steps, static_cast<int>(std::ceil(low_pass.Memory_s() / step_s)));
  const double ago_s = back * step_s, slope_V_s = (first_V - before_V(ago_s)) / ago_s;
  lag.Follow(-ago_s - low_pass.Memory_s(), before_V(ago_s) - slope_V_s * low_pass.Memory_s());
  for (int k = back; k > 0; --k) lag.Follow(-k * step_s, before_V(k * step_s));
  return lag;
}

/// The same where it is known what was before.
FirstOrderLag Remembered(const BlockCourse& before, std::size_t c, double lag_s) {
  constexpr int kStepsAKnot = 4;  // of a cubic, which are followed as straight: 0.1 % of a sine
  FirstOrderLag lag(lag_s);
  const int steps = kStepsAKnot * before.Steps();
  lag.Follow(-before.Duration_s(), before.Mean_V(c));
  for (int k = 0; k < steps; ++k) {
    const double time_s = before.Duration_s() * k / steps;
    lag.Follow(time_s - before.Duration_s(), before.At_V(c, time_s));
  }
  return lag;
}

}  // namespace

double LowPass::Lag_s() const {
  return PassesAll() ? 0.0 : 1.0 / (units::turn * corner_Hz_);
}

double LowPass::NoiseBand_Hz() const {
  return 0.5 * units::kPi * corner_Hz_;
}

BlockCourse LowPass::Passed(const BlockCourse& course, Duration step, int steps,
                            const std::optional<BlockCourse>& before) const {
  const double step_s = ToSeconds(step);
  std::vector<FirstOrderLag> lags;
  for (std::size_t c = 0; c < kChannels; ++c)
    lags.push_back(before ? Remembered(*before, c, Lag_s()) : Turned(course, c, step_s, steps, *this));
  BlockCourse passed(step);
  for (int k = 0; k <= steps; ++k) {
    const double time_s = k * step_s;
    BlockCourse::Voltages knot_V{};
    for (std::size_t c = 0; c < kChannels; ++c) knot_V[c] = lags[c].Follow(time_s, course.At_V(c, time_s));
    passed.Add(knot_V);
  }
  return passed;
}

PoledNoise::PoledNoise(double standard_deviation, double step_s, double lag_s)
    : standard_deviation_(standard_deviation), kept_(lag_s > 0.0 ? std::exp(-step_s / lag_s) : 0.0) {}

double PoledNoise::Next(Stream& stream) {
  const double fresh = standard_deviation_ * stream.Normal();
  now_ = std::isnan(now_) ? fresh : kept_ * now_ + std::sqrt(1.0 - kept_ * kept_) * fresh;
  return now_;
}

}  // namespace twinbench::sim
