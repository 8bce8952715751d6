#include "twin/diagnose/recurrence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "twin/core/distributions.h"
#include "twin/core/units.h"
#include "twin/diagnose/at.h"
#include "twin/diagnose/same_pass.h"

namespace twinbench::diagnose {
namespace {

constexpr double kChanceOfScatter = 1e-3;  // of a scatter that looks like it, each way in which it may look so
constexpr std::size_t kFewestReadings = 3;
constexpr double kNarrow = 0.02;           // of the range of a value, or of a turn

/// P(at least `count`) of a Poisson number.
double PoissonTail(int count, double mean) {
  double term = std::exp(-mean), below = 0.0;
  for (int k = 0; k < count; ++k) {
    below += term;
    term *= mean / (k + 1);
  }
  return std::max(0.0, 1.0 - below);
}

/// P(at least `count` of `trials`).
double BinomialTail(int count, int trials, double p) {
  double tail = 0.0;
  for (int k = count; k <= trials; ++k)
    tail += std::exp(LogGamma(trials + 1.0) - LogGamma(k + 1.0) - LogGamma(trials - k + 1.0) +
                     k * std::log(p) + (trials - k) * std::log1p(-p));
  return tail;
}

bool StandInARow(const std::set<int>& far, const Schedule& s) {
  int neighbours = 0;
  for (const int i : far) neighbours += far.contains(i + 1) && SamePass(s, i, i + 1) ? 1 : 0;
  const auto count = static_cast<double>(far.size());
  return neighbours > 0 && PoissonTail(neighbours, count * (count - 1.0) / s.Readings()) < kChanceOfScatter;
}

/// Where most of the far ones lie together more closely than chance would have them; NaN if nowhere.
/// @param value  One a reading, from 0 to 1. @param closes  1 is 0 again.
double CommonPlace(const std::set<int>& far, const Eigen::VectorXd& value, bool closes) {
  const auto beyond = [closes](double from, double to) {
    const double distance = to - from;
    return closes ? distance - std::floor(distance) : distance;
  };
  const auto within = [&](double from, double at) {
    const double distance = beyond(from, at);
    return distance >= 0.0 && distance <= kNarrow;
  };
  const int others = static_cast<int>(far.size()) - 1;
  for (const int first : far) {
    const double from = value[first];
    const auto together = std::ranges::count_if(far, [&](int i) { return within(from, value[i]); });
    const auto there = std::ranges::count_if(value, [&](double v) { return within(from, v); });
    const double share = static_cast<double>(there) / static_cast<double>(value.size());
    if (std::ssize(far) > 2 * together || share >= 1.0) continue;
    const double chance =
        static_cast<double>(far.size()) * BinomialTail(static_cast<int>(together) - 1, others, share);
    if (together >= static_cast<std::ptrdiff_t>(kFewestReadings) && chance < kChanceOfScatter) return from;
  }
  return kNaN;
}

/// Turns of an angle that comes back; empty where it is not recorded or never comes back.
Eigen::VectorXd TurnsOf(const Eigen::VectorXd& angle_rad) {
  if (angle_rad.size() == 0 || !angle_rad.allFinite()) return {};
  const Eigen::VectorXd turns = angle_rad / units::turn;
  return turns.array() - turns.array().floor();
}

/// Shares of the range of what a channel shows; empty if it shows one value.
Eigen::VectorXd ShownShares(const LinearRun& run, int channel) {
  const Eigen::VectorXd shown = run.Predicted()(Eigen::seq(channel, Eigen::last, run.Channels()));
  const double least = shown.minCoeff(), range = shown.maxCoeff() - least;
  if (!(range > 0.0)) return {};
  return (shown.array() - least) / range;
}

}  // namespace

std::string RecurrenceOf(const std::vector<int>& rows, const LinearRun& run) {
  std::set<int> far;
  for (const int row : rows) far.insert(run.ReadingOf(row));
  if (far.size() < kFewestReadings) return "";
  if (StandInARow(far, run.schedule)) return "far values that stand in a row, function of time";
  const auto at_angle = [&](const Eigen::VectorXd& angle_rad) {
    const Eigen::VectorXd turns = TurnsOf(angle_rad);
    return turns.size() > 0 ? CommonPlace(far, turns, true) : kNaN;
  };
  for (const auto& [name, angle_rad] :
       {std::pair{"reference", run.schedule.reference_rad}, std::pair{"target", run.schedule.target_rad}}) {
    const double turns = at_angle(angle_rad);
    if (std::isfinite(turns))
      return fmt::format("far values that come back at {:.0f} deg, synchronous with {} angle", 360.0 * turns, name);
  }
  for (int c = 0; c < run.Channels(); ++c) {
    std::set<int> own;
    for (const int row : rows) {
      if (run.ChannelOf(row) == c) own.insert(run.ReadingOf(row));
    }
    const Eigen::VectorXd shares = ShownShares(run, c);
    if (own.size() < kFewestReadings || shares.size() == 0 || !std::isfinite(CommonPlace(own, shares, false))) continue;
    return fmt::format("far values that come back where {} shows the same, function of what it shows",
                       run.channels[At(c)]);
  }
  return "";
}

}  // namespace twinbench::diagnose
