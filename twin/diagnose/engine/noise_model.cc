#include "twin/diagnose/engine/noise_model.h"

#include <algorithm>

#include "twin/core/errors.h"

namespace twinbench::diagnose {
namespace {

/// True if reading i directly follows reading i - 1 in the same pass.
bool Follows(const Schedule& s, int i) {
  const auto at = [](const std::vector<int>& v, int k) { return v[static_cast<std::size_t>(k)]; };
  return i > 0 && at(s.setup, i) == at(s.setup, i - 1) && at(s.pass, i) == at(s.pass, i - 1) &&
         s.phase[static_cast<std::size_t>(i)] == s.phase[static_cast<std::size_t>(i - 1)];
}

/// Whitening as a matrix: row k has a one over what is left of it, and behind it what the rows before say, by how many
/// of them there are.
class Filters {
 public:
  Filters(const LinearRun& run, const NoiseModel& noise)
      : channels_(run.Channels()), before_(RowsBefore(run, noise.memory.Order())) {
    Require(noise.sigma.size() == run.Rows(), "a noise model has as many deviations as the run has rows");
    for (const Forecast& forecast : ForecastsOf(noise.memory)) {
      std::vector<double> taps = {1.0 / forecast.left};
      for (const double weight : forecast.weights) taps.push_back(-weight / forecast.left);
      taps_.push_back(std::move(taps));
    }
  }

  /// @param visit  Gets the row before, k itself first, and its factor.
  template <class Visit>
  void ForEach(Eigen::Index k, const Visit& visit) const {
    const std::vector<double>& taps = taps_[static_cast<std::size_t>(before_[static_cast<std::size_t>(k)])];
    for (std::size_t j = 0; j < taps.size(); ++j) visit(k - static_cast<Eigen::Index>(j) * channels_, taps[j]);
  }

 private:
  Eigen::Index channels_;
  std::vector<int> before_;
  std::vector<std::vector<double>> taps_;  // by rows before
};

}  // namespace

std::vector<int> RowsBefore(const LinearRun& run, std::size_t most) {
  std::vector<int> before(static_cast<std::size_t>(run.Rows()));
  if (most == 0) return before;
  for (int k = run.Channels(); k < run.Rows(); ++k) {
    if (!Follows(run.schedule, run.ReadingOf(k))) continue;
    const int so_far = before[static_cast<std::size_t>(k - run.Channels())];
    before[static_cast<std::size_t>(k)] = std::min(so_far + 1, static_cast<int>(most));
  }
  return before;
}

Eigen::MatrixXd NoiseModel::Whiten(const LinearRun& run, const Eigen::MatrixXd& rows) const {
  if (memory.IsWhite()) return sigma.cwiseInverse().asDiagonal() * rows;
  return Whiten(run, rows, RowsOf{});
}

RunsByRow NoiseModel::Whiten(const LinearRun& run, const Eigen::MatrixXd& rows, RowsOf which) const {
  const Eigen::VectorXd sigma_of = sigma(Eigen::seqN(which.first, rows.rows(), which.stride));
  RunsByRow scaled = sigma_of.cwiseInverse().asDiagonal() * rows;
  if (memory.IsWhite()) return scaled;
  const Filters filters(run, *this);
  RunsByRow white = RunsByRow::Zero(rows.rows(), rows.cols());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    filters.ForEach(which.first + i * which.stride, [&](Eigen::Index at, double factor) {
      const Eigen::Index before = (at - which.first) / which.stride;
      AddScaled(factor, scaled.row(before).data(), scaled.cols(), white.row(i).data());
    });
  }
  return white;
}

Eigen::MatrixXd NoiseModel::WhitenTransposed(const LinearRun& run, const Eigen::MatrixXd& white) const {
  if (memory.IsWhite()) return sigma.cwiseInverse().asDiagonal() * white;
  const Filters filters(run, *this);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(white.rows(), white.cols());
  for (Eigen::Index k = 0; k < white.rows(); ++k)
    filters.ForEach(k, [&](Eigen::Index at, double factor) { rows.row(at) += factor * white.row(k); });
  return sigma.cwiseInverse().asDiagonal() * rows;
}

Banded NoiseModel::Precision(const LinearRun& run) const {
  Require(run.Channels() == 1, "neighbouring rows are neighbouring readings only on one channel");
  const Filters filters(run, *this);
  Banded precision{Eigen::VectorXd::Zero(run.Rows()), {}};
  precision.beside.assign(memory.Order(), Eigen::VectorXd::Zero(run.Rows()));
  for (Eigen::Index k = 0; k < run.Rows(); ++k) {
    filters.ForEach(k, [&](Eigen::Index later, double a) {
      filters.ForEach(k, [&](Eigen::Index at, double b) {
        const double product = a * b / (sigma[at] * sigma[later]);
        if (at == later) precision.diagonal[at] += product;
        if (at < later) precision.beside[static_cast<std::size_t>(later - at - 1)][at] += product;
      });
    });
  }
  return precision;
}

Eigen::SparseMatrix<double, Eigen::RowMajor> NoiseModel::Whiten(
    const LinearRun& run, const Eigen::SparseMatrix<double, Eigen::RowMajor>& rows) const {
  const Filters filters(run, *this);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(rows.nonZeros()) * (1 + memory.Order()));
  for (Eigen::Index k = 0; k < run.Rows(); ++k) {
    filters.ForEach(k, [&](Eigen::Index at, double factor) {
      for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(rows, at); it; ++it)
        entries.emplace_back(static_cast<int>(k), static_cast<int>(it.col()), factor / sigma[at] * it.value());
    });
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> white(rows.rows(), rows.cols());
  white.setFromTriplets(entries.begin(), entries.end());
  return white;
}

}  // namespace twinbench::diagnose
