#include "twin/benches/turntable_autocollimator/ripples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <map>
#include <utility>

#include "twin/benches/turntable_autocollimator/estimators/collimator_sweep.h"
#include "twin/core/distributions.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/diagnose/products.h"

namespace twinbench::benches::turntable {
namespace {

using units::arcsec;

constexpr const char* kRipple = "autocollimator_periodic";
constexpr double kShortest_rad = 0.6 * arcsec, kWashedOut = 3.0;  // in noise

/// Along a reading of an axis, and how far the readings tell periods apart.
struct RippleCourse {
  std::function<double(const Reading&)> along_rad;  // what is shown, without the ripple where a sweep tells it
  double scale = kNaN, u_scale = kNaN;  // of it by the reference, in a sweep: what the ripple leaks into the line is in u
  double folds_at = 0.0;  // frequency whose wave is the same at all readings: f and folds_at - f are one wave; 0: none
};

using PassKey = std::pair<int, int>;  // set-up and pass

/// What a pass of a sweep shows as a line of the reference, or a cubic where it bends: all but its ripple.
struct SmoothPass {
  double middle_rad = 0.0, half_rad = 1.0;
  Eigen::VectorXd powers;
  double u_slope = kNaN;  // from the scatter about it, the ripple's included

  double Along(double target_rad) const { return (target_rad - middle_rad) / half_rad; }
  double Slope() const { return powers[1] / half_rad; }
  double Shown_rad(double target_rad) const {
    double shown_rad = 0.0;
    for (Eigen::Index k = powers.size(); k-- > 0;) shown_rad = shown_rad * Along(target_rad) + powers[k];
    return shown_rad;
  }
};

std::map<PassKey, SmoothPass> SmoothPassesOf(const std::vector<Reading>& readings, ShownOf shown_rad, int degree) {
  std::map<PassKey, std::vector<std::pair<double, double>>> passes;
  for (const Reading& r : readings)
    if (std::isfinite(shown_rad(r)) && std::isfinite(r.target_rad))
      passes[{r.setup, r.pass}].emplace_back(r.target_rad, shown_rad(r));
  std::map<PassKey, SmoothPass> smooth;
  for (const auto& [key, shown] : passes) {
    const auto [low, high] = std::ranges::minmax_element(shown);
    if (std::ssize(shown) < 2 * (degree + 1) || !(high->first > low->first)) continue;
    SmoothPass pass{0.5 * (low->first + high->first), 0.5 * (high->first - low->first), {}, kNaN};
    Eigen::MatrixXd powers = Eigen::MatrixXd::Ones(std::ssize(shown), degree + 1);
    Eigen::VectorXd values(std::ssize(shown));
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const auto& [target_rad, value_rad] = shown[static_cast<std::size_t>(i)];
      for (int k = 1; k <= degree; ++k) powers(i, k) = powers(i, k - 1) * pass.Along(target_rad);
      values[i] = value_rad;
    }
    pass.powers = SolveLeastSquares(powers, values);
    const Eigen::ArrayXd along = powers.col(1).array() - powers.col(1).mean();
    pass.u_slope = (values - powers * pass.powers).norm() / std::sqrt(static_cast<double>(values.size())) / along.matrix().norm() / pass.half_rad;
    smooth.emplace(key, pass);
  }
  return smooth;
}

/// Of x, which follows the reference: a cubic that is not there would take some of a long ripple with it.
bool Bends(const std::vector<Reading>& readings, ShownOf shown_rad) {
  const auto sweep = shown_rad == X_rad ? separate::turntable::AnalyseSweep(readings) : std::nullopt;
  return sweep && std::isfinite(sweep->axis.bend_rad.value);
}

/// Between neighbours of one pass, as it usually is; 0: no two are apart.
double UsualStep_rad(const std::vector<Reading>& readings, const std::function<double(const Reading&)>& along_rad) {
  constexpr double kSamePlace = 1e-6;  // of the way
  std::map<PassKey, std::vector<double>> passes;
  for (const Reading& r : readings)
    if (std::isfinite(along_rad(r))) passes[{r.setup, r.pass}].push_back(along_rad(r));
  std::vector<double> steps;
  for (auto& [key, at] : passes) {
    std::ranges::sort(at);
    for (std::size_t i = 1; i < at.size(); ++i)
      if (at[i] - at[i - 1] > kSamePlace * (at.back() - at.front())) steps.push_back(at[i] - at[i - 1]);
  }
  return steps.empty() ? 0.0 : Median(steps);
}

/// Length of the mean of a wave of this frequency: 1 where it is the same at all readings.
double MeanWave(const std::vector<double>& along_rad, double frequency) {
  std::complex<double> sum = 0.0;
  for (const double at : along_rad) sum += std::polar(1.0, units::turn * frequency * at);
  return std::abs(sum) / static_cast<double>(along_rad.size());
}

/// Passes that stand between each other's readings fold at a multiple of what one alone does.
double FoldsAt(const std::vector<double>& along_rad, double step_rad) {
  constexpr double kSame = 0.98;  // then a fifth of a wave's size at most tells the two apart
  constexpr int kMostPasses = 4, kTried = 20;
  if (!(step_rad > 0.0)) return 0.0;
  const auto [least, most] = std::ranges::minmax(along_rad);
  for (int k = 1; k <= kMostPasses; ++k) {
    double best = 0.0, at = 0.0;
    for (int i = -kTried; i <= kTried; ++i) {
      const double frequency = k / step_rad + i / (kTried * (most - least));
      const double same = frequency > 0.0 ? MeanWave(along_rad, frequency) : 0.0;
      if (same > best) std::tie(best, at) = std::pair(same, frequency);
    }
    if (best > kSame) return at;
  }
  return 0.0;
}

std::vector<double> AllAlong(const std::vector<Reading>& readings, const std::function<double(const Reading&)>& along_rad) {
  std::vector<double> all_rad;
  for (const Reading& r : readings)
    if (std::isfinite(along_rad(r))) all_rad.push_back(along_rad(r));
  return all_rad;
}

/// Of waves that look like this one, down to the shortest that is thought of, the longest first.
std::vector<double> AliasesOf(double period_rad, double folds_at) {
  std::vector<double> aliases_rad;
  const double own = 1.0 / period_rad, highest = 1.0 / kShortest_rad;
  for (int k = 0; k * folds_at < highest + own; ++k)
    for (const double other : {std::abs(k * folds_at - own), k * folds_at + own})
      if (other > 0.0 && other <= highest && std::abs(other - own) > 0.01 * own) aliases_rad.push_back(1.0 / other);
  std::ranges::sort(aliases_rad, std::greater());
  return aliases_rad;
}

RippleCourse RippleCourseOf(const std::vector<Reading>& readings, ShownOf shown_rad) {
  RippleCourse course;
  course.along_rad = shown_rad;
  if (!std::ranges::all_of(readings, IsInSweep)) return course;  // circles show x at steps of no size of their own
  const std::map<PassKey, SmoothPass> smooth = SmoothPassesOf(readings, shown_rad, Bends(readings, shown_rad) ? 3 : 1);
  if (!smooth.empty()) course.scale = course.u_scale = 0.0;
  for (const auto& [key, pass] : smooth) {  // the same steps leak the same into each
    course.scale += pass.Slope() / static_cast<double>(smooth.size());
    course.u_scale += pass.u_slope / static_cast<double>(smooth.size());
  }
  // A shown value has the ripple in it: a wave of the spacing of the readings along it would show that again.
  course.along_rad = [smooth, shown_rad](const Reading& r) {
    const auto pass = smooth.find({r.setup, r.pass});
    return pass != smooth.end() ? pass->second.Shown_rad(r.target_rad) : shown_rad(r);
  };
  const std::vector<double> all_rad = AllAlong(readings, course.along_rad);
  if (!all_rad.empty()) course.folds_at = FoldsAt(all_rad, UsualStep_rad(readings, course.along_rad));
  return course;
}

diagnose::ParameterEstimate* PeriodOf(diagnose::Cause& cause) {
  const auto found = std::ranges::find(cause.parameters, "period", &diagnose::ParameterEstimate::name);
  return cause.effect == kRipple && found != cause.parameters.end() ? &*found : nullptr;
}

/// The catalogue's period goes by what is shown, and is as sure as the line that it was sought along; the reference's own is surer.
void TellByReference(const RippleCourse& course, diagnose::ParameterEstimate& period, diagnose::Diagnosis& diagnosis) {
  const double by_reference_rad = period.value / course.scale;
  if (std::abs(by_reference_rad - period.value) > period.u)
    diagnosis.notes.push_back(fmt::format("{} at x: its period goes by what is shown; by the reference it is {:.6g} ± {:.2g} arcsec", kRipple,
                                          by_reference_rad / arcsec, period.u / course.scale / arcsec));
  period.u = std::hypot(period.u, period.value * course.u_scale / course.scale);
}

/// As of orders (aliased_orders.h): what is about as likely as the period that was named leaves it open.
void TellAliases(const RippleCourse& course, double period_rad, diagnose::Cause& cause, diagnose::Diagnosis& diagnosis) {
  constexpr double kAsLikely = 9.0;
  constexpr std::size_t kMostAliases = 3;
  const std::vector<double> aliases_rad = AliasesOf(period_rad, course.folds_at);
  if (aliases_rad.empty()) return;
  std::string periods;
  for (std::size_t k = 0; k < std::min(kMostAliases, aliases_rad.size()); ++k) {
    periods += fmt::format("{}{:.4g}", k == 0 ? "" : ", ", aliases_rad[k] / arcsec);
    cause.indistinguishable_from.push_back({kRipple, fmt::format("period {:.4g} arcsec", aliases_rad[k] / arcsec), 1.0});
  }
  cause.next_measurement = "a sweep in steps of another size, no whole part of these";
  if (diagnosis.verdict == diagnose::Verdict::kNamed && aliases_rad.front() > period_rad / kAsLikely)
    diagnosis.verdict = diagnose::Verdict::kTie;
  diagnosis.notes.push_back(fmt::format("{} at {}: at readings {:.4g} arcsec apart a period of {:.4g} arcsec looks like one of {}{}", kRipple,
                                        cause.where, 1.0 / course.folds_at / arcsec, period_rad / arcsec, periods,
                                        aliases_rad.size() > kMostAliases ? ", ..." : ""));
}

}  // namespace

void TellPeriods(const std::vector<Reading>& readings, diagnose::Diagnosis& diagnosis) {
  for (diagnose::Cause& cause : diagnosis.causes) {
    diagnose::ParameterEstimate* const period = PeriodOf(cause);
    if (period == nullptr) continue;
    const RippleCourse course = RippleCourseOf(readings, cause.where == "x" ? X_rad : Y_rad);
    if (course.folds_at > 0.0) TellAliases(course, period->value, cause, diagnosis);
    if (cause.where == "x" && std::isfinite(course.scale)) TellByReference(course, *period, diagnosis);
  }
}

void AddRipples(const std::vector<Reading>& readings, const std::string& axis, ShownOf shown_rad, const TurntableSettings& own,
                diagnose::TwinComparison& comparison) {
  const RippleCourse course = RippleCourseOf(readings, shown_rad);
  const std::vector<double> all_rad = AllAlong(readings, course.along_rad);
  if (all_rad.empty()) return;
  const auto [least, most] = std::ranges::minmax(all_rad);
  const double pixel_rad = own.collimator.pixel_pitch_m / (2.0 * own.collimator.focal_length_m);
  const double shortest_rad = std::max(kShortest_rad, kWashedOut * own.ReadingNoise_rad());
  const double longest_rad = (most - least) / 1.5;
  const auto add = [&](double from_rad, double to_rad) {
    diagnose::TwinComparison::Product ripple =
        diagnose::WaveAlong(kRipple, axis, "autocollimator." + axis, "period", course.along_rad, from_rad, to_rad);
    ripple.sizes = {"amplitude", "amplitude"};
    ripple.is_wave = true;
    comparison.products.push_back(ripple);
  };
  const double told_rad = course.folds_at > 0.0 ? std::max(shortest_rad, 2.0 / course.folds_at) : shortest_rad;
  if (pixel_rad > told_rad && pixel_rad < longest_rad) add(0.99 * pixel_rad, 1.01 * pixel_rad);
  if (longest_rad > 1.2 * told_rad) add(told_rad, longest_rad);
}

}  // namespace twinbench::benches::turntable
