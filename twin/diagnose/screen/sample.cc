#include "twin/diagnose/screen/sample.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "twin/core/errors.h"
#include "twin/core/stream.h"

namespace twinbench::diagnose::screen {
namespace {

std::vector<Whitening> WhiteningByChannel(const LinearRun& run, const NoiseModel& noise) {
  Whitening identity(run.Rows(), run.Rows());
  identity.setIdentity();
  const Whitening all = noise.Whiten(run, identity);
  std::vector<std::vector<Eigen::Triplet<double>>> entries(run.channels.size());
  for (int row = 0; row < run.Rows(); ++row) {
    for (Whitening::InnerIterator it(all, row); it; ++it) {
      const auto from = static_cast<int>(it.col());
      Require(run.ChannelOf(from) == run.ChannelOf(row), "whitening keeps channels apart");
      entries[static_cast<std::size_t>(run.ChannelOf(row))].emplace_back(run.ReadingOf(row), run.ReadingOf(from),
                                                                         it.value());
    }
  }
  std::vector<Whitening> whitening(run.channels.size(),
                                   Whitening(run.schedule.Readings(), run.schedule.Readings()));
  for (std::size_t c = 0; c < entries.size(); ++c)
    whitening[c].setFromTriplets(entries[c].begin(), entries[c].end());
  return whitening;
}

Eigen::MatrixXd Normals(std::uint64_t seed, const char* name, Eigen::Index rows, int columns) {
  Stream stream(seed, name);
  Eigen::MatrixXf normals(rows, columns);
  stream.FillNormals({normals.data(), static_cast<std::size_t>(normals.size())});
  return normals.cast<double>();
}

/// Prior deviations, no wider than kWide times what the rows alone could tell.
Eigen::VectorXd UsefulPriors(const Projector& projector, const Nuisance& nuisance) {
  constexpr double kWide = 1e4;
  Eigen::VectorXd squared = Eigen::VectorXd::Zero(projector.Jacobian().cols());
  for (int k = 0; k < projector.Jacobian().rows(); ++k) {
    Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(projector.Jacobian(), k);
    for (; it; ++it) squared[it.col()] += it.value() * it.value();
  }
  const Eigen::VectorXd prior = nuisance.prior_precision.cwiseSqrt().cwiseInverse();
  return (squared.array() > 0.0).select(prior.cwiseMin((kWide / squared.array().sqrt()).matrix()), 0.0);
}

/// Root mean square of one channel of a column, by degree of freedom; 1 where nothing is left.
double Level(const Sample& s, int column, int channel) {
  const int channels = s.run.Channels();
  double sum = 0.0, dof = 0.0;
  for (int k = channel; k < s.run.Rows(); k += channels) {
    sum += s.residual(k, column) * s.residual(k, column);
    dof += s.redundancy[k];
  }
  return sum > 0.0 && dof > 0.0 ? std::sqrt(sum / dof) : 1.0;
}

void LevelChannels(Sample& s) {
  const int channels = s.run.Channels();
  s.levelled = s.residual;
  s.level.resize(channels);
  for (int j = 0; j < s.Columns(); ++j) {
    for (int c = 0; c < channels; ++c) {
      const double level = Level(s, j, c);
      if (j == 0) s.level[c] = level;
      for (int k = c; k < s.run.Rows(); k += channels) s.levelled(k, j) /= level;
    }
  }
}

void FillAdjoint(Sample& s) {
  const int channels = s.run.Channels(), readings = s.run.schedule.Readings();
  for (int c = 0; c < channels; ++c) {
    const Eigen::MatrixXd rows = s.levelled(Eigen::seqN(c, readings, channels), Eigen::all);
    s.adjoint.emplace_back(s.whitening[static_cast<std::size_t>(c)].transpose() * rows);
  }
}

}  // namespace

Sample Simulate(const LinearRun& run, const NoiseModel& noise, const Projector& projector, int null_runs,
                std::uint64_t seed) {
  Require(null_runs >= 50, "the screen needs at least 50 null runs");
  Require(run.Rows() == run.schedule.Readings() * run.Channels(), "a run has one row a reading and channel");
  Sample s{run, projector, WhiteningByChannel(run, noise), projector.Redundancy(), {}, {}, {}, {}};
  Eigen::MatrixXd white(run.Rows(), 1 + null_runs);
  const Eigen::MatrixXd unknowns =
      UsefulPriors(projector, run.nuisance).asDiagonal() *
      Normals(seed, "screen.null.unknowns", run.nuisance.prior_precision.size(), null_runs);
  white.col(0) = noise.Whiten(run, Eigen::MatrixXd(run.residual));
  white.rightCols(null_runs) =
      Normals(seed, "screen.null.noise", run.Rows(), null_runs) + projector.Jacobian() * unknowns;
  s.residual = projector.Apply(white);
  LevelChannels(s);
  FillAdjoint(s);
  return s;
}

double PValue(const Eigen::VectorXd& statistic) {
  const auto nulls = static_cast<int>(statistic.size()) - 1;
  std::vector<double> sorted(statistic.data() + 1, statistic.data() + statistic.size());
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  const int tail = std::max(10, nulls / 10);
  const double threshold = sorted[static_cast<std::size_t>(tail)];
  if (!(statistic[0] > threshold)) {
    const auto above = std::count_if(sorted.begin(), sorted.end(), [&](double v) { return v >= statistic[0]; });
    return (static_cast<double>(above) + 1.0) / (nulls + 1.0);
  }
  double excess = 0.0;
  for (int i = 0; i < tail; ++i) excess += (sorted[static_cast<std::size_t>(i)] - threshold) / tail;
  const double share = (tail + 1.0) / (nulls + 1.0) * std::exp(-(statistic[0] - threshold) / excess);
  return std::max(share, std::numeric_limits<double>::min());
}

Eigen::MatrixXd Standardised(const Eigen::MatrixXd& values) {
  const auto nulls = static_cast<double>(values.cols() - 1);
  const Eigen::VectorXd mean = values.rightCols(values.cols() - 1).rowwise().mean();
  Eigen::MatrixXd scores = values.colwise() - mean;
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    const double sd = scores.row(i).tail(values.cols() - 1).norm() / std::sqrt(nulls);
    scores.row(i) *= sd > 1e-9 * std::abs(mean[i]) && sd > 0.0 ? 1.0 / sd : 0.0;
  }
  return scores;
}

}  // namespace twinbench::diagnose::screen
