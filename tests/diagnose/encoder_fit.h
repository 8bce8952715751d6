#pragma once

#include <Eigen/Core>

#include "tests/sim/encoder_run.h"
#include "twin/benches/encoder_comparison/diagnosis/encoder_run.h"
#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/benches/encoder_comparison/twin/factory.h"
#include "twin/core/linear_algebra.h"

/// Readings as a diagnosis takes them, against the twin that follows them.
namespace twinbench::diagnose::encoder {
inline EncoderRun RunOf(const std::vector<Reading>& readings, const Scenario& scenario) {
  return BuildRun(readings, scenario, benches::encoder::FollowRecord);
}
}  // namespace twinbench::diagnose::encoder

/// Fits single families to noise-free runs of the twin: what each leaves of the effect that it is made for.
namespace twinbench::diagnose::test {

using twinbench::test::EncoderEffect, twinbench::test::EncoderScenario, twinbench::test::ReadingsWith;

struct Fit {
  int grid_point = 0;
  Eigen::VectorXd amplitudes;
  double left = Amplitude::kInfinity;  // share of the signal's rms that stays
};

/// Least squares of columns and the offsets of the set-ups.
inline Fit FitOf(const Eigen::MatrixXd& columns, const LinearRun& run, int grid_point = 0) {
  const Eigen::MatrixXd offsets = run.nuisance.jacobian.toDense();
  Eigen::MatrixXd all(columns.rows(), columns.cols() + offsets.cols());
  all << columns, offsets;
  const Eigen::VectorXd x = SolveShortest(all, run.residual);
  const Eigen::VectorXd signal = run.residual - offsets * SolveShortest(offsets, run.residual);
  return {grid_point, x.head(columns.cols()), (run.residual - all * x).norm() / signal.norm()};
}
inline Fit FitAt(const Family& family, int g, const LinearRun& run) { return FitOf(family.ColumnsAt(g), run, g); }

/// The best grid point.
inline Fit BestFit(const Family& family, const LinearRun& run) {
  Fit best;
  for (int g = 0; g < family.grid; ++g) {
    const Fit fit = FitAt(family, g, run);
    if (fit.left < best.left || g == 0) best = fit;
  }
  return best;
}

inline const Family& FamilyOf(const std::vector<Family>& families, const std::string& effect) {
  for (const Family& family : families) {
    if (family.effect == effect) return family;
  }
  throw std::runtime_error("there is no family " + effect);
}

inline bool HasFamily(const std::vector<Family>& families, const std::string& effect) {
  for (const Family& family : families) {
    if (family.effect == effect) return true;
  }
  return false;
}

/// The catalogue's parameters as fitted; without cov they have no uncertainty.
inline std::map<std::string, double> ParametersOf(const Family& family, const Fit& fit) {
  std::map<std::string, double> values;
  const Eigen::VectorXd shape = family.ShapeAt(fit.grid_point);
  const Eigen::Index n = fit.amplitudes.size();
  if (family.parameters) {
    for (const ParameterEstimate& p : family.parameters(shape, fit.amplitudes, Eigen::MatrixXd::Identity(n, n)))
      values[p.name] = p.value;
    return values;
  }
  for (Eigen::Index j = 0; j < n; ++j) values[family.amplitudes[j].name] = fit.amplitudes[j];
  for (Eigen::Index k = 0; k < shape.size(); ++k) values[family.shapes[k].name] = shape[k];
  return values;
}

}  // namespace twinbench::diagnose::test
