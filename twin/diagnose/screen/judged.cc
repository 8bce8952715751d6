#include <cmath>

#include "twin/diagnose/screen/tests.h"

namespace twinbench::diagnose::screen {
namespace {

/// What a size on one channel amounts to as an angle; NaN if no rotation moves it.
double AsAngle(const LinearRun& run, int channel, double size_SI) {
  double shown = 0.0;
  for (const Pattern& p : run.patterns) {
    if (p.name == "yaw" || p.name == "tilt" || p.name == "roll")
      shown = std::max(shown, std::abs(p.weight[channel]));
  }
  return shown > 0.0 ? size_SI / shown : kNaN;
}

}  // namespace

Judged Judge(const LinearRun& run, const NoiseModel& noise, const Projector& projector) {
  constexpr double kLeastRedundancy = 0.05;  // a row below says nothing about its own noise
  Judged judged{run, noise, projector, projector.Redundancy(), {}};
  judged.rows.resize(run.channels.size());
  for (int row = 0; row < run.Rows(); ++row) {
    if (judged.redundancy[row] > kLeastRedundancy) judged.rows[run.ChannelOf(row)].push_back(row);
  }
  return judged;
}

std::vector<int> Judged::Channels(int fewest) const {
  std::vector<int> channels;
  for (int c = 0; c < run.Channels(); ++c) {
    if (std::ssize(rows[c]) >= fewest) channels.push_back(c);
  }
  return channels;
}

Eigen::MatrixXd Judged::Normalised(const Eigen::MatrixXd& residual, int channel) const {
  return redundancy(rows[channel]).cwiseSqrt().cwiseInverse().asDiagonal() * residual(rows[channel], Eigen::all);
}

Eigen::MatrixXd ByColumn(const Eigen::MatrixXd& residual,
                         const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& scores) {
  Eigen::MatrixXd all;
  for (Eigen::Index j = 0; j < residual.cols(); ++j) {
    const Eigen::VectorXd of_run = scores(residual.col(j));
    if (j == 0) all.resize(of_run.size(), residual.cols());
    all.col(j) = of_run;
  }
  return all;
}

void SetEffect(const LinearRun& run, int channel, double size_SI, ResidualTest& test) {
  if (run.IsMixed()) return;
  const bool is_angle = run.unit == "arcsec" || run.unit == "deg" || run.unit == "rad";
  test.effect_m = is_angle ? kNaN : size_SI;
  test.effect_rad = is_angle ? size_SI : AsAngle(run, channel, size_SI);
}

double TypicalSigma(const LinearRun& run, int channel) {
  const auto rows = Eigen::seqN(channel, run.schedule.Readings(), run.Channels());
  return run.sigma(rows).norm() / std::sqrt(static_cast<double>(run.schedule.Readings()));
}

double Beside(double sigma, double ratio) {
  return sigma * std::sqrt(std::abs(ratio * ratio - 1.0));
}

}  // namespace twinbench::diagnose::screen
