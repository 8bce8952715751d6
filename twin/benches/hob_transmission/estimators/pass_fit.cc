#include "twin/benches/hob_transmission/estimators/pass_fit.h"

namespace twinbench::separate::hob {
namespace {

/// Each run of turns without a gap has a constant of its own: counts may have been lost in the gap.
Drift FitDrift(const std::vector<FittedTurn>& turns) {
  const auto n = std::ssize(turns);
  Eigen::ArrayXd x(n), y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    x[i] = turns[static_cast<std::size_t>(i)].index;
    y[i] = turns[static_cast<std::size_t>(i)].fit.mean_rad;
  }
  Eigen::Index dof = n - 1;
  for (Eigen::Index first = 0, end = 0; first < n; first = end, --dof) {
    for (end = first + 1; end < n && x[end] - x[end - 1] < 1.5;) ++end;
    x.segment(first, end - first) -= x.segment(first, end - first).mean();
    y.segment(first, end - first) -= y.segment(first, end - first).mean();
  }
  if (dof < 1) return {};  // a line through two means leaves nothing to judge it by
  const double slope = (x * y).sum() / x.square().sum();
  const double residual2 = (y - slope * x).square().sum() / static_cast<double>(dof);
  return {slope, residual2 / x.square().sum(), true};
}

}  // namespace

FittedPass FitPass(const Pass& pass, const TransmissionOptions& options) {
  FittedPass fitted;
  for (const Turn& turn : CutIntoTurns(pass)) {
    TurnFit fit = FitTurn(turn.th_rad, turn.value_rad, turn.middle_rad, pass.direction, options.max_order);
    if (fit.determined && fit.inflation < options.max_inflation) {
      fitted.turns.push_back({turn.index, std::move(fit)});
    } else {
      ++fitted.left_out;
    }
  }
  fitted.drift = FitDrift(fitted.turns);
  return fitted;
}

}  // namespace twinbench::separate::hob
