#include "twin/diagnose/by_twin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/engine/asked_effects.h"
#include "twin/diagnose/engine/followed.h"
#include "twin/diagnose/engine/noise_estimate.h"
#include "twin/diagnose/unknown/design.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose {
namespace {

constexpr int kFewestCompared = 12;

std::vector<ReadingColumn> ColumnsShown(const BenchFormat& format) {
  std::vector<ReadingColumn> shown;
  std::ranges::copy_if(format.columns, std::back_inserter(shown),
                       [](const ReadingColumn& c) { return c.role == ColumnRole::kShown; });
  Require(shown.size() == format.channels.size(), "a bench that is compared by its columns shows one a channel");
  return shown;
}

/// One value a channel, SI.
Eigen::VectorXd ValuesOf(Reading reading, const std::vector<ReadingColumn>& columns) {
  Eigen::VectorXd values(std::ssize(columns));
  for (std::size_t c = 0; c < columns.size(); ++c)
    values[static_cast<Eigen::Index>(c)] = columns[c].number(reading);
  return values;
}

std::vector<Reading> WithValues(const std::vector<Reading>& readings, const std::vector<ReadingColumn>& columns) {
  std::vector<Reading> used;
  std::ranges::copy_if(readings, std::back_inserter(used), [&](const Reading& r) {
    return r.status == ReadingStatus::kOk && ValuesOf(r, columns).allFinite();
  });
  if (std::ssize(used) < kFewestCompared)
    throw InputError("readings", fmt::format("{} of {} have a value", used.size(), readings.size()),
                     fmt::format("at least {}", kFewestCompared));
  return used;
}

/// By rows: reading i, channel c at i * channels + c.
Eigen::VectorXd AsRows(const Eigen::MatrixXd& by_reading) {
  return by_reading.transpose().reshaped();
}

/// A point, and the courses of the constants that are free there: readings x constants.
struct FreePoint {
  std::string point;
  Eigen::MatrixXd courses;
  std::string of;  // in words: "a set-up"
};

/// The constants that a run leaves free.
struct FreeConstants {
  std::vector<FreePoint> points;
  Eigen::MatrixXd columns;  // rows x constants, those of a point side by side
  Eigen::MatrixXd fitted;   // constants x directions of them that the readings show
  Eigen::VectorXd values;   // SI

  /// The part of `constants` that is of each point.
  template <class Use>
  void ForEach(const Eigen::VectorXd& constants, Use use) const {
    Eigen::Index from = 0;
    for (const FreePoint& p : points) {
      use(p, constants.segment(from, p.courses.cols()));
      from += p.courses.cols();
    }
  }

  /// As the twin is told them.
  std::vector<model::Disturbance> Disturbances() const {
    std::vector<model::Disturbance> all;
    ForEach(values, [&](const FreePoint& p, const auto& x) { all.push_back({p.point, p.courses * x}); });
    return all;
  }
};

FreeConstants FreeOf(const TwinComparison& comparison, const std::vector<Reading>& used, const Schedule& schedule) {
  FreeConstants free;
  for (const std::string& point : comparison.free_points)
    free.points.push_back({point, model::Indicators(schedule.setup), "a set-up"});
  for (const TwinComparison::FreeCourses& of_bench : comparison.free_courses)
    free.points.push_back({of_bench.point, of_bench.courses(used), "the bench"});
  Eigen::Index constants = 0;
  for (const FreePoint& p : free.points) constants += p.courses.cols();
  free.values.setZero(constants);
  return free;
}

/// What the rows show of each constant, about the values that they have now.
void SetColumns(const Followed& twin, Eigen::Index rows, FreeConstants& free) {
  free.columns.resize(rows, free.values.size());
  Eigen::Index column = 0;
  for (const FreePoint& p : free.points) {
    const Eigen::MatrixXd slope = twin.Slope(p.point, free.Disturbances());
    for (const auto& course : p.courses.colwise()) free.columns.col(column++) = AsRows(course.asDiagonal() * slope);
  }
}

/// What each row counts in the fit of the free constants: all the same, unless channels read different things.
Eigen::VectorXd WeightsOf(const TwinComparison& comparison, Eigen::Index rows) {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(rows);
  const auto channels = std::ssize(comparison.noise_of_channel);
  for (Eigen::Index c = 0; c < channels; ++c)
    weights(Eigen::seq(c, Eigen::last, channels))
        .setConstant(1.0 / comparison.noise_of_channel[static_cast<std::size_t>(c)]);
  return weights;
}

/// The constants anew from what the residual still says of them. Columns are made alike first, so that what is not
/// fitted depends on no unit; of what is not, all that the constants have is kept least, not what this round adds.
void Refit(const Eigen::VectorXd& residual, const TwinComparison& comparison, FreeConstants& free) {
  const Eigen::VectorXd weights = WeightsOf(comparison, residual.size());
  Eigen::MatrixXd white = weights.asDiagonal() * free.columns;
  const Eigen::VectorXd seen = weights.cwiseProduct(residual) + white * free.values;
  const Eigen::VectorXd norms = white.colwise().norm();
  const Eigen::VectorXd scale =
      (norms.array() > comparison.free_rank * norms.maxCoeff()).select(norms.cwiseInverse(), 0.0);
  white *= scale.asDiagonal();
  free.values = scale.cwiseProduct(SolveRanked(white, seen, comparison.free_rank).x.col(0));
}

/// The directions of the constants that are fitted: each by itself where the readings show them all.
void SetFitted(const TwinComparison& comparison, FreeConstants& free) {
  constexpr double kLeastRank = 1e-7;  // squares of less are rounding
  const Eigen::MatrixXd white = WeightsOf(comparison, free.columns.rows()).asDiagonal() * free.columns;
  const Eigen::VectorXd norms = white.colwise().norm();
  const double rank = std::max(comparison.free_rank, kLeastRank);
  const Eigen::VectorXd scale = (norms.array() > rank * norms.maxCoeff()).select(norms.cwiseInverse(), 0.0);
  const Eigen::MatrixXd unit = white * scale.asDiagonal();
  const SymmetricEigen eigen = EigenOfSymmetric(unit.transpose() * unit);
  const Eigen::Index all = scale.size();
  const Eigen::Index shown = (eigen.values.array() > rank * rank * eigen.values[all - 1]).count();
  free.fitted = Eigen::MatrixXd::Identity(all, all);
  if (shown < all) free.fitted = scale.asDiagonal() * eigen.vectors.rightCols(shown);
}

/// What the readings showed, what the twin says with the constants that fit best, and those constants.
struct Compared {
  std::vector<Reading> used;
  LinearRun run;
  FreeConstants free;
};

void SetNoise(const TwinComparison& comparison, LinearRun& run) {
  run.sigma_stated = comparison.noise > 0.0 || !comparison.noise_of_channel.empty();
  run.sigma.setConstant(run.Rows(), comparison.noise);
  if (!comparison.noise_of_channel.empty()) run.sigma = WeightsOf(comparison, run.Rows()).cwiseInverse();
  if (run.sigma_stated) return;
  for (int c = 0; c < run.Channels(); ++c) {
    const auto of_channel = Eigen::seq(c, Eigen::last, run.Channels());
    run.sigma(of_channel).setConstant(EstimateNoise_rad(run.schedule, run.residual(of_channel)));
  }
}

/// Hardly held: a millionth of what one reading says.
Nuisance HardlyHeld(const Eigen::MatrixXd& columns, const Eigen::VectorXd& sigma) {
  constexpr double kWeak = 1e-6;
  const Eigen::MatrixXd white = sigma.cwiseInverse().asDiagonal() * columns;
  const Eigen::VectorXd of_one_reading = white.cwiseAbs2().colwise().maxCoeff();
  return {columns.sparseView(), kWeak * of_one_reading.cwiseMax(1e-300), 0, 0};
}

Compared Compare(const std::vector<Reading>& readings, const Scenario& scenario, const TwinComparison& comparison) {
  constexpr int kMostHalvings = 6;
  const std::vector<ReadingColumn> columns = ColumnsShown(*comparison.format);
  Compared c{WithValues(readings, columns), {}, {}};
  LinearRun& run = c.run;
  run.bench = scenario.bench;
  run.schedule = model::CourseOf(c.used);
  run.channels = comparison.format->channels;
  run.unit = comparison.unit;
  run.to_SI = comparison.to_SI;
  run.noise_free = scenario.noise_free;
  for (int k = 0; k < run.Channels(); ++k)
    run.patterns.push_back({run.channels[static_cast<std::size_t>(k)], Eigen::VectorXd::Unit(run.Channels(), k)});
  run.observed.resize(std::ssize(c.used) * run.Channels());
  for (std::size_t i = 0; i < c.used.size(); ++i)
    run.observed.segment(static_cast<Eigen::Index>(i) * run.Channels(), run.Channels()) =
        ValuesOf(c.used[i], columns);
  const Followed twin(comparison.follow, scenario, readings, c.used);
  c.free = FreeOf(comparison, c.used, run.schedule);
  const auto left = [&]() -> Eigen::VectorXd { return run.observed - AsRows(twin.Predict(c.free.Disturbances())); };
  run.residual = left();
  if (!run.residual.allFinite())
    throw InputError("readings", "there are values where the scenario's bench would show none",
                     "a scenario of the bench that the readings come from");
  // The twin is asked again at the constants that fit: nothing stays of first order.
  SetColumns(twin, run.Rows(), c.free);
  const Eigen::VectorXd weights = WeightsOf(comparison, run.Rows());
  for (int k = 0; k < comparison.free_rounds && c.free.values.size() > 0; ++k) {
    if (k > 0) SetColumns(twin, run.Rows(), c.free);
    const Eigen::VectorXd before = c.free.values;
    const double norm = weights.cwiseProduct(run.residual).norm();
    Refit(run.residual, comparison, c.free);
    run.residual = left();
    // A step that leads out of what is nearly linear is shortened.
    for (int half = 0; half < kMostHalvings && !(weights.cwiseProduct(run.residual).norm() < 1.001 * norm);
         ++half) {
      c.free.values = 0.5 * (c.free.values + before);
      run.residual = left();
    }
  }
  SetNoise(comparison, run);
  if (c.free.values.size() > 0) SetFitted(comparison, c.free);
  run.nuisance = HardlyHeld(c.free.columns * c.free.fitted, run.sigma);
  return c;
}

/// The largest whole order that readings so far apart show: two a period.
int HighestOrder(const Schedule& schedule, const Eigen::VectorXd& angle_rad) {
  constexpr int kMost = 120;
  const double step_rad = model::TypicalStep_rad(schedule, angle_rad);
  return step_rad > 0.0 ? std::min(kMost, static_cast<int>(std::ceil(units::kPi / step_rad - 1e-6)) - 1) : 0;
}

unknown::Design DesignOf(const Compared& c, const TwinComparison& comparison, const TimeSeries& series) {
  constexpr double kPlausibleShare = 0.01;
  const LinearRun& run = c.run;
  unknown::Design design;
  design.course = run.schedule;
  design.channels = run.channels;
  for (const Pattern& pattern : run.patterns) design.places.push_back({pattern.name, pattern.name, pattern.weight});
  for (const TwinComparison::KnownAngle& known : comparison.angles) {
    Eigen::VectorXd rad(run.schedule.Readings());
    for (std::size_t i = 0; i < c.used.size(); ++i) rad[static_cast<Eigen::Index>(i)] = known.rad(c.used[i]);
    if (!rad.allFinite()) continue;
    design.angles.push_back({known.name + " angle", rad, HighestOrder(run.schedule, rad), 1, "harmonic", known.name,
                             design.angles.empty()});
  }
  if (!design.angles.empty()) design.continued_rad = design.angles.front().rad;
  design.moved = Eigen::VectorXd::Ones(run.schedule.Readings());
  design.senses = {model::HeldDirection(run.schedule)};
  if (run.schedule.velocity_rad_s.allFinite()) design.velocity = run.schedule.velocity_rad_s;
  if (model::HasTemperature(run.schedule)) {
    const Eigen::VectorXd T_degC = model::Above_K(run.schedule, 0.0);
    design.above_K = T_degC.array() - T_degC.mean();
  }
  design.series = series;
  design.shown = run.Predicted().reshaped<Eigen::RowMajor>(run.schedule.Readings(), run.Channels());
  design.shown_name = "reading";
  design.unit = run.unit;
  design.to_SI = run.to_SI;
  design.plausible = std::max(comparison.plausible, 3.0 * run.sigma.mean());
  design.plausible_share = kPlausibleShare;
  return design;
}

void AddProducts(const Compared& c, const TwinComparison& comparison, const Followed& twin,
                 const DiagnoseOptions& options, Candidates& named) {
  for (const TwinComparison::Product& product : comparison.products) {
    if (IsExcluded(options, product.effect)) continue;
    const auto columns = [slope = twin.Slope(product.point, c.free.Disturbances()), product,
                          used = c.used](const Eigen::VectorXd& shape) {
      const Eigen::MatrixXd courses = product.courses(used, shape[0]);
      Eigen::MatrixXd shown(slope.size(), courses.cols());
      for (Eigen::Index k = 0; k < courses.cols(); ++k) shown.col(k) = AsRows(courses.col(k).asDiagonal() * slope);
      return shown;
    };
    named.AddOver({product.effect, product.where, {}}, product.sizes,
                  {named.catalogue().ShapeOf(product.effect, product.shape, product.values(c.used))}, columns);
  }
}

/// "zero up to 0.3 um": the largest constant of each free point.
std::string BiasOf(const FreeConstants& free, const model::Follow& twin, const Eigen::VectorXd& constants) {
  std::string words;
  free.ForEach(free.fitted * constants, [&](const FreePoint& p, const auto& of_point) {
    const model::Point& point = model::PointNamed(twin, p.point);
    words += fmt::format("{}{} of {} up to {:.2g} {}", words.empty() ? "" : ", ", point.name, p.of,
                         of_point.cwiseAbs().maxCoeff() / point.to_SI, point.unit);
  });
  return words.empty() ? "nothing: the run leaves nothing free" : words;
}

std::string NextOf(const std::string& effect, const std::string& rival) {
  return fmt::format(
      "the same run on another course (more passes in both directions, other dwells, a further "
      "set-up), chosen so that {} and {} go different ways",
      effect, rival);
}

}  // namespace

LinearRun CompareWithTwin(const std::vector<Reading>& readings, const Scenario& scenario,
                          const TwinComparison& comparison) {
  return Compare(readings, scenario, comparison).run;
}

DiagnosisRun DiagnoseByTwin(const std::vector<Reading>& readings, const Scenario& scenario,
                            const DiagnoseOptions& options, const TwinComparison& comparison) {
  const Compared c = Compare(readings, scenario, comparison);
  const TimeSeries series = TimeSeriesOf(c.run.schedule, std::vector<int>(c.used.size(), 0), c.run.Channels());
  Candidates named(Catalogue(comparison.format->effects), c.run.Channels());
  std::vector<EffectEntry> entries = comparison.format->effects;
  std::erase_if(entries, [&](const EffectEntry& entry) {
    return IsExcluded(options, entry.name) ||
           std::ranges::any_of(comparison.products, [&](const auto& p) { return p.effect == entry.name; });
  });
  AddProducts(c, comparison, Followed(comparison.follow, scenario, readings, c.used), options, named);
  const std::vector<Invisible> invisible = AddAskedEffects(
      {comparison.follow, scenario, readings, c.used, c.free.Disturbances(), series.onsets}, entries, named);
  std::vector<Family> families = named.Take();
  std::ranges::move(unknown::Families(DesignOf(c, comparison, series)), std::back_inserter(families));
  const Analysis analysis = Analyse(c.run, families, AnalysisOptionsOf(options));
  const std::unique_ptr<model::Follow> twin = comparison.follow(scenario, readings);
  DiagnosisRun result =
      Conclude(c.run, analysis, {},
               {[&](const std::string&, const Eigen::VectorXd& x) { return BiasOf(c.free, *twin, x); }, NextOf});
  std::ranges::copy(invisible, std::back_inserter(result.diagnosis.invisible));
  result.diagnosis.left_out = static_cast<int>(readings.size() - c.used.size());
  return result;
}

}  // namespace twinbench::diagnose
