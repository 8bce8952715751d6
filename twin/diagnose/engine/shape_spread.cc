#include "twin/diagnose/engine/shape_spread.h"

#include <algorithm>
#include <cmath>

#include "twin/diagnose/engine/refine.h"

namespace twinbench::diagnose {
namespace {

constexpr int kMostColumns = 512;  // of signatures to look at: a few hundredths of a second

}  // namespace

Spread SpreadOverGrid(const Scanner& scanner, const Term& term, const LinearRun& run, const NoiseModel& noise,
                      const Projector& projector, const Deflation& others, const Projected& data, double variance) {
  const Family& family = scanner.Families()[static_cast<std::size_t>(term.family)];
  Spread spread{Eigen::VectorXd::Zero(term.columns.cols()), Eigen::VectorXd::Zero(term.shape.size())};
  if (term.shape.size() == 0) return spread;
  const Explained best = Explain(noise.Whiten(run, term.columns), projector, others, data.rows.col(0));
  double sum = 1.0;  // the fitted shape itself
  const int reach = std::max(1, kMostColumns / 2 / static_cast<int>(term.columns.cols()));
  const int first = std::max(0, term.grid_point - reach), last = std::min(family.grid - 1, term.grid_point + reach);
  const std::vector<Scanner::Fit> fits = scanner.FitEach(term.family, first, last, data, others);
  for (int g = first; g <= last; ++g) {
    const Scanner::Fit& other = fits[static_cast<std::size_t>(g - first)];
    const double weight = std::exp(std::min(0.0, 0.5 * (other.power - best.power) / variance));
    spread.amplitudes += weight * (other.amplitudes - best.amplitudes).cwiseAbs2();
    spread.shape += weight * (family.ShapeAt(g) - term.shape).cwiseAbs2();
    sum += weight;
  }
  spread.amplitudes = (spread.amplitudes / sum).cwiseSqrt();
  spread.shape /= sum;
  if (!family.at) {
    for (Eigen::Index k = 0; k < spread.shape.size(); ++k) {
      // All that is known between two points of the grid.
      const Range cell = Around(family.shapes[static_cast<std::size_t>(k)], term.shape[k]);
      spread.shape[k] += std::pow(0.5 * (cell.upper - cell.lower), 2) / 12.0;
    }
  }
  spread.shape = spread.shape.cwiseSqrt();
  return spread;
}

}  // namespace twinbench::diagnose
