#include "twin/diagnose/compared.h"

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/diagnose/engine/noise_estimate.h"
#include "twin/diagnose/mean_of_runs.h"
#include "twin/diagnose/redundancy.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose {
namespace {

/// What a reading showed: one value a channel, SI.
using ValuesOf = std::function<Eigen::VectorXd(const Reading&)>;

/// Columns that a bench must show.
std::vector<ReadingColumn> ShownColumns(const TwinComparison& comparison) {
  std::vector<ReadingColumn> columns;
  std::ranges::copy_if(comparison.format->columns, std::back_inserter(columns),
                       [](const ReadingColumn& c) { return c.role == ColumnRole::kShown; });
  return columns;
}

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

std::vector<Reading> WithValues(const std::vector<Reading>& readings, const ValuesOf& values_of) {
  std::vector<Reading> used;
  std::ranges::copy_if(readings, std::back_inserter(used), [&](const Reading& r) {
    return r.status == ReadingStatus::kOk && values_of(r).allFinite();
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
  run.schedule = model::CourseOf(used);
  run.channels = comparison.format->channels;
  run.unit = comparison.unit;
  run.to_SI = comparison.to_SI;
  run.units = comparison.units;
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

void EstimateNoise(LinearRun& run) {
  for (int c = 0; c < run.Channels(); ++c) {
    const auto of_channel = Eigen::seq(c, Eigen::last, run.Channels());
    run.sigma(of_channel).setConstant(EstimateNoise_rad(run.schedule, run.residual(of_channel)));
  }
}

/// What the readings show of the free constants. Those that may be anything are hardly held: a millionth of what
/// one reading says.
Nuisance NuisanceOf(const FreeConstants& free, const Eigen::VectorXd& sigma) {
  constexpr double kWeak = 1e-6;
  const Eigen::MatrixXd columns = free.columns * free.fitted;
  const Eigen::MatrixXd white = sigma.cwiseInverse().asDiagonal() * columns;
  const Eigen::VectorXd weak = kWeak * white.cwiseAbs2().colwise().maxCoeff().transpose().cwiseMax(1e-300);
  const Eigen::VectorXd stated = free.fitted.cwiseAbs2().transpose() * free.Precision();
  return {columns.sparseView(), (stated.array() > 0.0).select(stated, weak), 0, 0};
}

std::vector<FreePoint> FreeOf(const Compared& c, const TwinComparison& comparison) {
  std::vector<FreePoint> points;
  for (const std::string& point : comparison.free_points)
    points.push_back({c.twin.Point(point), model::Indicators(c.run.schedule.setup), "a mounting"});
  for (const TwinComparison::FreeCourses& of_bench : comparison.free_courses)
    points.push_back({c.twin.Point(of_bench.point), of_bench.courses(c.used), "the bench"});
  if (!comparison.free_sd) return points;
  for (FreePoint& free : points) free.sd = comparison.free_sd(free.point);
  return points;
}

}  // namespace

Compared Compare(const std::vector<Reading>& readings, const Scenario& scenario, const TwinComparison& comparison) {
  const std::vector<Reading> used = WithValues(readings, ShownBy(comparison));
  Compared c{used, Followed(comparison.follow, scenario, readings, used), RunOf(used, scenario, comparison), {}};
  LinearRun& run = c.run;
  if (!c.twin.Predict({}).allFinite())
    throw InputError("readings", "there are values where the scenario's bench would show none",
                     "a scenario of the bench that the readings come from");
  run.sigma = StatedNoise(used, scenario, comparison, run);
  run.sigma_stated = run.sigma.minCoeff() > 0.0;
  ScaleToMean(used, run);
  constexpr double kHold = 10.0;  // what is left must be nearly linear in whatever the constants may be besides
  const Eigen::VectorXd weights =
      run.sigma_stated ? Eigen::VectorXd(run.sigma.cwiseInverse()) : Eigen::VectorXd::Ones(run.observed.size());
  c.free = FitFree(c.twin, FreeOf(c, comparison), run.observed,
                   {weights, comparison.free_rank, comparison.free_rounds, kHold});
  run.residual = run.observed - ByRow(c.twin.Predict(c.free.Disturbances()));
  if (!run.sigma_stated) EstimateNoise(run);
  run.nuisance = NuisanceOf(c.free, run.sigma);
  run.outlier_per_noise = PerNoise(c, comparison.outliers);
  c.predicted = run.Predicted();
  if (!comparison.free_sd) return c;
  // What the constants are held by is held from nothing, not from where the fit has put them.
  run.nuisance.at = SolveLeastSquares(c.free.fitted, c.free.values);
  run.residual += run.nuisance.jacobian * run.nuisance.at;
  return c;
}

std::vector<Reading> AsPredicted(const Compared& compared, const TwinComparison& comparison) {
  std::vector<Reading> readings = compared.used;
  if (comparison.shown) return readings;  // of values that are no columns
  const std::vector<ReadingColumn> columns = ShownColumns(comparison);
  Eigen::Index row = 0;
  for (Reading& reading : readings) {
    for (const ReadingColumn& column : columns) column.number(reading) = compared.predicted[row++];
  }
  return readings;
}

double PerNoise(const Compared& c, const std::string& point) {
  if (point.empty()) return kNaN;
  const Eigen::VectorXd white = ByRow(c.twin.Slope(point, c.free.Disturbances())).cwiseQuotient(c.run.sigma);
  const auto by_channel = white.reshaped(c.run.Channels(), c.run.schedule.Readings());
  return std::sqrt(static_cast<double>(by_channel.cols())) / by_channel.rowwise().norm().maxCoeff();
}

}  // namespace twinbench::diagnose
