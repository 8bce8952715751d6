#include <fmt/format.h>

#include "twin/diagnose/turntable/collector.h"

namespace twinbench::diagnose::turntable {
namespace {

/// A label of its own for every pass of every set-up.
std::vector<int> Visits(const Schedule& s) {
  constexpr int kMostPasses = 1000;
  std::vector<int> visits;
  for (std::size_t i = 0; i < s.pass.size(); ++i) visits.push_back(kMostPasses * s.setup[i] + s.pass[i]);
  return visits;
}

}  // namespace

void AddByPass(Collector& collect) {
  constexpr int kLastOrder = 3;
  constexpr Eigen::Index kMostVisits = 24;
  const Eigen::MatrixXd visits = Indicators(collect, Visits(collect.schedule()));
  if (visits.cols() < 2 || visits.cols() > kMostVisits) return;
  collect.Add("pass offset", visits, "offset of each pass, locked to the pass (time)");
  collect.Add(
      "pass harmonic", kLastOrder,
      [c = collect.context(), visits](int g) {
        Eigen::MatrixXd waves(visits.rows(), 2 * visits.cols());
        for (Eigen::Index p = 0; p < visits.cols(); ++p)
          waves.middleCols(2 * p, 2) = Times(Wave((g + 1) * c->schedule.target_rad), visits.col(p));
        return waves;
      },
      [](int g) { return fmt::format("order {} locked to target angle that differs from pass to pass", g + 1); });
}

}  // namespace twinbench::diagnose::turntable
