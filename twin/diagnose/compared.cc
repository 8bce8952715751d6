#include "twin/diagnose/compared.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/diagnose/as_predicted.h"
#include "twin/diagnose/engine/noise_estimate.h"
#include "twin/diagnose/left_free.h"
#include "twin/diagnose/mean_of_runs.h"
#include "twin/diagnose/redundancy.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose {
namespace {

/// What a reading showed: one value a channel, SI.
using ValuesOf = std::function<Eigen::VectorXd(const Reading&)>;

ValuesOf ShownBy(const TwinComparison& comparison) {
  if (comparison.shown) return comparison.shown;
  const std::vector<ReadingColumn> columns = ShownColumns(comparison);
  Require(columns.size() == comparison.format->channels.size(),
          "a bench that is compared by its columns shows one a channel");
  return [columns](Reading reading) {
    Eigen::VectorXd values(std::ssize(columns));
    for (std::size_t c = 0; c < columns.size(); ++c)
      values[static_cast<Eigen::Index>(c)] = columns[c].number(reading);
    return values;
  };
}

std::vector<Reading> WithValues(const std::vector<Reading>& readings, const TwinComparison& comparison) {
  const ValuesOf values_of = ShownBy(comparison);
  std::vector<Reading> used;
  std::ranges::copy_if(readings, std::back_inserter(used), [&](const Reading& r) {
    if (r.status != ReadingStatus::kOk) return false;
    return comparison.is_used ? comparison.is_used(r) : values_of(r).allFinite();
  });
  RefuseTooFew(used.size(), readings.size());
  return used;
}

/// By rows: reading i, channel c at i * channels + c.
Eigen::VectorXd RowsOf(const std::vector<Reading>& used, const ValuesOf& values_of, Eigen::Index channels) {
  Eigen::MatrixXd by_reading(std::ssize(used), channels);
  for (std::size_t i = 0; i < used.size(); ++i) by_reading.row(static_cast<Eigen::Index>(i)) = values_of(used[i]);
  return ByRow(by_reading);
}

LinearRun RunOf(const std::vector<Reading>& used, const Scenario& scenario, const TwinComparison& comparison) {
  LinearRun run;
  run.bench = scenario.bench;
  run.schedule = model::CourseOf(comparison.at_their_times ? comparison.at_their_times(used) : used);
  if (comparison.sampled) run.schedule.target_rad = OfReadings(used, comparison.angles.front().rad);
  run.channels = comparison.channels.empty() ? comparison.format->channels : comparison.channels;
  run.unit = comparison.unit;
  run.to_SI = comparison.to_SI;
  run.units = comparison.units;
  run.rounding = comparison.rounding;
  run.noise_free = scenario.noise_free;
  for (int k = 0; k < run.Channels(); ++k)
    run.patterns.push_back({run.channels[static_cast<std::size_t>(k)], Eigen::VectorXd::Unit(run.Channels(), k)});
  run.observed = RowsOf(used, ShownBy(comparison), run.Channels());
  return run;
}

/// Of every row; 0 where nobody states any.
Eigen::VectorXd StatedNoise(const std::vector<Reading>& used, const Scenario& scenario,
                            const TwinComparison& comparison, const LinearRun& run) {
  if (!comparison.noise_of) return Eigen::VectorXd::Constant(run.observed.size(), comparison.noise);
  return RowsOf(
      used, [&](const Reading& r) { return comparison.noise_of(scenario, r); }, run.Channels());
}

/// Every turn of a pass as a pass of its own over the same places: what repeats with the angle is then no noise.
Schedule ByTurns(Schedule s, const Eigen::VectorXd& angle_rad) {
  constexpr int kMostTurns = 10000;
  for (Eigen::Index i = 0; i < angle_rad.size(); ++i) {
    const double turn = std::floor(angle_rad[i] / units::turn + 1e-9);
    int& pass = s.pass[static_cast<std::size_t>(i)];
    pass = pass * kMostTurns + static_cast<int>(turn);
    s.reference_rad[i] = angle_rad[i] - turn * units::turn;
  }
  return s;
}

/// Of samples that come again in every turn: a quarter of the way between two of them, and no more than a stop's width.
double SameAngle_rad(const Schedule& s, const Eigen::VectorXd& angle_rad) {
  constexpr double kWidest_rad = 1e-5 * units::turn, kOfStep = 0.25;
  const double step_rad = model::TypicalStep_rad(s, angle_rad);
  return step_rad > 0.0 ? std::min(kWidest_rad, kOfStep * step_rad) : kWidest_rad;
}

/// Of the channels whose noise nobody states.
void EstimateNoise(const TwinComparison& comparison, LinearRun& run) {
  const double same_rad = comparison.sampled ? SameAngle_rad(run.schedule, run.schedule.target_rad) : units::urad;
  const Schedule schedule = comparison.sampled ? ByTurns(run.schedule, run.schedule.target_rad) : run.schedule;
  for (int c = 0; c < run.Channels(); ++c) {
    const auto of_channel = Eigen::seq(c, Eigen::last, run.Channels());
    if (run.sigma(of_channel).minCoeff() > 0.0) continue;
    run.sigma(of_channel).setConstant(EstimateNoise_rad(schedule, run.residual(of_channel), {}, same_rad));
  }
}

/// Whether more than one channel shows it: then their rows are not independent.
bool IsShared(const Eigen::MatrixXd& shown) {
  constexpr double kLeast = 0.01;  // of the squares, beside the channel that shows it most
  const double all = shown.squaredNorm();
  return all - shown.cwiseAbs2().rowwise().maxCoeff().sum() > kLeast * all;
}

/// What is drawn anew at each reading, beside the noise of the channels.
void AddScatter(const Compared& c, const Scenario& scenario, const TwinComparison& comparison, LinearRun& run) {
  if (!comparison.scatter) return;
  Eigen::VectorXd variance = run.sigma.cwiseAbs2();
  for (const auto& [point, sd, is_at] : comparison.scatter(scenario)) {
    if (!(sd > 0.0)) continue;
    Eigen::MatrixXd shown = sd * c.twin.Slope(point, {});
    for (Eigen::Index i = 0; is_at && i < shown.rows(); ++i)
      if (!is_at(c.used[static_cast<std::size_t>(i)])) shown.row(i).setZero();
    const Eigen::VectorXd rows = ByRow(shown);
    variance += rows.cwiseAbs2();
    if (!IsShared(shown)) continue;
    run.draws.conservativeResize(rows.size(), run.draws.cols() + 1);
    run.draws.rightCols(1) = rows;
  }
  run.sigma = variance.cwiseSqrt();
}

constexpr double kNoWeight = 1e5;  // times the noise: of a channel that a reading has not

/// What the twin shows depends on the noise of what was read, by much less than that noise: each round leaves of it
/// no more than what is shown changes with what was read.
void PredictWithoutNoise(const std::vector<Reading>& readings, const Scenario& scenario,
                         const TwinComparison& comparison, Compared& c) {
  constexpr int kRounds = 3;  // a third each for signals that err by a third of a radian
  for (int round = 0; comparison.show && round < kRounds; ++round) {
    const Followed steady(comparison.follow, scenario, RecordAsPredicted(c, readings, comparison), c.used,
                          c.run.Channels());
    c.predicted = ByRow(steady.Predict(c.free.Disturbances()));
  }
}

/// Reading by reading.
Compared CompareReadings(const std::vector<Reading>& readings, const std::vector<Reading>& used,
                         const Scenario& scenario, const TwinComparison& comparison) {
  LinearRun of_used = RunOf(used, scenario, comparison);
  Compared c{used, Followed(comparison.follow, scenario, readings, used, of_used.Channels()), of_used, {}};
  LinearRun& run = c.run;
  const Eigen::ArrayXd read = run.observed.array().isFinite().cast<double>();
  run.observed = (read > 0.0).select(run.observed, 0.0);
  if (!c.twin.Predict({}).allFinite())
    throw InputError("readings", "there are values where the scenario's bench would show none",
                     "a scenario of the bench that the readings come from");
  run.sigma = StatedNoise(used, scenario, comparison, run);
  AddScatter(c, scenario, comparison, run);
  run.sigma_stated = run.sigma.minCoeff() > 0.0;
  ScaleToMean(used, run);
  constexpr double kHold = 10.0;  // what is left must be nearly linear in whatever the constants may be besides
  Eigen::VectorXd weights = read;
  if (run.sigma_stated) weights.array() /= run.sigma.array();
  c.free = FitFree(c.twin, FreeOf(c, comparison), run.observed,
                   {weights, comparison.free_rank, comparison.free_rounds, kHold});
  c.predicted = ByRow(c.twin.Predict(c.free.Disturbances()));
  run.residual = read.matrix().cwiseProduct(run.observed - c.predicted);
  EstimateNoise(comparison, run);
  run.sigma = (read > 0.0).select(run.sigma, kNoWeight * run.sigma);
  PredictWithoutNoise(readings, scenario, comparison, c);
  c.readings = run.schedule;
  c.groups = GroupsOf(run.schedule, 1);
  run.outlier_per_noise = PerNoise(c, comparison.outliers);
  return c;
}

/// Once more without single values that lie far outside.
Compared WithoutOutliers(Compared all, const std::vector<Reading>& readings, const Scenario& scenario,
                         const TwinComparison& comparison) {
  const LinearRun& run = all.run;
  SingleOutliers outliers = FindSingleOutliers(run.schedule, run.channels.front(),
                                               run.residual(Eigen::seq(0, Eigen::last, run.Channels())));
  if (outliers.readings.empty()) return all;
  std::vector<Reading> used = all.used;
  std::erase_if(used, [&](const Reading& r) { return std::ranges::count(outliers.readings, r.reading) > 0; });
  Compared rest = CompareReadings(readings, used, scenario, comparison);
  rest.outliers = std::move(outliers);
  return rest;
}

/// Rows are means of neighbours from here on.
void TakeTogether(const TwinComparison& comparison, Compared& c) {
  const TwinComparison::Sampled& sampled = *comparison.sampled;
  c.groups = LargestGroups(c.readings, sampled.line_rad(c.used), sampled.folded_rad(AsPredicted(c, comparison)));
  LinearRun& run = c.run;
  const Eigen::Index channels = run.Channels();
  Eigen::VectorXd sigma = c.groups.MeanOfRows(run.sigma.cwiseAbs2()).cwiseSqrt();
  for (Eigen::Index row = 0; row < sigma.size(); ++row) sigma[row] /= std::sqrt(c.groups.Size(row / channels));
  run.schedule = Grouped(c.readings, c.groups);
  run.observed = c.groups.MeanOfRows(run.observed);
  run.residual = c.groups.MeanOfRows(run.residual);
  run.sigma = sigma;
  c.free.columns = c.groups.MeanOfRows(c.free.columns);
}

/// The ways in which a body's motions show, instead of the channels.
void SetPatterns(const TwinComparison& comparison, Compared& c) {
  if (!comparison.motions.empty()) c.run.patterns.clear();
  for (const auto& [name, point] : comparison.motions)
    c.run.patterns.push_back({name, ResponseTo(c, point).pattern});
}

}  // namespace

Compared Compare(const std::vector<Reading>& readings, const Scenario& scenario, const TwinComparison& comparison) {
  Compared c = CompareReadings(readings, WithValues(readings, comparison), scenario, comparison);
  if (comparison.sampled) {
    c = WithoutOutliers(std::move(c), readings, scenario, comparison);
    TakeTogether(comparison, c);
  }
  LinearRun& run = c.run;
  if (comparison.shows_errors) run.observed = run.residual;
  run.nuisance = c.free.AsNuisance(run.sigma.cwiseInverse());
  SetPatterns(comparison, c);
  if (!comparison.free_sd) return c;
  // What the constants are held by is held from nothing, not from where the fit has put them.
  run.nuisance.at = c.free.FittedValues();
  run.residual += run.nuisance.jacobian * run.nuisance.at;
  if (!comparison.known.empty()) AddKnown(readings, scenario, comparison, c);
  if (comparison.free_places) run.left_by_another = LeftByAnotherOf(c, readings, comparison);
  return c;
}

ToRows Compared::Means() const {
  if (!groups.Averages()) return {};
  return [groups = groups](const Eigen::MatrixXd& of_readings) { return groups.Mean(of_readings); };
}

Response ResponseTo(const Compared& compared, const std::string& point) {
  const Eigen::MatrixXd slopes = compared.twin.Slope(point, compared.free.Disturbances());
  const Eigen::VectorXd sizes = slopes.rowwise().norm();
  const Eigen::VectorXd answers = (sizes.array() > 0.5 * sizes.maxCoeff()).cast<double>();
  const Eigen::VectorXd pattern = slopes.transpose() * answers / std::max(1.0, answers.sum());
  return {pattern, slopes * pattern / std::max(pattern.squaredNorm(), 1e-300)};
}

Eigen::VectorXd OfReadings(const std::vector<Reading>& readings,
                           const std::function<double(const Reading&)>& value) {
  Eigen::VectorXd values(std::ssize(readings));
  for (std::size_t i = 0; i < readings.size(); ++i) values[static_cast<Eigen::Index>(i)] = value(readings[i]);
  return values;
}

double PerNoise(const Compared& c, const std::string& point) {
  if (point.empty()) return kNaN;
  const Eigen::VectorXd white = c.Rows(c.twin.Slope(point, c.free.Disturbances())).cwiseQuotient(c.run.sigma);
  const auto by_channel = white.reshaped(c.run.Channels(), c.run.schedule.Readings());
  return std::sqrt(static_cast<double>(by_channel.cols())) / by_channel.rowwise().norm().maxCoeff();
}

}  // namespace twinbench::diagnose
