#include <fmt/format.h>

#include <cmath>

#include "twin/diagnose/screen/tests.h"

namespace twinbench::diagnose::screen {

/// Chi-squared of all rows. Its degrees of freedom are rows less what the free unknowns take up, a calibrated one
/// in part: there the distribution is no textbook's, and p is the simulated one.
std::optional<Test> FitToStatedNoise(const Judged& judged) {
  const LinearRun& run = judged.run;
  const double dof = judged.redundancy.sum();
  if (!run.sigma_stated || !(dof > 0.0)) return std::nullopt;
  const auto scores = [](const Eigen::MatrixXd& residual) -> Eigen::MatrixXd {
    return residual.colwise().squaredNorm().array().max(1e-300).log();
  };
  const auto tell = [&run, dof](int, const Eigen::VectorXd& residual, ResidualTest& test) {
    test.statistic = residual.squaredNorm();
    const double ratio = std::sqrt(test.statistic / dof);
    if (run.Channels() == 1) SetEffect(run, 0, Beside(TypicalSigma(run, 0), ratio), test);
    test.reading = fmt::format(
        "chi-squared is {:.1f} of {:.1f} degrees of freedom, residuals are {:.3f} times the stated noise: {}",
        test.statistic, dof, ratio,
        ratio > 1.0 ? "something is not modelled, or the noise figure is too small"
                    : "the noise figure is too large");
  };
  return Test{"fit to stated noise", {"all readings"}, true, scores, tell};
}

}  // namespace twinbench::diagnose::screen
