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

/// What a reading showed: one value a channel, SI.
using ValuesOf = std::function<Eigen::VectorXd(const Reading&)>;

ValuesOf ShownBy(const TwinComparison& comparison) {
  if (comparison.shown) return comparison.shown;
  return [columns = ColumnsShown(*comparison.format)](Reading reading) {
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
  if (std::ssize(used) < kFewestCompared)
    throw InputError("readings", fmt::format("{} of {} have a value", used.size(), readings.size()),
                     fmt::format("at least {}", kFewestCompared));
  return used;
}

/// By rows: reading i, channel c at i * channels + c.
Eigen::VectorXd AsRows(const Eigen::MatrixXd& by_reading) {
  return by_reading.transpose().reshaped();
}

/// The constants that a run leaves free: one of each free point in each set-up.
struct FreeConstants {
  std::vector<std::string> points;
  Eigen::MatrixXd setups;   // readings x set-ups
  Eigen::MatrixXd columns;  // rows x constants, a point's set-ups side by side
  Eigen::VectorXd values;   // SI

  /// As the twin is told them.
  std::vector<model::Disturbance> Disturbances() const {
    std::vector<model::Disturbance> all;
    for (std::size_t k = 0; k < points.size(); ++k)
      all.push_back(
          {points[k], setups * values.segment(static_cast<Eigen::Index>(k) * setups.cols(), setups.cols())});
    return all;
  }
};

FreeConstants FreeOf(const std::vector<std::string>& points, const Schedule& schedule, const Followed& twin) {
  FreeConstants free{points, model::Indicators(schedule.setup), {}, {}};
  std::vector<Eigen::MatrixXd> blocks;
  Eigen::Index rows = 0;
  for (const std::string& point : points) {
    const Eigen::MatrixXd slope = twin.Slope(point, {});
    rows = slope.size();
    Eigen::MatrixXd& block = blocks.emplace_back(rows, free.setups.cols());
    for (Eigen::Index k = 0; k < free.setups.cols(); ++k)
      block.col(k) = AsRows(free.setups.col(k).asDiagonal() * slope);
  }
  free.columns.resize(rows, std::ssize(blocks) * free.setups.cols());
  for (std::size_t k = 0; k < blocks.size(); ++k)
    free.columns.middleCols(static_cast<Eigen::Index>(k) * free.setups.cols(), free.setups.cols()) = blocks[k];
  free.values.setZero(free.columns.cols());
  return free;
}

/// What the readings showed, what the twin says with the constants that fit best, and those constants.
struct Compared {
  std::vector<Reading> used;
  LinearRun run;
  FreeConstants free;
};

void SetNoise(const Scenario& scenario, const std::vector<Reading>& used, const TwinComparison& comparison,
              LinearRun& run) {
  run.sigma.setConstant(run.Rows(), comparison.noise);
  for (std::size_t i = 0; comparison.noise_of && i < used.size(); ++i)
    run.sigma.segment(static_cast<Eigen::Index>(i) * run.Channels(), run.Channels()) =
        comparison.noise_of(scenario, used[i]);
  run.sigma_stated = run.sigma.minCoeff() > 0.0;
  if (run.sigma_stated) return;
  for (int c = 0; c < run.Channels(); ++c) {
    const auto of_channel = Eigen::seq(c, Eigen::last, run.Channels());
    run.sigma(of_channel).setConstant(EstimateNoise_rad(run.schedule, run.residual(of_channel)));
  }
}

/// Hardly held: a millionth of what one reading says. What no reading shows (a length where nothing has one) is
/// held.
Nuisance HardlyHeld(const Eigen::MatrixXd& columns, const Eigen::VectorXd& sigma) {
  constexpr double kWeak = 1e-6;
  const Eigen::MatrixXd white = sigma.cwiseInverse().asDiagonal() * columns;
  const Eigen::VectorXd of_one_reading = white.cwiseAbs2().colwise().maxCoeff();
  return {columns.sparseView(), (of_one_reading.array() > 0.0).select(kWeak * of_one_reading, 1.0), 0, 0};
}

Compared Compare(const std::vector<Reading>& readings, const Scenario& scenario, const TwinComparison& comparison) {
  constexpr double kRank = 1e-10;
  constexpr int kRounds = 2;  // the twin asked again at the constants that fit: nothing stays of first order
  const ValuesOf values_of = ShownBy(comparison);
  Compared c{WithValues(readings, values_of), {}, {}};
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
    run.observed.segment(static_cast<Eigen::Index>(i) * run.Channels(), run.Channels()) = values_of(c.used[i]);
  const Followed twin(comparison.follow, scenario, readings, c.used);
  c.free = FreeOf(comparison.free_points, run.schedule, twin);
  const auto left = [&]() -> Eigen::VectorXd { return run.observed - AsRows(twin.Predict(c.free.Disturbances())); };
  run.residual = left();
  if (!run.residual.allFinite())
    throw InputError("readings", "there are values where the scenario's bench would show none",
                     "a scenario of the bench that the readings come from");
  for (int k = 0; k < kRounds && c.free.columns.cols() > 0; ++k) {
    c.free.values += SolveRanked(c.free.columns, run.residual, kRank).x;
    run.residual = left();
  }
  SetNoise(scenario, c.used, comparison, run);
  run.nuisance = HardlyHeld(c.free.columns, run.sigma);
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
    for (std::size_t i = 0; i < c.used.size(); ++i) rad[static_cast<Eigen::Index>(i)] = c.used[i].*known.rad;
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

/// "zero up to 0.3 um": the largest constant of each free point.
std::string BiasOf(const FreeConstants& free, const model::Follow& twin, const Eigen::VectorXd& constants) {
  std::string words;
  for (std::size_t k = 0; k < free.points.size(); ++k) {
    const model::Point& point = model::PointNamed(twin, free.points[k]);
    const auto of_point = constants.segment(static_cast<Eigen::Index>(k) * free.setups.cols(), free.setups.cols());
    words += fmt::format("{}{} of a set-up up to {:.2g} {}", words.empty() ? "" : ", ", point.name,
                         of_point.cwiseAbs().maxCoeff() / point.to_SI, point.unit);
  }
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
  std::erase_if(entries, [&](const EffectEntry& entry) { return IsExcluded(options, entry.name); });
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
