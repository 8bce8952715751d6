#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "twin/diagnose/screen/angles.h"
#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {
namespace {

/// A set-up in which the target went round, and where the reference then stood.
struct Round {
  int setup = 0;
  double offset_rad = 0.0;  // target + reference
};

std::vector<Round> RoundsOf(const Schedule& s) {
  std::map<int, std::vector<int>> members;
  for (int i = 0; i < s.Readings(); ++i) {
    if (s.phase[static_cast<std::size_t>(i)] != Phase::kCalibration) {
      members[s.setup[static_cast<std::size_t>(i)]].push_back(i);
    }
  }
  std::vector<Round> rounds;
  for (const auto& [setup, readings] : members) {
    const Eigen::VectorXd target = s.target_rad(readings);
    if (!(target.maxCoeff() - target.minCoeff() > std::numbers::pi)) continue;
    rounds.push_back({setup, (target + s.reference_rad(readings)).mean()});
  }
  return rounds;
}

/// Cosine and sine of h * target in each set-up apart: for every order 2 columns a set-up.
Scan ScanBySetup(const Schedule& s, const std::vector<Round>& rounds, int orders) {
  const auto setups = static_cast<Eigen::Index>(rounds.size());
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(s.Readings(), orders * 2 * setups);
  const Eigen::MatrixXd all = Harmonics(s.target_rad, OrdersUpTo(orders));
  for (int i = 0; i < s.Readings(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (s.phase[k] == Phase::kCalibration) continue;
    for (Eigen::Index r = 0; r < setups; ++r) {
      if (s.setup[k] != rounds[static_cast<std::size_t>(r)].setup) continue;
      for (int h = 0; h < orders; ++h) shapes.block(i, 2 * (h * setups + r), 1, 2) = all.block(i, 2 * h, 1, 2);
    }
  }
  return {{std::move(shapes)}, 2 * static_cast<int>(setups)};
}

/// How the phase of a cosine in the target angle goes with the set-up if it is locked to something else.
///
/// target: cos(h t + a). reference, r = offset - t: cos(h r + a) = cos(h t - a - h offset): the phase advances by
/// h offset. difference, 2 t - offset: half as much. laboratory: the rotor's azimuth t + r is the offset itself, so
/// that the error turns by one offset, whatever the order.
struct Lock {
  const char* name;
  double advance;  // of the phase per offset
};

/// (2 * setups) x 2: amplitudes of the set-ups from one common cosine and sine.
Eigen::MatrixXd PhaseModel(const std::vector<Round>& rounds, double advance) {
  Eigen::MatrixXd model(2 * std::ssize(rounds), 2);
  for (std::size_t r = 0; r < rounds.size(); ++r) {
    const double angle = advance * rounds[r].offset_rad;
    model.middleRows<2>(2 * static_cast<Eigen::Index>(r)) << std::cos(angle), -std::sin(angle), std::sin(angle),
        std::cos(angle);
  }
  return model;
}

Eigen::MatrixXd OnEveryChannel(const Eigen::MatrixXd& model, int channels) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(channels * model.rows(), channels * model.cols());
  for (int c = 0; c < channels; ++c)
    all.block(c * model.rows(), c * model.cols(), model.rows(), model.cols()) = model;
  return all;
}

/// The locks that explain nearly all that free phases explain (several where the offsets do not part them), or
/// "interaction" if none does. A lock that leaves as many free directions as free phases do explains everything and
/// says nothing: free tables take target and reference away, and two or three set-ups then hold one phase only.
std::string LockOf(const Fit& fit, const std::vector<Round>& rounds, int order, int channels) {
  constexpr double kNearlyAll = 0.8;
  const Lock locks[] = {
      {"target", 0.0}, {"reference", 1.0 * order}, {"difference of both angles", 0.5 * order}, {"laboratory", 1.0}};
  std::string names;
  bool trivial = false;
  for (const Lock& lock : locks) {
    const Fit locked = fit.Constrained(OnEveryChannel(PhaseModel(rounds, lock.advance), channels), 2);
    trivial = trivial || locked.dof == fit.dof;
    if (locked.dof == 0 || locked.chi2 - locked.dof < kNearlyAll * (fit.chi2 - fit.dof)) continue;
    names += (names.empty() ? "" : " or ") + std::string(lock.name);
  }
  if (trivial) return "something that so few set-ups cannot tell";
  return names.empty() ? "interaction of set-up and angle" : names;
}

std::vector<std::string> PhaseLines(const LinearRun& run, const Fit& fit, const std::vector<Round>& rounds) {
  std::vector<std::string> lines;
  for (int c = 0; c < run.Channels(); ++c) {
    for (std::size_t r = 0; r < rounds.size(); ++r) {
      const auto at = c * fit.width + 2 * static_cast<Eigen::Index>(r);
      const double a = fit.amplitude[at], b = fit.amplitude[at + 1];
      lines.push_back(fmt::format("{}, set-up {} (offset {:.1f} deg): {}, phase {:.0f} deg",
                                  run.channels[static_cast<std::size_t>(c)], rounds[r].setup,
                                  rounds[r].offset_rad * 180.0 / std::numbers::pi, Amount(run, std::hypot(a, b)),
                                  std::atan2(b, a) * 180.0 / std::numbers::pi));
    }
  }
  return lines;
}

}  // namespace

Tests TestLock(const Sample& sample) {
  const Schedule& schedule = sample.run.schedule;
  if (!Varies(schedule.target_rad) || !Varies(schedule.reference_rad)) return {};
  const std::vector<Round> rounds = RoundsOf(schedule);
  const int orders = HighestOrder(schedule.target_rad);
  if (rounds.size() < 2 || orders < 1) return {};
  const Scan scan = ScanBySetup(schedule, rounds, orders);
  ScanWords words{"harmonics by set-up", {}, ""};
  for (int h = 1; h <= orders; ++h)
    words.items.push_back(fmt::format("order {} with a phase of its own in each set-up", h));
  auto found = TestScan(sample, scan, words);
  if (!found) return {};
  // The fit has an amplitude a set-up; the size is their root mean square.
  found->test.effect_m /= std::sqrt(static_cast<double>(rounds.size()));
  found->test.effect_rad /= std::sqrt(static_cast<double>(rounds.size()));
  found->test.reading += "locked to " + LockOf(found->fit, rounds, found->item + 1, sample.run.Channels());
  for (std::string& line : PhaseLines(sample.run, found->fit, rounds))
    found->test.tables.push_back(std::move(line));
  return {std::move(found->test)};
}

}  // namespace twinbench::diagnose::screen
