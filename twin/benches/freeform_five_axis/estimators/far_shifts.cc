#include "twin/benches/freeform_five_axis/estimators/far_shifts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "twin/core/linear_algebra.h"
#include "twin/core/robust_scale.h"

namespace twinbench::benches::freeform::estimators {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double kOwnShare = 0.05;  // of itself: less of a value is left to judge it by

/// What a fit of some rows leaves of each.
struct Left {
  VectorXd deviations_um;  // all alike if the noise is; 0 where the others do not tell
  VectorXd own;            // which part of a row's value the fit leaves to it
  Index dof = 0;
};

Left LeftOf(const MatrixXd& slopes, const VectorXd& shifts_um) {
  const double rounding = std::numeric_limits<double>::epsilon() * static_cast<double>(std::min(slopes.rows(), slopes.cols()));
  const MatrixXd basis = OrthonormalBasisOf(slopes, rounding);
  Left left;
  left.dof = slopes.rows() - basis.cols();
  left.own = (1.0 - basis.rowwise().squaredNorm().array()).matrix();
  const VectorXd residuals_um = shifts_um - basis * (basis.transpose() * shifts_um);
  left.deviations_um = (left.own.array() > kOwnShare).select(residuals_um.array() / left.own.array().max(kOwnShare).sqrt(), 0.0);
  return left;
}

/// Standard deviation of each kind, by the median: what few far ones do not raise.
std::map<int, double> ScatterOf(const Left& left, const std::vector<int>& kinds, double least_um) {
  std::map<int, std::vector<double>> kept_um;
  for (Index i = 0; i < left.own.size(); ++i)
    if (left.own[i] > kOwnShare) kept_um[kinds[static_cast<std::size_t>(i)]].push_back(left.deviations_um[i]);
  std::map<int, double> scatter_um;
  for (auto& [kind, all_um] : kept_um) scatter_um[kind] = std::max(RobustDeviation(std::move(all_um)), least_um);
  return scatter_um;
}

}  // namespace

std::vector<FarRow> FarRows(const MatrixXd& slopes, const VectorXd& shifts_um, const std::vector<int>& kinds,
                            const std::vector<int>& readings, double least_scatter_um) {
  constexpr double kFar = 6.0, kMost = 0.02;  // scatters; of all readings
  constexpr Index kFewestDof = 20;
  const double all = static_cast<double>(std::set<int>(readings.begin(), readings.end()).size());
  const std::size_t most = std::max<std::size_t>(1, static_cast<std::size_t>(kMost * all));
  std::vector<Index> rows(kinds.size());
  std::iota(rows.begin(), rows.end(), Index{0});
  std::vector<FarRow> far;
  while (far.size() <= most) {
    std::vector<int> own_kinds;
    for (const Index row : rows) own_kinds.push_back(kinds[static_cast<std::size_t>(row)]);
    const Left left = LeftOf(slopes(rows, Eigen::all), shifts_um(rows));
    if (left.dof < kFewestDof) return {};
    const std::map<int, double> scatter_um = ScatterOf(left, own_kinds, least_scatter_um);
    FarRow worst;
    for (Index i = 0; i < std::ssize(rows); ++i) {
      if (!(left.own[i] > kOwnShare)) continue;
      const double times = std::abs(left.deviations_um[i]) / scatter_um.at(own_kinds[static_cast<std::size_t>(i)]);
      if (times <= worst.times) continue;
      worst = {rows[static_cast<std::size_t>(i)], left.deviations_um[i] / std::sqrt(left.own[i]), times};
    }
    if (worst.times < kFar) return far;
    far.push_back(worst);
    std::erase_if(rows, [&](Index row) {
      return readings[static_cast<std::size_t>(row)] == readings[static_cast<std::size_t>(worst.row)];
    });
  }
  return {};
}

}  // namespace twinbench::benches::freeform::estimators
