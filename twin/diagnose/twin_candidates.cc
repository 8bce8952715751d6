#include "twin/diagnose/twin_candidates.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>

#include "twin/core/reading_clock.h"
#include "twin/diagnose/as_predicted.h"
#include "twin/diagnose/conclusion.h"
#include "twin/diagnose/engine/asked_effects.h"
#include "twin/diagnose/unknown/at_points.h"
#include "twin/diagnose/unknown/design.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose {
namespace {

/// A tone on a channel has a name then.
bool NamesTonesOfChannels(const TwinComparison& comparison) {
  return !comparison.tones.empty() ||
         std::ranges::any_of(comparison.products, [&](const TwinComparison::Product& p) {
           return p.effect == "tone" && std::ranges::count(comparison.format->channels, p.point) > 0;
         });
}

constexpr double kPlausibleNoise = 3.0;
constexpr double kKept = 0.3;  // of a wave, by the means of neighbours

/// Of a disturbance that nobody thought of: no less than shows in noise.
double PlausibleOf(const LinearRun& run, const TwinComparison& comparison) {
  const double noise = comparison.is_used ? run.sigma.minCoeff() : run.sigma.mean();
  return std::max(comparison.plausible, kPlausibleNoise * noise);
}

/// Every channel alone, and before them all together.
std::vector<unknown::Place> PlacesOf(const LinearRun& run, bool is_alike_on_all) {
  std::vector<unknown::Place> places;
  if (is_alike_on_all && run.Channels() > 1) {
    const std::string all = fmt::format("{}", fmt::join(run.channels, ", "));
    places.push_back({all, all, Eigen::VectorXd::Ones(run.Channels())});
  }
  for (const Pattern& pattern : run.patterns) places.push_back({pattern.name, pattern.name, pattern.weight});
  return places;
}

/// The largest whole order that the readings show and their means keep to some extent.
int LastOrder(const Compared& c, const Eigen::VectorXd& angle_rad) {
  const int most = model::HighestOrder(model::TypicalStep_rad(c.readings, angle_rad));
  if (!c.groups.Averages()) return most;
  int last = std::min(most, 2);
  while (last < most && KeptByMean((last + 1) * angle_rad, c.groups) >= kKept) ++last;
  return last;
}

bool NamesLowOrders(const TwinComparison& comparison) {
  return !comparison.angles.empty() && comparison.angles.front().lowest_order > 1;
}

unknown::Design DesignOf(const Compared& c, const TwinComparison& comparison, const TimeSeries& series) {
  constexpr double kPlausibleShare = 0.01;
  const LinearRun& run = c.run;
  const Schedule& readings = c.readings;
  unknown::Design design;
  design.course = readings;
  design.rows = c.Means();
  design.channels = run.channels;
  design.places = PlacesOf(run, comparison.is_alike_on_all);
  for (const TwinComparison::KnownAngle& known : comparison.angles) {
    const Eigen::VectorXd rad = OfReadings(c.used, known.rad);
    if (!rad.allFinite()) continue;
    design.angles.push_back({known.words.empty() ? known.name + " angle" : known.words, rad, LastOrder(c, rad),
                             known.first_unfree == 0 ? 0 : std::max(known.first_unfree, known.lowest_order),
                             known.harmonics, known.name, known.is_turned_by_motion && design.angles.empty(),
                             known.lowest_order});
  }
  if (!design.angles.empty()) design.continued_rad = design.angles.front().rad;
  design.moved = Eigen::VectorXd::Ones(readings.Readings());
  for (std::size_t i = 0; i < readings.phase.size(); ++i)
    if (readings.phase[i] == Phase::kCalibration) design.moved[static_cast<Eigen::Index>(i)] = 0.0;
  design.senses = {model::HeldDirection(readings)};
  if (comparison.sampled) design.travel_rad = comparison.sampled->travel_rad(c.used);
  if (readings.velocity_rad_s.allFinite()) design.velocity = readings.velocity_rad_s;
  if (model::HasTemperature(run.schedule)) {
    const Eigen::VectorXd T_degC = model::Above_K(run.schedule, 0.0);
    design.above_K = T_degC.array() - T_degC.mean();
  }
  design.series = series;
  // Where low orders have names, what goes with the reading as a whole does so for their sake.
  if (!comparison.shows_errors && !NamesLowOrders(comparison)) {
    design.shown = run.Predicted().reshaped<Eigen::RowMajor>(run.schedule.Readings(), run.Channels());
    design.shown_name = "reading";
    for (int k = 0; k < run.Channels(); ++k)
      if (std::ranges::count(comparison.nulled, run.channels[static_cast<std::size_t>(k)]) > 0)
        design.shown.col(k).setZero();
  }
  design.unit = run.unit;
  design.to_SI = run.to_SI;
  design.units = run.units;
  design.plausible = PlausibleOf(run, comparison);
  design.named = comparison.named;
  if (NamesTonesOfChannels(comparison)) design.named.emplace("tone", "tone");
  if (run.IsMixed()) {
    design.plausible = kPlausibleNoise;
    design.scale = run.sigma.reshaped(run.Channels(), run.schedule.Readings()).rowwise().mean();
  }
  design.plausible_share = kPlausibleShare;
  if (comparison.structure) comparison.structure(c, design);
  return design;
}

/// Without orders, the first of them on that the means of neighbours hardly keep.
void LeaveOutAveraged(const Compared& c, const TwinComparison::Product& orders, std::vector<double>& values) {
  if (!c.groups.Averages() || values.empty()) return;
  const auto averaged = std::ranges::find_if(values, [&](double order) {
    const Eigen::MatrixXd wave = orders.courses(c.used, order);
    const double kept2 = c.groups.Mean(wave).squaredNorm() / static_cast<double>(c.groups.Groups());
    return kept2 < kKept * kKept * wave.squaredNorm() / static_cast<double>(c.groups.Samples());
  });
  values.erase(std::max(averaged, values.begin() + 1), values.end());
}

TwinComparison::ShapedProduct Shaped(const TwinComparison::Product& p, const Compared& c) {
  std::vector<double> values = p.values(c.used);
  if (p.is_order) LeaveOutAveraged(c, p, values);
  return {p.effect,
          p.where,
          p.point,
          p.sizes,
          {p.shape},
          Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values)),
          [courses = p.courses](const std::vector<Reading>& readings, const Eigen::VectorXd& shape) {
            return courses(readings, shape[0]);
          }};
}

Family& AddProduct(const Compared& c, const TwinComparison& comparison,
                   const TwinComparison::ShapedProduct& product, const Eigen::MatrixXd& slope, Candidates& named) {
  std::vector<Shape> shapes;
  for (std::size_t k = 0; k < product.shapes.size(); ++k) {
    const auto values = product.values.col(static_cast<Eigen::Index>(k));
    shapes.push_back(named.catalogue().ShapeOf(product.effect, product.shapes[k], {values.begin(), values.end()}));
  }
  return named.AddOver({product.effect, product.where, {}}, product.sizes, shapes,
                       [slope, courses = product.courses, used = AsPredicted(c, comparison),
                        groups = c.groups](const Eigen::VectorXd& shape) {
                         return groups.MeanOfRows(unknown::ShownOf(slope, courses(used, shape)));
                       });
}

/// Effects of the catalogue as slopes of the twin times courses, where asking anew at each shape takes too long.
void AddProducts(const Compared& c, const TwinComparison& comparison, const DiagnoseOptions& options,
                 Candidates& named) {
  std::map<std::string, Eigen::MatrixXd> slopes;
  const auto slope_at = [&](const std::string& point) -> const Eigen::MatrixXd& {
    if (!slopes.contains(point)) slopes[point] = c.twin.Slope(point, c.free.Disturbances());
    return slopes[point];
  };
  for (const TwinComparison::Product& product : comparison.products) {
    const TwinComparison::ShapedProduct shaped = Shaped(product, c);
    if (IsExcluded(options, product.effect) || shaped.values.rows() == 0) continue;  // a record without a clock
    Family& family = AddProduct(c, comparison, shaped, slope_at(product.point), named);
    if (product.is_order)
      named.MakeOrders(family);
    else if (product.is_wave)
      named.MakeWaves(family);
  }
  for (const TwinComparison::ShapedProduct& product : comparison.shaped_products) {
    if (!IsExcluded(options, product.effect) && product.values.rows() > 0) AddProduct(c, comparison, product, slope_at(product.point), named);
  }
}

/// Steps as a point shows them.
TimeSeries ShownSteps(const TimeSeries& series, const Eigen::VectorXd& share) {
  TimeSeries shown = series;
  if (!series.steps || share.isOnes()) return shown;
  auto steps = std::make_shared<Base>(*series.steps);
  steps->series = [of_all = series.steps->series, share](int k) { return model::Times(of_all(k), share); };
  steps->sums = {};
  shown.steps = steps;
  return shown;
}

/// Effects that are nothing but a wave, or a step, in what channels show.
void AddTonesAndSteps(const Compared& c, const TwinComparison& comparison, const DiagnoseOptions& options,
                      const TimeSeries& series, Candidates& named) {
  for (const TwinComparison::ShownOn& tone : comparison.tones) {
    if (!IsExcluded(options, "tone")) named.AddTone({"tone", tone.where, tone.pattern}, series, tone.is_sine);
  }
  for (const TwinComparison::ShownOn& step : comparison.steps) {
    if (!IsExcluded(options, "slip")) named.AddStep({"slip", step.where, step.pattern}, "step", series);
  }
  for (const auto& [effect, where, point, parameter] : comparison.steps_at) {
    if (IsExcluded(options, effect)) continue;
    const Response response = ResponseTo(c, point);
    named.AddStep({effect, where, response.pattern}, parameter, ShownSteps(series, response.share));
  }
}

unknown::AtPoint AtPointOf(const Compared& c, const std::string& name) {
  const model::Point& point = c.twin.Point(name);
  return {name, point.unit, point.to_SI, kPlausibleNoise * PerNoise(c, name),
          c.twin.Slope(name, c.free.Disturbances())};
}

/// @param readings  Without noise: a coordinate may be something that was read.
unknown::Along AlongOf(const std::vector<Reading>& readings, const TwinComparison::Coordinate& coordinate) {
  unknown::Along along{coordinate.name, coordinate.unit, coordinate.to_SI, Eigen::VectorXd(std::ssize(readings))};
  for (std::size_t i = 0; i < readings.size(); ++i)
    along.value[static_cast<Eigen::Index>(i)] = coordinate.value(readings[i]);
  return along;
}

/// Structure without a name at points of the twin.
void AddAtPoints(const Compared& c, const TwinComparison& comparison, std::vector<Family>& families) {
  const std::vector<Reading> readings = AsPredicted(c, comparison);
  std::vector<unknown::AtPoint> points;
  std::vector<unknown::Along> coordinates;
  for (const std::string& name : comparison.interaction_points) points.push_back(AtPointOf(c, name));
  for (const TwinComparison::Coordinate& coordinate : comparison.coordinates)
    coordinates.push_back(AlongOf(readings, coordinate));
  std::ranges::move(unknown::Interactions(points, coordinates), std::back_inserter(families));
  for (const TwinComparison::FringesAlong& f : comparison.fringes)
    families.push_back(unknown::Fringes(AtPointOf(c, f.point), AlongOf(readings, f.along), f.shortest, f.longest));
}

/// Those of the catalogue that the twin is asked about one by one. Outliers have no shape: noise is judged by
/// itself. What has no size is an alternative.
std::vector<EffectEntry> AskedOf(const TwinComparison& comparison, const DiagnoseOptions& options,
                                 const std::vector<Family>& own) {
  std::vector<EffectEntry> entries = comparison.format->effects;
  std::erase_if(entries, [&](const EffectEntry& entry) {
    return IsExcluded(options, entry.name) || entry.name == "outliers" || entry.parameters.empty() ||
           std::ranges::count(comparison.unrecorded, entry.name) > 0 ||
           (comparison.scatter_cause && entry.name == comparison.scatter_cause->effect) ||
           (entry.name == "tone" && !comparison.tones.empty()) ||
           (entry.name == "slip" && !comparison.steps.empty()) ||
           std::ranges::count(comparison.steps_at, entry.name, &TwinComparison::StepAt::effect) > 0 ||
           std::ranges::count(own, entry.name, &Family::effect) > 0 ||
           std::ranges::count(comparison.products, entry.name, &TwinComparison::Product::effect) > 0 ||
           std::ranges::count(comparison.shaped_products, entry.name, &TwinComparison::ShapedProduct::effect) > 0;
  });
  return entries;
}

/// Whether an effect is told by when something was read: it has a rate or a frequency. (What has a time may go by a speed.)
bool GoesByTime(const BenchFormat& bench, const std::string& effect) {
  const auto entry = std::ranges::find(bench.effects, effect, &EffectEntry::name);
  return entry != bench.effects.end() && std::ranges::any_of(entry->parameters, [](const EffectParameter& p) {
           return p.unit == "Hz" || p.unit.ends_with("_h");
         });
}

/// Nothing is told against time where none is known.
void LeaveOutTimes(const BenchFormat& bench, TwinCandidates& candidates) {
  std::erase_if(candidates.families, [&](const Family& f) { return f.goes_by_time || GoesByTime(bench, f.effect); });
  std::erase_if(candidates.invisible, [&](const Invisible& lost) { return GoesByTime(bench, lost.effect); });
}

}  // namespace

BelievedRecord AskedRecord(const Compared& c, const std::vector<Reading>& readings, const Scenario& scenario,
                           const TwinComparison& comparison) {
  return {comparison.follow,
          scenario,
          RecordAsPredicted(c, readings, comparison),
          c.used,
          c.free.Disturbances(),
          {},
          c.run.Channels(),
          c.groups,
          comparison.asked_points,
          comparison.alike_by_trace};
}

TwinCandidates CandidatesOf(const Compared& compared, const std::vector<Reading>& readings,
                            const Scenario& scenario, const DiagnoseOptions& options,
                            const TwinComparison& comparison) {
  const Compared& c = compared;
  const std::vector<int> stretch =
      comparison.remounting_ends_tones ? c.readings.setup : std::vector<int>(c.used.size(), 0);
  const TimeSeries series = TimeSeriesOf(c.readings, stretch, c.run.Channels(), c.Means(), c.run.schedule.time_s);
  Candidates named(Catalogue(comparison.format->effects), c.run.Channels(), c.Means());
  AddProducts(c, comparison, options, named);
  AddTonesAndSteps(c, comparison, options, series, named);
  TwinCandidates candidates;
  BelievedRecord asked = AskedRecord(c, readings, scenario, comparison);
  asked.onsets = series.onsets;
  std::vector<Family> own = comparison.own_families ? comparison.own_families(c, asked, series) : std::vector<Family>{};
  std::erase_if(own, [&](const Family& family) { return IsExcluded(options, family.effect); });
  candidates.invisible = AddAskedEffects(asked, AskedOf(comparison, options, own), named);
  candidates.families = named.Take();
  std::ranges::move(own, std::back_inserter(candidates.families));
  for (Family& family : candidates.families) {
    if (comparison.sizes_by_trace) SetSizesByTrace(c.run.Channels(), PlausibleOf(c.run, comparison), family);
    if (comparison.listed) family.listed = comparison.listed(family.effect, family.where);
  }
  std::vector<Family> shapes = unknown::Families(DesignOf(c, comparison, series));
  // At one speed time goes as the angle does: a wander would take what low orders have names for.
  if (NamesLowOrders(comparison)) std::erase_if(shapes, [](const Family& family) { return family.goes_by_time; });
  std::ranges::move(shapes, std::back_inserter(candidates.families));
  AddAtPoints(c, comparison, candidates.families);
  if (!HasClock(readings)) LeaveOutTimes(*comparison.format, candidates);
  return candidates;
}

}  // namespace twinbench::diagnose
