#include "twin/diagnose/engine/estimate.h"

#include <algorithm>
#include <cmath>

#include "twin/core/linear_algebra.h"
#include "twin/diagnose/engine/base.h"
#include "twin/diagnose/engine/refine.h"

namespace twinbench::diagnose {
namespace {

/// Standard deviations by what the points of the grid explain: exp(explained / 2 variance) weighs them against the
/// fitted shape. Holds where slopes fail: a level between two readings, an onset, a second maximum, a lifetime that
/// trades against its amplitude. Zero if the grid is too coarse to have a second likely point. Of a long grid only
/// the part about the fitted shape is walked.
///
/// @param others    The other terms.
/// @param data      The residual, projected, with `others` taken out.
/// @param variance  Of the whitened noise.
struct Spread {
  Eigen::VectorXd amplitudes;  // of their best values from shape to shape
  Eigen::VectorXd shape;
};

constexpr int kMostColumns = 512;  // of signatures to look at: a few hundredths of a second

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

/// Precision of what is known beforehand of each column of WithShapeSlopes: amplitudes may be as large as four
/// prior deviations, as in the evidence; shapes lie anywhere in their range.
Eigen::VectorXd PriorPrecision(const Family& family, Eigen::Index columns) {
  constexpr double kWidestPrior = 4.0;
  Eigen::VectorXd precision(columns);
  const auto amplitudes = std::ssize(family.amplitudes);
  for (Eigen::Index k = 0; k < columns; ++k) {
    if (k < amplitudes) {
      precision[k] = std::pow(kWidestPrior * family.amplitudes[static_cast<std::size_t>(k)].prior_sd, -2.0);
    } else {
      const Shape& s = family.shapes[static_cast<std::size_t>(k - amplitudes)];
      precision[k] = 12.0 / std::pow(s.upper - s.lower, 2.0);
    }
  }
  return precision;
}

/// The slopes of all terms with their priors.
struct Slopes {
  Eigen::MatrixXd columns;
  Eigen::VectorXd precision;
  std::vector<Eigen::Index> start;  // of each term
};

Slopes AllSlopes(const LinearRun& run, const std::vector<Family>& families, const std::vector<Term>& terms) {
  Slopes all;
  all.columns.resize(run.Rows(), 0);
  for (const Term& term : terms) {
    const Family& family = families[static_cast<std::size_t>(term.family)];
    const Eigen::MatrixXd own = WithShapeSlopes(family, term.shape, term.columns, term.amplitudes);
    const Eigen::Index at = all.columns.cols();
    all.start.push_back(at);
    all.columns = HStack(all.columns, own);
    all.precision.conservativeResize(at + own.cols());
    all.precision.tail(own.cols()) = PriorPrecision(family, own.cols());
  }
  return all;
}

/// Lets amplitudes and shape spread as far as the points of the grid say, where that is farther than the slopes
/// say.
void Widen(const Spread& spread, Eigen::MatrixXd& cov) {
  Eigen::VectorXd all(spread.amplitudes.size() + spread.shape.size());
  all << spread.amplitudes, spread.shape;
  const Eigen::Index had = cov.cols();
  cov.conservativeResize(all.size(), all.size());
  if (had < all.size()) {
    cov.rightCols(all.size() - had).setZero();
    cov.bottomRows(all.size() - had).setZero();
  }
  cov.diagonal() = cov.diagonal().cwiseMax(all.cwiseAbs2());
}

/// (S'WS + D)^-1, computed in units in which its diagonal is one.
Eigen::MatrixXd CovarianceOf(const Projector& projector, const Eigen::MatrixXd& S,
                             const Eigen::VectorXd& precision) {
  const Eigen::MatrixXd H = projector.Absorbed(S);
  Eigen::MatrixXd normal = S.transpose() * S - H.transpose() * H;
  normal.diagonal() = normal.diagonal().cwiseMax(0.0) + precision;
  const Eigen::VectorXd unit = normal.diagonal().cwiseSqrt().cwiseInverse();
  return unit.asDiagonal() * InverseOfSymmetric(unit.asDiagonal() * normal * unit.asDiagonal()) * unit.asDiagonal();
}

}  // namespace

Eigen::MatrixXd Signatures(const LinearRun& run, const std::vector<Term>& terms, std::size_t left_out) {
  Eigen::MatrixXd all(run.Rows(), 0);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const Term& term = terms[k];
    if (k != left_out) all = HStack(all, term.columns);
  }
  return all;
}

void EstimateTerms(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                   const Scanner& scanner, const Eigen::MatrixXd& white, std::vector<Term>& terms) {
  if (terms.empty()) return;
  const Deflation causes(projector, noise.Whiten(run, Signatures(run, terms)));
  const Projected left = Project(projector, causes, white);
  const Eigen::VectorXd amplitudes = causes.Amplitudes(projector.Apply(white));
  Eigen::Index at = 0;
  for (Term& term : terms) {
    term.amplitudes = amplitudes.segment(at, term.columns.cols());
    at += term.columns.cols();
  }
  const Slopes slopes = AllSlopes(run, scanner.Families(), terms);
  const double trust = PseudoDegrees(run);
  const double variance =
      (trust + left.power[0]) / (trust + projector.DegreesOfFreedom() - static_cast<double>(slopes.columns.cols()));
  const Eigen::MatrixXd cov =
      variance * CovarianceOf(projector, noise.Whiten(run, slopes.columns), slopes.precision);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const Eigen::Index first = slopes.start[k];
    const Eigen::Index end = k + 1 < terms.size() ? slopes.start[k + 1] : cov.cols();
    terms[k].cov = cov.block(first, first, end - first, end - first);
    const Deflation others(projector, noise.Whiten(run, Signatures(run, terms, k)));
    Widen(SpreadOverGrid(scanner, terms[k], run, noise, projector, others, Project(projector, others, white),
                         variance),
          terms[k].cov);
  }
}

}  // namespace twinbench::diagnose
