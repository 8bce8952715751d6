#include "twin/benches/encoder_comparison/diagnosis/pushed_both_ways.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace twinbench::diagnose::encoder {
namespace {

/// Two sides of some values.
struct Sides {
  double low = 0.0, high = 0.0;  // means
  double within = 0.0;           // mean square about the own one
  double share = 0.0;            // of values on the high one

  double Middle() const { return 0.5 * (low + high); }
};

Sides SidesAbout(const std::vector<double>& values, double middle) {
  double sum[2] = {}, squares[2] = {}, count[2] = {};
  for (const double v : values) {
    const int side = v > middle ? 1 : 0;
    sum[side] += v;
    squares[side] += v * v;
    count[side] += 1.0;
  }
  const double low = sum[0] / std::max(1.0, count[0]), high = sum[1] / std::max(1.0, count[1]);
  const double within = squares[0] - count[0] * low * low + squares[1] - count[1] * high * high;
  const auto all = static_cast<double>(values.size());
  return {low, high, within / all, count[1] / all};
}

/// Where values lie on two sides: what is left about their means is a small part of their variance, which it is of
/// no noise.
std::optional<Sides> TwoSides(const std::vector<double>& values) {
  constexpr int kRounds = 20;
  constexpr double kLeft = 0.15;  // of a level distribution a quarter, of a normal one 0.36
  const auto [least, most] = std::ranges::minmax(values);
  Sides sides = SidesAbout(values, 0.5 * (least + most));
  for (int round = 0; round < kRounds; ++round) sides = SidesAbout(values, sides.Middle());
  const double between = sides.share * (1.0 - sides.share) * std::pow(sides.high - sides.low, 2);
  return sides.within < kLeft * (sides.within + between) ? std::optional(sides) : std::nullopt;
}

bool StandsUndirected(const std::vector<Reading>& readings) {
  constexpr double kStands_rad = 1e-9;
  return std::ranges::all_of(readings, [&](const Reading& r) {
    return r.direction == readings.front().direction && r.setup == readings.front().setup &&
           std::isfinite(r.measured_rad) &&
           std::abs(r.reference_rad - readings.front().reference_rad) < kStands_rad;
  });
}

}  // namespace

std::vector<Reading> WithSides(std::vector<Reading> readings) {
  constexpr std::size_t kFewest = 12;
  constexpr int kChanges = 4;        // there and back twice
  constexpr std::size_t kStays = 2;  // readings on one side in a row, on average
  if (readings.size() < kFewest || !StandsUndirected(readings)) return readings;
  std::vector<double> shown_rad;
  for (const Reading& r : readings) shown_rad.push_back(r.measured_rad);
  const std::optional<Sides> sides = TwoSides(shown_rad);
  if (!sides) return readings;
  std::vector<Reading> sided = readings;
  int changes = 0;
  for (std::size_t i = 0; i < sided.size(); ++i) {
    sided[i].direction = shown_rad[i] > sides->Middle() ? -1 : 1;  // a device that lags behind is pushed forwards
    if (i > 0 && sided[i].direction != sided[i - 1].direction) ++changes;
    sided[i].pass = changes;
  }
  const bool are_stays = changes >= kChanges && kStays * static_cast<std::size_t>(changes) <= sided.size();
  return are_stays ? sided : readings;
}

}  // namespace twinbench::diagnose::encoder
