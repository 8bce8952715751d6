#include "twin/diagnose/engine/noise_model.h"

#include <cmath>

#include "twin/core/errors.h"

namespace twinbench::diagnose {
namespace {

/// True if reading i directly follows reading i - 1 in the same pass.
bool Follows(const Schedule& s, int i) {
  const auto at = [](const std::vector<int>& v, int k) { return v[static_cast<std::size_t>(k)]; };
  return i > 0 && at(s.setup, i) == at(s.setup, i - 1) && at(s.pass, i) == at(s.pass, i - 1) &&
         s.phase[static_cast<std::size_t>(i)] == s.phase[static_cast<std::size_t>(i - 1)];
}

/// The whitening of row k: own * row k + before * row k - channels.
struct Filter {
  double own = 1.0;
  double before = 0.0;
};

std::vector<Filter> FiltersOf(const LinearRun& run, const NoiseModel& noise) {
  Require(noise.sigma.size() == run.Rows(), "a noise model has as many deviations as the run has rows");
  const double innovation = std::sqrt(1.0 - noise.rho * noise.rho);
  std::vector<Filter> filters(static_cast<std::size_t>(run.Rows()));
  for (int k = 0; k < run.Rows(); ++k) {
    Filter& f = filters[static_cast<std::size_t>(k)];
    f.own = 1.0 / noise.sigma[k];
    if (noise.rho == 0.0 || !Follows(run.schedule, run.ReadingOf(k))) continue;
    f.before = -noise.rho / (innovation * noise.sigma[k - run.Channels()]);
    f.own /= innovation;
  }
  return filters;
}

}  // namespace

Eigen::MatrixXd NoiseModel::Whiten(const LinearRun& run, const Eigen::MatrixXd& rows) const {
  if (rho == 0.0) return sigma.cwiseInverse().asDiagonal() * rows;
  const std::vector<Filter> filters = FiltersOf(run, *this);
  Eigen::MatrixXd white(rows.rows(), rows.cols());
  for (int k = 0; k < run.Rows(); ++k) {
    const Filter& f = filters[static_cast<std::size_t>(k)];
    white.row(k) = f.own * rows.row(k);
    if (f.before != 0.0) white.row(k) += f.before * rows.row(k - run.Channels());
  }
  return white;
}

Eigen::MatrixXd NoiseModel::WhitenTransposed(const LinearRun& run, const Eigen::MatrixXd& white) const {
  if (rho == 0.0) return sigma.cwiseInverse().asDiagonal() * white;
  const std::vector<Filter> filters = FiltersOf(run, *this);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(white.rows(), white.cols());
  for (int k = 0; k < run.Rows(); ++k) {
    const Filter& f = filters[static_cast<std::size_t>(k)];
    rows.row(k) += f.own * white.row(k);
    if (f.before != 0.0) rows.row(k - run.Channels()) += f.before * white.row(k);
  }
  return rows;
}

Tridiagonal NoiseModel::Precision(const LinearRun& run) const {
  Require(run.Channels() == 1, "neighbouring rows are neighbouring readings only on one channel");
  const std::vector<Filter> filters = FiltersOf(run, *this);
  Tridiagonal precision{Eigen::VectorXd(run.Rows()), Eigen::VectorXd::Zero(run.Rows())};
  for (int k = 0; k < run.Rows(); ++k) {
    const Filter& f = filters[static_cast<std::size_t>(k)];
    precision.diagonal[k] = f.own * f.own;
    if (f.before == 0.0) continue;
    precision.diagonal[k - 1] += f.before * f.before;
    precision.beside[k - 1] = f.own * f.before;
  }
  return precision;
}

Eigen::SparseMatrix<double, Eigen::RowMajor> NoiseModel::Whiten(
    const LinearRun& run, const Eigen::SparseMatrix<double, Eigen::RowMajor>& rows) const {
  const std::vector<Filter> filters = FiltersOf(run, *this);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(rows.nonZeros()) * 2);
  for (int k = 0; k < run.Rows(); ++k) {
    const Filter& f = filters[static_cast<std::size_t>(k)];
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(rows, k); it; ++it) {
      entries.emplace_back(k, it.col(), f.own * it.value());
    }
    if (f.before == 0.0) continue;
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(rows, k - run.Channels()); it; ++it) {
      entries.emplace_back(k, it.col(), f.before * it.value());
    }
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> white(rows.rows(), rows.cols());
  white.setFromTriplets(entries.begin(), entries.end());
  return white;
}

}  // namespace twinbench::diagnose
