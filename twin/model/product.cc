#include "twin/model/product.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "twin/core/errors.h"
#include "twin/core/signal_effect.h"
#include "twin/model/block_mean.h"

namespace twinbench::model {
namespace {

int IndexOf(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  Require(found != names.end(), "a signal names something that the bench has");
  return static_cast<int>(found - names.begin());
}

/// The other channel of the same detector.
std::size_t Partner(int channel, std::size_t channels) {
  const auto partner = static_cast<std::size_t>(channel ^ 1);
  return partner < channels ? partner : static_cast<std::size_t>(channel);
}

}  // namespace

Product::Product(const EffectSettings& effect, const BenchFormat& bench)
    : effect_(effect), channel_(IndexOf(bench.points, effect.where)) {
  const std::vector<std::string> arguments = SignalArguments(effect.signal, bench);
  if (!arguments.empty()) by_ = IndexOf(arguments, effect.by);
}

double Product::Shortest_s() const {
  return effect_.signal == "tone" ? 1.0 / Of("frequency") : std::numeric_limits<double>::infinity();
}

double Product::Of(const char* parameter) const {
  const auto found = effect_.parameters.find(parameter);
  Require(found != effect_.parameters.end(), "a signal has all its parameters");
  return found->second;
}

double Product::Factor(const Instant& instant) const {
  const std::string& times = effect_.times;
  if (times.empty()) return 1.0;
  if (times == "direction") return instant.direction;
  const auto scaled = [this](double value) { return (value - Of("about")) / Of("per"); };
  if (times == "velocity") return scaled(instant.velocity_rad_s);
  if (times == "speed") return scaled(std::abs(instant.velocity_rad_s));
  return scaled(times == "time" ? instant.time_s : instant.above_K);
}

double Product::Course(const Instant& instant, std::span<const double> shown) const {
  const std::string& kind = effect_.signal;
  if (kind == "constant") return Of("amplitude");
  if (kind == "share") return Of("share") * shown[static_cast<std::size_t>(by_)];
  if (kind == "step") return instant.reading >= Of("at_reading") ? Of("amplitude") : 0.0;
  const double own = shown[static_cast<std::size_t>(channel_)];
  if (kind == "power") {
    const double partner = shown[Partner(channel_, shown.size())], range = Of("range");
    return Of("amplitude") * std::pow(own / range, std::round(Of("exponent"))) *
           std::pow(partner / range, std::round(Of("partner_exponent")));
  }
  double phase_rad = Of("phase"), share = 1.0;
  if (kind == "harmonic") phase_rad += Of("order") * instant.angle_rad[static_cast<std::size_t>(by_)];
  if (kind == "interaction")
    phase_rad += Of("order") * instant.angle_rad[0] + Of("with_order") * instant.angle_rad[1];
  if (kind == "tone") {
    const BehindPole behind = SineBehindPole(Of("frequency"), instant.lag_s);
    phase_rad += units::turn * Of("frequency") * instant.time_s + behind.ahead_rad;
    share = behind.share * ShareLeft(Of("frequency"), instant.averaged_s);
  }
  if (kind == "fringes") phase_rad += units::turn * own / Of("period");
  return Of("amplitude") * share * std::cos(phase_rad);
}

double Product::At(const Instant& instant, std::span<const double> shown) const {
  return Factor(instant) * Course(instant, shown);
}

}  // namespace twinbench::model
