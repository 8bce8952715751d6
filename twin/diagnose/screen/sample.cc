#include "twin/diagnose/screen/sample.h"

#include <cmath>

#include "twin/core/errors.h"
#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/significance.h"

namespace twinbench::diagnose::screen {
namespace {

/// Takes the rows of one channel out of those of all.
Whitening RowsTaken(const LinearRun& run, int channel) {
  Whitening taken(run.schedule.Readings(), run.Rows());
  for (int i = 0; i < run.schedule.Readings(); ++i) taken.insert(i, i * run.Channels() + channel) = 1.0;
  return taken;
}

std::vector<Whitening> WhiteningByChannel(const LinearRun& run, const NoiseModel& noise) {
  Whitening identity(run.Rows(), run.Rows());
  identity.setIdentity();
  const Whitening all = noise.Whiten(run, identity);
  std::vector<Whitening> whitening;
  Eigen::Index entries = 0;
  for (int c = 0; c < run.Channels(); ++c) {
    const Whitening taken = RowsTaken(run, c);
    whitening.emplace_back(Whitening(taken * all) * Whitening(taken.transpose()));
    entries += whitening.back().nonZeros();
  }
  Require(entries == all.nonZeros(), "whitening keeps channels apart");
  return whitening;
}

/// Prior deviations, no wider than kWide times what the rows alone could tell.
Eigen::VectorXd UsefulPriors(const Projector& projector, const Nuisance& nuisance) {
  constexpr double kWide = 1e4;
  const auto& jacobian = projector.Jacobian();
  const Eigen::ArrayXd norm =
      (jacobian.cwiseAbs2().transpose() * Eigen::VectorXd::Ones(jacobian.rows())).array().sqrt();
  return (norm > 0.0).select(nuisance.prior_precision.array().rsqrt().min(kWide / norm), 0.0);
}

void LevelChannels(Sample& s) {
  s.levelled = s.residual;
  s.level.resize(s.run.Channels());
  for (int c = 0; c < s.run.Channels(); ++c) {
    const auto rows = RowsOf(s.run, c);
    const double dof = s.redundancy(rows).sum();
    const Eigen::RowVectorXd squares = s.residual(rows, Eigen::all).colwise().squaredNorm();
    for (int j = 0; j < s.Columns(); ++j) {
      const double level = squares[j] > 0.0 && dof > 0.0 ? std::sqrt(squares[j] / dof) : 1.0;
      if (j == 0) s.level[c] = level;
      s.levelled.col(j)(rows) /= level;
    }
    s.adjoint.emplace_back(s.whitening[c].transpose() * Eigen::MatrixXd(s.levelled(rows, Eigen::all)));
  }
}

}  // namespace

double Sample::Unit_SI(int channel) const {
  return level[channel] * TypicalSigma(run, channel);
}

Sample Simulate(const LinearRun& run, const NoiseModel& noise, const Projector& projector, int null_runs,
                std::uint64_t seed) {
  Require(null_runs >= 50, "the screen needs at least 50 null runs");
  Require(run.Rows() == run.schedule.Readings() * run.Channels(), "a run has one row a reading and channel");
  Sample s{run, projector, WhiteningByChannel(run, noise), projector.Redundancy(), {}, {}, {}, {}};
  Stream of_unknowns(seed, "screen.null.unknowns"), of_noise(seed, "screen.null.noise");
  const Eigen::MatrixXd unknowns = UsefulPriors(projector, run.nuisance).asDiagonal() *
                                   Normals(of_unknowns, run.nuisance.prior_precision.size(), null_runs);
  Eigen::MatrixXd white(run.Rows(), 1 + null_runs);
  white << noise.Whiten(run, Eigen::MatrixXd(run.residual)),
      Normals(of_noise, run.Rows(), null_runs) + projector.Jacobian() * unknowns;
  s.residual = projector.Apply(white);
  LevelChannels(s);
  return s;
}

}  // namespace twinbench::diagnose::screen
