#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/KroneckerProduct>

#include "twin/diagnose/screen/scan.h"
#include "twin/diagnose/screen/sizes.h"

/// Where a fitted shape shows: in a pattern of the run, on one channel, or on several without a known pattern.
namespace twinbench::diagnose::screen {
namespace {

void SetLargestAmplitude(const LinearRun& run, const Fit& fit, ScreenTest& test) {
  int largest = 0;
  const Eigen::RowVectorXd size = fit.amplitude.reshaped(fit.width, run.Channels()).colwise().norm();
  const double size_SI = size.maxCoeff(&largest);
  SetEffect(run, largest, size_SI, test);
}

/// What a place must explain to be named: 3/4 of what exceeds the expectation of noise, and half of all.
double LeastToName(const Fit& fit) {
  return std::max(fit.width + 0.75 * (fit.chi2[0] - fit.dof), 0.5 * fit.chi2[0]);
}

/// Each channel takes the pattern's weight times one common set of amplitudes.
Fit CommonFit(const Fit& fit, const Pattern& pattern) {
  const Eigen::MatrixXd each = Eigen::MatrixXd::Identity(fit.width, fit.width);
  return fit.Constrained(Eigen::kroneckerProduct(pattern.weight, each), fit.width);
}

}  // namespace

void Describe(const Sample& sample, const Fit& fit, bool one_shape, const std::string& item, ScreenTest& test) {
  const LinearRun& run = sample.run;
  std::string place = run.Channels() == 1 ? "on " + run.channels.front() : "on several channels";
  SetLargestAmplitude(run, fit, test);
  double best = LeastToName(fit);
  const auto offer = [&](const Pattern& pattern, const std::string& words) {
    const Fit common = CommonFit(fit, pattern);
    if (run.Channels() == 1 || !(common.chi2[0] > best)) return;
    best = common.chi2[0];
    place = words;
    SetEffect(run, pattern, common.amplitude.norm(), test);
  };
  if (one_shape) {
    for (const Pattern& p : run.patterns) offer(p, "in " + p.name);
  }
  for (int c = 0; c < run.Channels(); ++c)
    offer({run.channels[c], Eigen::VectorXd::Unit(run.Channels(), c)}, "on " + run.channels[c]);
  test.reading = ReadingOf(test.name, item, place);
}

}  // namespace twinbench::diagnose::screen
