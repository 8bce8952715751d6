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

inline bool HasFamily(const std::vector<Family>& families, const std::string& effect) {
  return std::ranges::count(families, effect, &Family::effect) > 0;
}

inline const Family& FamilyOf(const std::vector<Family>& families, const std::string& effect) {
  if (!HasFamily(families, effect)) throw std::runtime_error("there is no family " + effect);
  return *std::ranges::find(families, effect, &Family::effect);
}

}  // namespace twinbench::diagnose::test
