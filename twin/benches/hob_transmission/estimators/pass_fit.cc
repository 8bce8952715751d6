#include "twin/benches/hob_transmission/estimators/pass_fit.h"

namespace twinbench::separate::hob {
namespace {

Drift FitDrift(const std::vector<FittedTurn>& turns) {
  if (turns.size() < 3) return {};  // a line through two means leaves nothing to judge it by
  const auto n = std::ssize(turns);
  Eigen::ArrayXd x(n), y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    x[i] = turns[static_cast<std::size_t>(i)].index;
    y[i] = turns[static_cast<std::size_t>(i)].fit.mean_rad;
  }
  x -= x.mean();
  y -= y.mean();
  const double slope = (x * y).sum() / x.square().sum();
  const double residual2 = (y - slope * x).square().sum() / static_cast<double>(n - 2);
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
