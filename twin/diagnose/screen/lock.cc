#include <cmath>
#include <map>
#include <unsupported/Eigen/KroneckerProduct>
#include <utility>

#include "twin/core/units.h"
#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/scan.h"
#include "twin/diagnose/screen/tests.h"

namespace twinbench::diagnose::screen {
namespace {

/// A set-up in which the target went round, and where the reference then stood.
struct Round {
  int setup = 0;
  std::vector<int> readings;
  double offset_rad = 0.0;  // target + reference
};

std::vector<Round> RoundsOf(const Schedule& s) {
  std::map<int, std::vector<int>> members;
  for (int i = 0; i < s.Readings(); ++i) {
    if (s.phase[i] != Phase::kCalibration) members[s.setup[i]].push_back(i);
  }
  std::vector<Round> rounds;
  for (const auto& [setup, readings] : members) {
    const Eigen::VectorXd target = s.target_rad(readings);
    if (target.maxCoeff() - target.minCoeff() > units::kPi)
      rounds.push_back({setup, readings, (target + s.reference_rad(readings)).mean()});
  }
  return rounds;
}

/// Cosine and sine of h * target in each set-up apart: for every order 2 columns a set-up.
Scan ScanBySetup(const Schedule& s, const std::vector<Round>& rounds, int orders) {
  Scan scan{"harmonics by mounting", 2 * static_cast<int>(rounds.size())};
  for (int h = 1; h <= orders; ++h) {
    const Eigen::MatrixXd wave = Wave(h * s.target_rad);
    Eigen::MatrixXd shape = Eigen::MatrixXd::Zero(s.Readings(), scan.width);
    for (std::size_t r = 0; r < rounds.size(); ++r)
      shape(rounds[r].readings, Eigen::seqN(2 * r, 2)) = wave(rounds[r].readings, Eigen::all);
    scan.Add(shape, h);
  }
  return scan;
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
  for (int r = 0; r < std::ssize(rounds); ++r) {
    const double angle = advance * rounds[r].offset_rad;
    model.middleRows<2>(2 * r) << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  }
  return model;
}

/// The locks that explain nearly all that free phases explain (several where the offsets do not part them), or
/// "interaction" if none does. A lock that leaves as many free directions as free phases do explains everything and
/// says nothing: free tables take target and reference away, and two or three set-ups then hold one phase only.
std::string LockOf(const Fit& fit, const std::vector<Round>& rounds, int order, int channels) {
  constexpr double kNearlyAll = 0.8;
  const Lock locks[] = {
      {"target", 0.0}, {"reference", 1.0 * order}, {"difference of both angles", 0.5 * order}, {"laboratory", 1.0}};
  const Eigen::MatrixXd each_channel = Eigen::MatrixXd::Identity(channels, channels);
  std::string names;
  for (const Lock& lock : locks) {
    const Fit locked = fit.Constrained(Eigen::kroneckerProduct(each_channel, PhaseModel(rounds, lock.advance)), 2);
    if (locked.dof == fit.dof) return "something that so few mountings cannot show";
    if (locked.dof == 0 || locked.chi2[0] - locked.dof < kNearlyAll * (fit.chi2[0] - fit.dof)) continue;
    names += (names.empty() ? "" : " or ") + std::string(lock.name);
  }
  return names.empty() ? "interaction of mounting and angle" : names;
}

void AddPhaseLines(const LinearRun& run, const Fit& fit, const std::vector<Round>& rounds, ScreenTest& test) {
  for (int c = 0; c < run.Channels(); ++c) {
    for (int r = 0; r < std::ssize(rounds); ++r) {
      const double a = fit.amplitude[c * fit.width + 2 * r], b = fit.amplitude[c * fit.width + 2 * r + 1];
      test.tables.push_back(fmt::format("{}, mounting {} (offset {:.1f} deg): {}, phase {:.0f} deg", run.channels[c],
                                        rounds[r].setup, rounds[r].offset_rad / units::deg,
                                        Amount(run, c, std::hypot(a, b)), std::atan2(b, a) / units::deg));
    }
  }
}

}  // namespace

void TestLock(const Sample& sample, Tests& tests) {
  const Schedule& schedule = sample.run.schedule;
  if (!Varies(schedule.target_rad) || !Varies(schedule.reference_rad)) return;
  const std::vector<Round> rounds = RoundsOf(schedule);
  if (rounds.size() < 2) return;
  auto found = Strongest(sample, ScanBySetup(schedule, rounds, HighestOrder(schedule.target_rad)));
  if (!found) return;
  // The fit has an amplitude a set-up; the size is their root mean square.
  found->test.effect_m /= std::sqrt(static_cast<double>(rounds.size()));
  found->test.effect_rad /= std::sqrt(static_cast<double>(rounds.size()));
  found->test.reading += LockOf(found->fit, rounds, found->item + 1, sample.run.Channels());
  AddPhaseLines(sample.run, found->fit, rounds, found->test);
  tests.push_back(std::move(found->test));
}

}  // namespace twinbench::diagnose::screen
