#include "twin/diagnose/twin_candidates.h"

#include <algorithm>

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
    design.angles.push_back({known.name + " angle", rad,
                             model::HighestOrder(model::TypicalStep_rad(run.schedule, rad)), 1, "harmonic",
                             known.name, design.angles.empty()});
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
  design.units = run.units;
  constexpr double kPlausibleNoise = 3.0;
  design.plausible = std::max(comparison.plausible, kPlausibleNoise * run.sigma.mean());
  if (NamesTonesOfChannels(comparison)) design.named = {{"tone", "tone"}};
  if (run.IsMixed()) {
    design.plausible = kPlausibleNoise;
    design.scale = run.sigma.reshaped(run.Channels(), run.schedule.Readings()).rowwise().mean();
  }
  design.plausible_share = kPlausibleShare;
  return design;
}

TwinComparison::ShapedProduct Shaped(const TwinComparison::Product& p, const std::vector<Reading>& used) {
  const std::vector<double> values = p.values(used);
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

void AddProduct(const Compared& c, const TwinComparison& comparison, const TwinComparison::ShapedProduct& product,
                Candidates& named) {
  std::vector<Shape> shapes;
  for (std::size_t k = 0; k < product.shapes.size(); ++k) {
    const auto values = product.values.col(static_cast<Eigen::Index>(k));
    shapes.push_back(named.catalogue().ShapeOf(product.effect, product.shapes[k], {values.begin(), values.end()}));
  }
  named.AddOver({product.effect, product.where, {}}, product.sizes, shapes,
                [slope = c.twin.Slope(product.point, c.free.Disturbances()), courses = product.courses,
                 used = AsPredicted(c, comparison)](const Eigen::VectorXd& shape) {
                  return unknown::ShownOf(slope, courses(used, shape));
                });
}

/// Effects of the catalogue as slopes of the twin times courses, where asking anew at each shape takes too long.
void AddProducts(const Compared& c, const TwinComparison& comparison, const DiagnoseOptions& options,
                 Candidates& named) {
  for (const TwinComparison::Product& product : comparison.products) {
    if (!IsExcluded(options, product.effect)) AddProduct(c, comparison, Shaped(product, c.used), named);
  }
  for (const TwinComparison::ShapedProduct& product : comparison.shaped_products) {
    if (!IsExcluded(options, product.effect)) AddProduct(c, comparison, product, named);
  }
}

unknown::AtPoint AtPointOf(const Compared& c, const std::string& name) {
  constexpr double kPlausibleNoise = 3.0;
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
/// itself.
std::vector<EffectEntry> AskedOf(const TwinComparison& comparison, const DiagnoseOptions& options) {
  std::vector<EffectEntry> entries = comparison.format->effects;
  std::erase_if(entries, [&](const EffectEntry& entry) {
    return IsExcluded(options, entry.name) || entry.name == "outliers" ||
           (entry.name == "tone" && !comparison.tones.empty()) ||
           std::ranges::count(comparison.products, entry.name, &TwinComparison::Product::effect) > 0 ||
           std::ranges::count(comparison.shaped_products, entry.name, &TwinComparison::ShapedProduct::effect) > 0;
  });
  return entries;
}

}  // namespace

TwinCandidates CandidatesOf(const Compared& compared, const std::vector<Reading>& readings,
                            const Scenario& scenario, const DiagnoseOptions& options,
                            const TwinComparison& comparison) {
  const Compared& c = compared;
  const TimeSeries series = TimeSeriesOf(c.run.schedule, std::vector<int>(c.used.size(), 0), c.run.Channels());
  Candidates named(Catalogue(comparison.format->effects), c.run.Channels());
  AddProducts(c, comparison, options, named);
  for (const TwinComparison::ToneOn& tone : comparison.tones) {
    if (!IsExcluded(options, "tone")) named.AddTone({"tone", tone.where, tone.pattern}, series);
  }
  TwinCandidates candidates;
  candidates.invisible =
      AddAskedEffects({comparison.follow, scenario, readings, c.used, c.free.Disturbances(), series.onsets},
                      AskedOf(comparison, options), named);
  candidates.families = named.Take();
  std::ranges::move(unknown::Families(DesignOf(c, comparison, series)), std::back_inserter(candidates.families));
  AddAtPoints(c, comparison, candidates.families);
  return candidates;
}

}  // namespace twinbench::diagnose
