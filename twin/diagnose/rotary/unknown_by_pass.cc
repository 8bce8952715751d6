#include <fmt/format.h>

#include "twin/diagnose/rotary/signals.h"
#include "twin/diagnose/rotary/unknown_collector.h"

namespace twinbench::diagnose::rotary {
namespace {

/// A label of its own for every pass of every set-up.
std::vector<int> Visits(const Schedule& s) {
  constexpr int kMostPasses = 1000;
  std::vector<int> visits;
  for (std::size_t i = 0; i < s.pass.size(); ++i) visits.push_back(kMostPasses * s.setup[i] + s.pass[i]);
  return visits;
}

/// One order of the target angle on each pass alone.
Eigen::MatrixXd WavesByPass(const Eigen::VectorXd& angle_rad, const Eigen::MatrixXd& passes) {
  Eigen::MatrixXd waves(angle_rad.size(), 2 * passes.cols());
  for (Eigen::Index p = 0; p < passes.cols(); ++p) waves.middleCols(2 * p, 2) = Wave(angle_rad, passes.col(p));
  return waves;
}

}  // namespace

void AddByPass(Collector& collect) {
  constexpr int kLastOrder = 3;
  const Schedule& s = collect.schedule();
  const Eigen::VectorXd in = InCircle(s);
  const Eigen::MatrixXd passes = Indicators(s.pass, in);
  collect.Add("pass offset", passes, "offset per pass, locked to the pass (time)");
  collect.Add("pass offset", Indicators(Visits(s), in),
              "offset per pass of each set-up, locked to the pass (time)");
  for (int h = 1; h <= kLastOrder; ++h) {
    collect.Add("pass harmonic", WavesByPass(h * s.target_rad, passes),
                fmt::format("order {} of the target angle that differs from pass to pass", h));
  }
}

}  // namespace twinbench::diagnose::rotary
