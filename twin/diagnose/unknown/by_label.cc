#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/diagnose/tuning.h"
#include "twin/diagnose/unknown/collector.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::unknown {
namespace {

bool IsTold(const Eigen::MatrixXd& which, Eigen::Index most) {
  return which.cols() > 1 && which.cols() <= most;
}

/// Where the bench went through its positions.
Eigen::MatrixXd WhereMoved(const Design& design, const std::vector<int>& label) {
  const Eigen::MatrixXd all = model::Times(model::Indicators(label), design.moved);
  Eigen::MatrixXd kept(all.rows(), 0);
  for (Eigen::Index k = 0; k < all.cols(); ++k) {
    if (all.col(k).isZero()) continue;
    kept.conservativeResize(Eigen::NoChange, kept.cols() + 1);
    kept.rightCols(1) = all.col(k);
  }
  return kept;
}

/// Low orders of the first angle that differ from one value of a label to the next.
void AddWaves(Collector& collect, const std::string& what, const Eigen::MatrixXd& which, int last) {
  if (!IsTold(which, tuning::kMostWaves) || collect.design().angles.empty()) return;
  const Angle& angle = collect.design().angles.front();
  const int first = angle.first_by_label, orders = std::min(last, angle.last_order) + 1 - first;
  if (orders < 1) return;
  collect.Add(
      what + " harmonic", orders,
      [rad = angle.rad, which, first](int g) { return model::InEach(model::Wave((g + first) * rad), which); },
      [what, name = angle.name, first](int g) {
        return fmt::format("order {} synchronous with {} that differs from {} to {}", g + first, name, what, what);
      });
}

void AddPasses(Collector& collect) {
  const Design& d = collect.design();
  const Eigen::MatrixXd passes = WhereMoved(d, d.course.pass), visits = WhereMoved(d, model::Visits(d.course));
  if (IsTold(passes, tuning::kMostOffsets)) {
    collect.Add("pass", passes, "offset of each pass, function of the pass (time)");
    collect.GoByTime();
  }
  AddWaves(collect, "pass", passes, tuning::kPassOrders);
  if (visits.cols() <= passes.cols() || !IsTold(visits, tuning::kMostOffsets)) return;
  collect.Add("pass", visits, "offset of each pass of each mounting, function of the pass (time)");
  collect.GoByTime();
}

/// A label for every dwell that occurs, to a tenth of a second.
std::vector<int> DwellLevels(const Eigen::VectorXd& dwell_s) {
  std::vector<int> levels;
  for (const double d_s : dwell_s)
    levels.push_back(std::isfinite(d_s) ? static_cast<int>(std::lround(10.0 * d_s)) : -1);
  return levels;
}

void AddDwells(Collector& collect) {
  const Design& d = collect.design();
  if (!d.course.dwell_s.array().isFinite().any()) return;
  const Eigen::MatrixXd levels = WhereMoved(d, DwellLevels(d.course.dwell_s));
  if (!IsTold(levels, tuning::kMostDwells)) return;
  collect.Add("dwell", levels, "depends on the dwell");
  collect.Add("dwell", model::Times(levels, d.senses.front()),
              "direction times a function of the dwell, odd in direction");
}

}  // namespace

void AddByLabel(Collector& collect) {
  AddPasses(collect);
  AddDwells(collect);
  // An offset of each set-up is free anyway.
  AddWaves(collect, "mounting", WhereMoved(collect.design(), collect.design().course.setup), tuning::kSetupOrders);
}

}  // namespace twinbench::diagnose::unknown
