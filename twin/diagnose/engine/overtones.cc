#include "twin/diagnose/engine/overtones.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "twin/diagnose/engine/base.h"
#include "twin/diagnose/engine/refine.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

constexpr int kHighest = 5;
constexpr double kEnough = 500.0;  // of what overtones explain: no doubt is left, and nothing overflows

bool IsNamedWave(const Family& family) {
  return family.kind == Kind::kNamed && family.at && family.shapes.size() == 1 &&
         family.shapes.front().name == "frequency";
}

/// Rows x columns of the wave at 2, 3, ... times its frequency.
Eigen::MatrixXd Overtones(const Family& family, const Eigen::VectorXd& frequency_Hz) {
  Eigen::MatrixXd all = family.at(2.0 * frequency_Hz);
  for (int n = 3; n <= kHighest; ++n) all = HStack(all, family.at(n * frequency_Hz));
  return all;
}

/// @param fundamental, overtones  What they explain, in units of the noise, and in how many columns.
double BayesFactor(double fundamental, double overtones, double columns) {
  constexpr std::array kStrengths = {1.0 / 6.0, 1.0 / 3.0, 2.0 / 3.0};  // a square wave has 1/3, 1/5; a sawtooth 1/2, 1/3, ...
  double sum = 0.0;
  for (const double strength : kStrengths) {
    const double d2 = 0.5 * strength * strength * fundamental;  // half of it in the cosine, half in the sine
    sum += std::exp(0.5 * (overtones * d2 / (1.0 + d2) - columns * std::log1p(d2)));
  }
  return sum / kStrengths.size();
}

}  // namespace

bool HasNamedWave(const std::vector<Family>& families, const std::vector<Term>& terms) {
  return std::ranges::any_of(terms, [&](const Term& t) { return IsNamedWave(families[static_cast<std::size_t>(t.family)]); });
}

double ProbabilityOfOvertones(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                              const std::vector<Family>& families, const Eigen::MatrixXd& white,
                              const std::vector<Term>& terms, const Eigen::MatrixXd& columns) {
  const Deflation others(projector, columns);
  const Projected left = Project(projector, others, white);
  const double per_degree =
      std::max(1.0, left.power[0] / (projector.DegreesOfFreedom() - static_cast<double>(others.Rank())));
  double most = 0.0;
  for (const Term& term : terms) {
    const Family& family = families[static_cast<std::size_t>(term.family)];
    if (!IsNamedWave(family)) continue;
    const Eigen::MatrixXd overtones = noise.Whiten(run, Overtones(family, term.shape));
    const double explained = Explain(overtones, projector, others, left.rows.col(0)).power;
    const double odds =
        tuning::kNoSine * BayesFactor(term.explained / per_degree, std::min(explained / per_degree, kEnough),
                                      static_cast<double>(overtones.cols()));
    most = std::max(most, odds / (1.0 + odds));
  }
  return most;
}

}  // namespace twinbench::diagnose
