#include "twin/benches/encoder_comparison/diagnosis/wander.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <span>
#include <utility>
#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/loop_in_walk.h"
#include "twin/benches/encoder_comparison/diagnosis/means.h"
#include "twin/benches/encoder_comparison/diagnosis/memory.h"
#include "twin/core/distributions.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/diagnose/cause_groups.h"
#include "twin/diagnose/engine/base.h"
#include "twin/diagnose/folds.h"
#include "twin/diagnose/gain.h"
#include "twin/diagnose/tuning.h"
#include "twin/model/local_level.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose::encoder {
namespace {

/// Readings from which a memory as long as a part of them can be seen.
constexpr Eigen::Index kFewest = 128;
constexpr const char *kWords = "random walk, function of time", *kOfTime = "function of time";

/// Changes of some rows over a lag; a walk goes on from pass to pass, and not over a new mounting.
std::vector<double> Changes(const Eigen::VectorXd& rows, const std::vector<int>& setup, Eigen::Index lag,
                            Eigen::Index step) {
  std::vector<double> changes;
  for (Eigen::Index i = lag; i < rows.size(); i += step) {
    if (setup[static_cast<std::size_t>(i)] == setup[static_cast<std::size_t>(i - lag)])
      changes.push_back(rows[i] - rows[i - lag]);
  }
  return changes;
}

double MeanSquare(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

/// What no accepted cause explains.
struct Walk {
  Eigen::VectorXd left;
  const std::vector<int>& setup;  // by reading
  Eigen::Index lag = 0;           // readings that its steps are told over: the run shows them many times

  double Change(Eigen::Index over) const { return MeanSquare(Changes(left, setup, over, 1)); }
};

/// Then a walk is in none of what is left.
bool IsFollowed(const Accepted& accepted) {
  return FollowsWalk(accepted.family, accepted.columns);
}

Walk WalkOf(const DiagnosisRun& result, const SecondOrder& bent) {
  constexpr Eigen::Index kTimes = 16;
  Walk walk{result.run.residual, result.run.schedule.setup, result.run.Rows() / kTimes};
  for (const Accepted& accepted : result.accepted) {
    if (!IsFollowed(accepted)) walk.left -= accepted.columns * accepted.amplitudes;
  }
  walk.left = bent.Beside(walk.left);
  return walk;
}

/// By the test of Dickey and Fuller (1979, with a constant) at 5 %: the further it is from its mean, the more it goes back
/// there, as what only remembers some readings does and a walk does not.
bool ComesBack(const Walk& walk) {
  constexpr Eigen::Index kMeans = 64;
  constexpr double kMost = -2.86;  // t of a walk is above it in 95 of 100
  const Means means = MeansOf(walk.left, walk.setup, walk.left.size() / kMeans);
  const std::vector<double> steps = means.Steps();
  std::vector<double> from;
  for (std::size_t k = 1; k < means.value.size(); ++k) {
    if (means.IsNext(k)) from.push_back(means.value[k - 1]);
  }
  if (from.size() < 3) return false;
  const auto count = static_cast<Eigen::Index>(from.size());
  Eigen::ArrayXd x = Eigen::Map<Eigen::ArrayXd>(from.data(), count),
                 d = Eigen::Map<const Eigen::ArrayXd>(steps.data(), count);
  x -= x.mean();
  d -= d.mean();
  const double slope = (x * d).sum() / x.square().sum();
  const double variance = (d - slope * x).square().sum() / static_cast<double>(count - 2);
  return slope < kMost * std::sqrt(variance / x.square().sum());
}

/// What it is it has walked to, and it goes on: readings that remember some others alone do not.
/// @param noise  Of a reading, SI.
bool IsWalk(const Walk& walk, double noise) {
  constexpr double kFurther = 2.5;  // over eight times the lag: 8 of a walk, 1.5 where readings are correlated by 0.9
  constexpr double kMost = 4.0;     // from one reading to the next
  const double to_next = std::max(walk.Change(1), 2.0 * noise * noise);
  const bool goes_on = walk.Change(2 * walk.lag) > kFurther * walk.Change(walk.lag / 4);
  return goes_on && walk.Change(walk.lag) > kMost * to_next && !ComesBack(walk);
}

/// Whether one of so many whole multiples of a frequency has far more power than those beside it, which noise
/// spreads as an exponential distribution does.
/// @param phase_rad  Of the lowest one, by value.
bool HasLine(const std::vector<double>& values, const Eigen::ArrayXd& phase_rad, Eigen::Index count) {
  constexpr double kFar = 30.0;  // medians, as a few dozen beside it tell them
  constexpr Eigen::Index kBeside = 20;
  const Eigen::ArrayXcd turn = (std::complex<double>(0.0, 1.0) * phase_rad).exp();
  Eigen::ArrayXcd wave = Eigen::Map<const Eigen::ArrayXd>(values.data(), std::ssize(values)) * turn;
  std::vector<double> power;
  for (Eigen::Index k = 0; k < count; ++k, wave *= turn) power.push_back(std::norm(wave.sum()));
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto first = std::clamp<Eigen::Index>(k - kBeside, 0, std::max<Eigen::Index>(0, count - 2 * kBeside));
    const auto beside = power.begin() + first;
    if (power[static_cast<std::size_t>(k)] > kFar * Median({beside, beside + std::min(2 * kBeside, count - first)}))
      return true;
  }
  return false;
}

/// Of steps: one that is far larger than a normal distribution has them, or more of one sign.
bool HaveStepOrDrift(const std::vector<double>& steps) {
  constexpr double kFourth = 4.5, kFar = 4.5;  // 3 of a normal distribution; standard uncertainties of the mean
  const Eigen::Map<const Eigen::ArrayXd> d(steps.data(), std::ssize(steps));
  const auto count = static_cast<double>(d.size());
  return d.pow(4).mean() > kFourth * std::pow(d.square().mean(), 2) ||
         std::abs(d.mean()) > kFar * std::sqrt(d.square().mean() / count);
}

/// Steps from reading to reading, but for those over a gap, beside their times in shares of the run.
bool HasLine(const LinearRun& run) {
  constexpr double kGap = 3.0, kMost = 10000.0;
  const Eigen::VectorXd& time_s = run.schedule.time_s;
  std::vector<double> apart_s, steps, at;
  for (Eigen::Index i = 1; i < run.Rows(); ++i) apart_s.push_back(time_s[i] - time_s[i - 1]);
  const double usual_s = Median(apart_s), all_s = time_s[run.Rows() - 1] - time_s[0];
  for (Eigen::Index i = 1; i < run.Rows(); ++i) {
    if (apart_s[static_cast<std::size_t>(i - 1)] > kGap * usual_s) continue;
    steps.push_back(run.residual[i] - run.residual[i - 1]);
    at.push_back(units::turn * (time_s[i] - time_s[0]) / all_s);
  }
  const double count = std::min(kMost, 0.5 * all_s / usual_s);
  return HasLine(steps, Eigen::Map<const Eigen::ArrayXd>(at.data(), std::ssize(at)),
                 static_cast<Eigen::Index>(count));
}

/// How likely a walk of this kind would not show as much by chance. A wave comes back to where it was after some lags,
/// and not after all.
double ChanceBeside(const Walk& walk, const Eigen::VectorXd& shown) {
  double deviations2 = 0.0;
  for (const Eigen::Index lag : {Eigen::Index{1}, walk.lag / 4, walk.lag / 2, walk.lag}) {
    const std::vector<double> changes = Changes(shown, walk.setup, lag, lag);
    deviations2 = std::max(deviations2, MeanSquare(changes) * static_cast<double>(changes.size()) / walk.Change(lag));
  }
  return 1.0 / (1.0 + std::exp(-0.5 * (deviations2 - tuning::kHeadline * tuning::kHeadline)));
}

double SquaresAboutMean(const Eigen::VectorXd& rows) {
  return (rows.array() - rows.mean()).matrix().squaredNorm();
}

/// Whose size the search has fitted: not those of the twin.
bool IsLinear(const Accepted& accepted) {
  return accepted.family.kind == Kind::kNamed && accepted.family.parameters &&
         accepted.columns.cols() == accepted.amplitudes.size();
}

void TakeSizes(const Accepted& accepted, const Eigen::MatrixXd& cov, const Eigen::VectorXd& before,
               std::vector<Cause>& causes) {
  const std::vector<ParameterEstimate> was = accepted.family.parameters(accepted.shape, before, cov);
  const auto cause = std::ranges::find_if(causes, [&](const Cause& c) {
    return c.effect == accepted.family.effect && c.where == accepted.family.where &&
           c.parameters.size() >= was.size() &&
           std::ranges::equal(was, std::span(c.parameters).first(was.size()), {}, &ParameterEstimate::value,
                              &ParameterEstimate::value);
  });
  if (cause != causes.end())
    cause->parameters = accepted.family.parameters(accepted.shape, accepted.amplitudes, cov);
}

/// Without the parts that say so.
void DropParts(const std::string& words, std::string& signature) {
  std::string kept;
  for (std::size_t at = 0; at < signature.size();) {
    const std::size_t end = std::min(signature.find(" | ", at), signature.size());
    const std::string part = signature.substr(at, end - at);
    if (part.find(words) == std::string::npos) kept += (kept.empty() ? "" : " | ") + part;
    at = end + 3;
  }
  signature = kept;
}

/// What was fitted beside a shape in time that follows nearly anything has to be as large without it: else the two cancel.
void DropCancelled(const Eigen::MatrixXd& free, DiagnosisRun& result) {
  constexpr double kSame = 0.5;
  Eigen::MatrixXd all = free;
  for (const Accepted& accepted : result.accepted) all = HStack(all, Eigen::MatrixXd(accepted.columns * accepted.amplitudes));
  const Eigen::VectorXd strength = SolveShortest(all, result.run.residual).tail(std::ssize(result.accepted));
  std::vector<Accepted> kept;
  for (std::size_t k = 0; k < result.accepted.size(); ++k) {
    const Accepted& accepted = result.accepted[k];
    if (std::abs(strength[static_cast<Eigen::Index>(k)] - 1.0) < kSame) {
      kept.push_back(accepted);
      continue;
    }
    const Family& family = accepted.family;
    std::erase_if(result.diagnosis.causes, [&](const Cause& c) { return c.effect == family.effect && c.where == family.where; });
    if (family.describe) DropParts(family.describe(accepted.grid_point, accepted.amplitudes, accepted.shape), result.diagnosis.unknown.signature);
  }
  result.accepted = std::move(kept);
}

/// Beside a walk, noise that remembers some readings tells the size of a slow wave badly: from differences of
/// neighbours, in which it hardly shows. Least squares of the readings as they are tell it as well as the walk lets
/// them. A shape in time without a name is a piece of the walk.
void FitBesideWalk(DiagnosisRun& result) {
  const LinearRun& run = result.run;
  std::erase_if(result.accepted, [](const Accepted& accepted) {
    return accepted.family.kind == Kind::kUnknown && accepted.family.goes_by_time;
  });
  const Eigen::MatrixXd free = run.nuisance.jacobian.toDense();
  if (!result.accepted.empty()) DropCancelled(free, result);
  Eigen::MatrixXd all = free;
  Eigen::VectorXd rows = run.residual;
  for (const Accepted& accepted : result.accepted) {
    if (IsLinear(accepted))
      all = HStack(all, accepted.columns);
    else
      rows -= accepted.columns * accepted.amplitudes;
  }
  if (all.cols() == free.cols()) return;
  const Eigen::VectorXd sizes = SolveShortest(all, rows), left = rows - all * sizes;
  const Eigen::MatrixXd inverse =
      GeneralInverseOf(all.transpose() * all) * left.squaredNorm() / static_cast<double>(run.Rows());
  Eigen::Index at = free.cols();
  for (Accepted& accepted : result.accepted) {
    if (!IsLinear(accepted)) continue;
    const Eigen::Index count = accepted.amplitudes.size();
    const Eigen::VectorXd before = std::exchange(accepted.amplitudes, sizes.segment(at, count));
    const double memory = std::max(1.0, MemoryAlong(accepted.columns * accepted.amplitudes, left));
    TakeSizes(accepted, memory * inverse.block(at, at, count, count), before, result.diagnosis.causes);
    at += count;
  }
}

/// Those that are as sure as what is accepted: it, and what ties with it. Of several of one name the first that is not
/// in `done`, which it joins.
CauseGroup GroupOf(const Accepted& accepted, const std::vector<Cause>& causes, std::vector<bool>& done) {
  for (const CauseGroup& group : GroupsOf(causes)) {
    const auto is_it = [&](std::size_t k) {
      return !done[k] && causes[k].effect == accepted.family.effect && causes[k].where == accepted.family.where;
    };
    if (std::ranges::none_of(group, is_it)) continue;
    for (const std::size_t k : group) done[k] = true;
    return group;
  }
  return {};
}

/// What is no more than a piece of it loses its name.
/// @return the power of what keeps one.
double GiveToWander(DiagnosisRun& result, const Walk& walk, Eigen::VectorXd& wander) {
  std::vector<Cause>& causes = result.diagnosis.causes;
  const std::vector<Cause> before = causes;
  std::vector<bool> done(causes.size());
  double named = 0.0;
  for (const Accepted& accepted : result.accepted) {
    if (accepted.family.kind != Kind::kNamed) continue;
    const Eigen::VectorXd shown = accepted.columns * accepted.amplitudes;
    const bool is_seen = IsLoop(accepted.family.effect) && IsSeenInWalk(walk.left, shown, walk.setup);
    const double chance = is_seen ? 1.0 : ChanceBeside(walk, shown);
    for (const std::size_t k : GroupOf(accepted, before, done)) causes[k].probability *= chance;
    wander += (1.0 - chance) * shown;
    named += chance * SquaresAboutMean(shown);
  }
  return named;
}

/// Of these readings alone, by time: what the file shows of it. A column for each part that is held out: what was
/// not seen of a walk is not predicted.
Accepted CourseOf(const Walk& walk, const LinearRun& run) {
  Accepted course;
  course.family.kind = Kind::kUnknown;
  course.family.effect = "walk";
  course.family.where = run.channels.front();
  course.family.goes_by_time = true;
  const double noise = std::max(run.sigma.mean(), std::sqrt(0.5 * walk.Change(1)));
  const Eigen::VectorXd smoothed = model::Smoothed(run.schedule.time_s, walk.left, noise);
  course.columns = model::Times(model::Indicators(MakeFolds(run.schedule).of_reading), smoothed);
  const Eigen::MatrixXd all = HStack(run.nuisance.jacobian.toDense(), course.columns);
  course.amplitudes = SolveShortest(all, walk.left).tail(course.columns.cols());
  course.family.amplitudes.assign(static_cast<std::size_t>(course.columns.cols()), {"strength", "1", 1.0, 1.0});
  return course;
}

void AddWords(const Eigen::VectorXd& walk, const LinearRun& run, std::string& signature) {
  const double amplitude = std::sqrt(2.0 * SquaresAboutMean(walk) / static_cast<double>(run.Rows()));
  signature += fmt::format("{}{}, on angle, amplitude {:.2g} {}", signature.empty() ? "" : " | ", kWords,
                           amplitude / run.to_SI, run.unit);
}

/// With the names that are left beside it, and what the others show in it.
void TellWalk(Walk& walk, DiagnosisRun& result) {
  Diagnosis& d = result.diagnosis;
  Eigen::VectorXd& wander = walk.left;
  const double named = GiveToWander(result, Walk(walk), wander);
  AddWords(wander, result.run, d.unknown.signature);
  d.unknown.probability = std::max(d.unknown.probability, tuning::kListed);
  if (d.verdict == Verdict::kNone || SquaresAboutMean(wander) > named) d.verdict = Verdict::kUnknown;
}

/// What a turn has few periods of is nearly all of it. Of a walk over one turn that closes such orders take half of what it changes
/// by over a sixteenth (series of a Brownian bridge), of any other less.
bool IsOfLowOrders(const Walk& walk, const LinearRun& run) {
  constexpr double kNearlyAll = 0.85;
  constexpr int kLow = 4;
  Eigen::MatrixXd columns = run.nuisance.jacobian.toDense();
  for (int order = 1; order <= kLow; ++order) columns = HStack(columns, model::Wave(order * run.schedule.reference_rad));
  Walk rest = walk;
  rest.left -= columns * SolveShortest(columns, walk.left);
  return rest.Change(walk.lag) < (1.0 - kNearlyAll) * walk.Change(walk.lag);
}

}  // namespace

bool IsNothingButWalk(const LinearRun& run) {
  constexpr Eigen::Index kFewestMeans = 64;
  const Walk walk{run.residual, run.schedule.setup, run.Rows() / 16};
  if (run.Channels() != 1 || run.Rows() < kInMean * kFewestMeans || !IsWalk(walk, run.sigma.minCoeff()))
    return false;
  const std::vector<double> steps = MeansOf(walk.left, walk.setup, kInMean).Steps();
  const Eigen::Index count = std::ssize(steps);
  if (count < kFewestMeans / 2) return false;  // of several heads no readings in a row are of one
  const Eigen::ArrayXd phase_rad = units::turn / static_cast<double>(count) *
                                   Eigen::ArrayXd::LinSpaced(count, 0.0, static_cast<double>(count - 1));
  return !HaveStepOrDrift(steps) && !HasLine(steps, phase_rad, count / 2) && !HasLine(run) && !IsOfLowOrders(walk, run);
}

bool FollowsWalk(const Family& family, const Eigen::MatrixXd& columns) {
  return family.takes_any_course && columns.cols() > tuning::kWanderTogether;
}

void TellWander(const SecondOrder& bent, DiagnosisRun& result) {
  const LinearRun& run = result.run;
  if (run.Channels() != 1 || run.Rows() < kFewest) return;
  const bool is_walk = IsWalk(WalkOf(result, bent), run.sigma.minCoeff());
  const bool is_followed = std::ranges::any_of(result.accepted, IsFollowed);
  if (!is_walk && !is_followed) return;
  std::string& signature = result.diagnosis.unknown.signature;
  if (is_followed) DropParts(is_walk ? kOfTime : kWords, signature);  // it is told here
  if (is_walk) FitBesideWalk(result);
  Walk walk = WalkOf(result, bent);
  if (is_walk) TellWalk(walk, result);
  std::erase_if(result.accepted, IsFollowed);
  result.accepted.push_back(CourseOf(walk, run));
  if (!is_walk) AddWords(ShownByFit(run, {result.accepted.back()}), run, signature);
}

}  // namespace twinbench::diagnose::encoder
