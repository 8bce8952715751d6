#include "twin/benches/encoder_comparison/diagnosis/stop_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/families.h"
#include "twin/benches/encoder_comparison/diagnosis/target_curve.h"
#include "twin/core/robust_scale.h"
#include "twin/core/units.h"
#include "twin/diagnose/tuning.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::encoder {
namespace {

/// The target of each reading, counted from the lowest: readings within a fiftieth of a step are at one.
std::vector<int> TargetOf(const SignalContext& c) {
  constexpr double kSame = 0.02;
  const double same_rad = kSame * 2.0 * RunUp_rad(c);
  std::vector<Eigen::Index> rising(static_cast<std::size_t>(c.Readings()));
  std::iota(rising.begin(), rising.end(), 0);
  std::ranges::stable_sort(rising, {}, [&c](Eigen::Index i) { return c.reference_rad[i]; });
  std::vector<int> target(rising.size());
  int last = 0;
  for (std::size_t k = 0; k < rising.size(); ++k) {
    if (k > 0 && c.reference_rad[rising[k]] - c.reference_rad[rising[k - 1]] > same_rad) ++last;
    target[static_cast<std::size_t>(rising[k])] = last;
  }
  return target;
}

/// Visits of each target in one sense.
Eigen::VectorXd Visits(const SignalContext& c, const Eigen::MatrixXd& targets, int sense) {
  Eigen::VectorXd is(c.Readings());
  for (Eigen::Index i = 0; i < is.size(); ++i)
    is[i] = c.direction[static_cast<std::size_t>(i)] == sense ? 1.0 : 0.0;
  return targets.transpose() * is;
}

Eigen::VectorXd LeftOver(const LargeCauses& large) {
  const Searched& last = large.Last();
  const LinearRun& run = last.encoder.run;
  Eigen::MatrixXd left = run.residual;
  for (const Term& term : last.analysis.found.terms) left -= term.columns * term.amplitudes;
  return left - run.nuisance.jacobian * last.analysis.projector->Solve(last.analysis.noise.Whiten(run, left));
}

/// At each reading, the mean at its target.
Eigen::VectorXd MeansAt(const Eigen::MatrixXd& targets, const Eigen::VectorXd& rows) {
  return targets * AtTargets(targets, rows);
}

/// A shape without a name that goes by the angle.
bool IsOfAngle(const Family& family) {
  return family.kind == Kind::kUnknown && (family.effect == "harmonic" || family.effect == "line");
}

/// Free numbers of what goes by the angle, among the causes and what was found beside them.
double NumbersByAngle(const LargeCauses& large) {
  constexpr std::array kWaves = {"eccentricity", "ellipticity",       "periodic",         "gear_mesh",
                                 "signal_offset", "amplitude_mismatch", "quadrature_error", "interpolation"};
  double numbers = 0.0;
  const auto add = [&](const std::string& effect) {
    if (std::ranges::count(kWaves, effect) > 0) numbers += 2.0;
    if (effect == "scale") numbers += 1.0;
  };
  for (const LargeCause& cause : large.causes) add(cause.effect.name);
  for (const Term& term : large.Last().analysis.found.terms)
    add(large.Last().families[static_cast<std::size_t>(term.family)].effect);
  return numbers;
}

using TargetNumbers = std::vector<Eigen::Index>;

/// Those that are far off what the others lie on to their noise; nothing if these are too few, or scatter by more.
/// @param deviations  From where on one is far.  @param most  Share of the targets that may be.
std::optional<TargetNumbers> FarOff(const EncoderRun& encoder, const Eigen::MatrixXd& targets, const Eigen::VectorXd& off_rad, double deviations,
                                    double most) {
  constexpr double kLikeNoise = 2.0;
  const double usual_rad = RobustDeviation(off_rad);
  const double visits = static_cast<double>(targets.rows()) / static_cast<double>(targets.cols());
  if (usual_rad > kLikeNoise * encoder.run.sigma.mean() / std::sqrt(visits)) return {};
  std::vector<bool> is_far(static_cast<std::size_t>(off_rad.size()));
  const Eigen::Index last = off_rad.size() - 1;
  for (Eigen::Index k = 0; k <= last; ++k) {
    if (!(std::abs(off_rad[k]) > deviations * usual_rad)) continue;
    // A place has flanks.
    const auto goes_on = [&](Eigen::Index at) { return at >= 0 && at <= last && off_rad[at] * off_rad[k] > 0.0 && std::abs(off_rad[at]) > usual_rad; };
    is_far[static_cast<std::size_t>(k)] = true;
    for (Eigen::Index at = k - 1; goes_on(at); --at) is_far[static_cast<std::size_t>(at)] = true;
    for (Eigen::Index at = k + 1; goes_on(at); ++at) is_far[static_cast<std::size_t>(at)] = true;
  }
  TargetNumbers far;
  for (Eigen::Index k = 0; k <= last; ++k)
    if (is_far[static_cast<std::size_t>(k)]) far.push_back(k);
  return static_cast<double>(far.size()) < most * static_cast<double>(targets.cols()) ? std::optional(far) : std::nullopt;
}

}  // namespace

Eigen::MatrixXd Targets(const SignalContext& c) {
  constexpr int kFewest = 5, kTwice = 2;
  constexpr Eigen::Index kVisits = 4;
  if (c.Moves() || c.Readings() < kVisits * kFewest) return {};
  const std::vector<int> target = TargetOf(c);
  const int count = 1 + std::ranges::max(target);
  if (count < kFewest || count > c.Readings() / kVisits) return {};
  Eigen::MatrixXd targets = model::Indicators(target);
  if (Visits(c, targets, 1).minCoeff() < kTwice || Visits(c, targets, -1).minCoeff() < kTwice) return {};
  return targets;
}

bool LeaveErrorsOfTargets(const LargeCauses& large, const Eigen::MatrixXd& targets) {
  constexpr double kClearly =
      3.0;                     // mean square of what is the same at a target, in what is not: F of 1 in 1e3 runs
  constexpr int kSeveral = 2;  // shapes without a name: one alone says more than a table
  const Searched& last = large.Last();
  const auto shapes = std::ranges::count_if(last.analysis.found.terms, [&](const Term& term) {
    return IsOfAngle(last.families[static_cast<std::size_t>(term.family)]);
  });
  const Eigen::VectorXd left = LeftOver(large), same = MeansAt(targets, left);
  const auto stops = static_cast<double>(targets.cols()), rows = static_cast<double>(targets.rows());
  constexpr double kRounding_rad = 1e-10;  // of the arithmetic, which is regular too
  const double least = std::pow(kRounding_rad, 2);
  const double between = same.squaredNorm() / stops;
  const double within = std::max(least, (left - same).squaredNorm() / (rows - stops));
  // Rounding is the same at every visit, too.
  const double rounding = rows / stops * std::pow(last.encoder.run.rounding, 2) / 12.0;
  const double all = large.first->encoder.run.residual.squaredNorm();
  const bool is_small = same.squaredNorm() < tuning::kSmallRest * all;
  // So many pieces are no causes: each of a curve that any sum of waves comes close to.
  constexpr std::size_t kPieces = 6;
  const bool in_pieces = large.causes.size() + last.analysis.found.terms.size() >= kPieces;
  // A few targets are met by chance by any order that takes as many numbers.
  constexpr double kFewer = 0.4;
  const bool is_met_by_chance = NumbersByAngle(large) > kFewer * (stops - 1.0);
  return in_pieces || is_met_by_chance || shapes >= kSeveral || (!is_small && between > kClearly * (within + rounding));
}

Eigen::MatrixXd TargetsThatStandOut(const EncoderRun& encoder, const Eigen::MatrixXd& targets) {
  constexpr Eigen::Index kWaves = 24, kFewestOfCurve = 4 * kWaves, kFewestOfOrders = 24;
  constexpr double kFarOfCurve = 8.0, kFewOfCurve = 0.05, kFarOfOrders = 4.0, kFewOfOrders = 0.4;
  const Eigen::VectorXd target_rad = AtTargets(targets, encoder.context.device_rad);
  const Eigen::VectorXd error_rad = AtTargets(targets, encoder.run.residual);
  if (targets.cols() >= kFewestOfOrders && LeastOrder(encoder.context) == 1) {
    if (const auto far = FarOff(encoder, targets, OffFewOrders(target_rad, error_rad), kFarOfOrders, kFewOfOrders)) return targets(Eigen::all, *far);
  }
  if (targets.cols() < kFewestOfCurve) return targets;
  const auto far = FarOff(encoder, targets, OffSmoothCurve(target_rad, error_rad, kWaves), kFarOfCurve, kFewOfCurve);
  return far && !far->empty() ? Eigen::MatrixXd(targets(Eigen::all, *far)) : targets;
}

void AddErrorsOfTargets(const LargeCauses& large, DiagnosisRun& result) {
  if (large.targets.size() == 0) return;
  Diagnosis& d = result.diagnosis;
  const Eigen::VectorXd sigma = result.run.sigma;
  result.run = large.first->encoder.run;
  result.run.sigma = sigma;
  result.run.nuisance = large.first->encoder.SetUpsAlone();  // the errors of the targets are told, not free
  Eigen::VectorXd left = result.run.residual, named = Eigen::VectorXd::Zero(left.size());
  for (const Accepted& accepted : result.accepted) {
    const Eigen::VectorXd shown = accepted.columns * accepted.amplitudes;
    left -= shown;
    if (accepted.family.kind == Kind::kNamed) named += shown;
  }
  const Eigen::VectorXd error = MeansAt(large.targets, left);
  const std::string words = fmt::format(
      "error of its own at each of {} targets, {:.3g} {} from the least to the largest, the same at every "
      "visit from either side, synchronous with reference angle, on angle",
      large.targets.cols(), (error.maxCoeff() - error.minCoeff()) / result.run.to_SI, result.run.unit);
  result.accepted.insert(result.accepted.begin(), CurveThrough(large.first->encoder.context, large.targets, error));
  d.unknown.signature = words + (d.unknown.signature.empty() ? "" : " | " + d.unknown.signature);
  d.unknown.probability = std::max(d.unknown.probability, tuning::kListed);
  const auto about_mean = [](const Eigen::VectorXd& rows) { return (rows.array() - rows.mean()).matrix().squaredNorm(); };
  if (d.verdict == Verdict::kNone || about_mean(error) > about_mean(named)) d.verdict = Verdict::kUnknown;
}

}  // namespace twinbench::diagnose::encoder
