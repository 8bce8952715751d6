#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "twin/core/units.h"
#include "twin/diagnose/accepted_columns.h"
#include "twin/diagnose/at.h"
#include "twin/diagnose/bins.h"
#include "twin/diagnose/json.h"

namespace twinbench::diagnose {
namespace {

using nlohmann::json;

constexpr int kBins = 24;                // of a variable that takes many values ...
constexpr std::size_t kMostValues = 48;  // ... which is more than this

/// Four digits are enough for a plot.
json Short(double value) {
  return std::isfinite(value) ? json(std::stod(fmt::format("{:.4g}", value))) : json(nullptr);
}

/// One curve's data, one entry a reading, in the run's unit.
struct PlottedSeries {
  std::string name;
  Eigen::VectorXd before, after, sigma;
  std::string unit;
  Eigen::VectorXd spot_um;  // of a channel; empty for a pattern
};

/// Of the channel that shows most of it.
ChannelUnit UnitOf(const LinearRun& run, const Eigen::VectorXd& weight) {
  int channel = 0;
  weight.cwiseAbs().maxCoeff(&channel);
  return run.UnitOf(channel);
}

/// Projects the channels of each reading on `weight`, whose largest entry is 1.
Eigen::VectorXd Project(const LinearRun& run, const Eigen::VectorXd& rows, const Eigen::VectorXd& weight) {
  const Eigen::Map<const Eigen::MatrixXd> by_reading(rows.data(), run.Channels(), run.schedule.Readings());
  return by_reading.transpose() * weight / (weight.squaredNorm() * UnitOf(run, weight).to_SI);
}

PlottedSeries MakeSeries(const LinearRun& run, const LeftOver& left, const std::string& name,
                         const Eigen::VectorXd& weight) {
  const Eigen::VectorXd w = weight / weight.cwiseAbs().maxCoeff();
  const Eigen::VectorXd variance = Project(run, run.sigma.cwiseAbs2(), w.cwiseAbs2());
  const ChannelUnit unit = UnitOf(run, w);
  const double scale = w.cwiseAbs2().squaredNorm() / std::pow(w.squaredNorm(), 2) / unit.to_SI;
  return {
      name, Project(run, left.before, w), Project(run, left.after, w), (variance * scale).cwiseSqrt(), unit.name,
      {}};
}

std::vector<PlottedSeries> AllSeries(const LinearRun& run, const LeftOver& left) {
  std::vector<PlottedSeries> all;
  for (int c = 0; c < run.Channels(); ++c) {
    const Eigen::VectorXd weight = Eigen::VectorXd::Unit(run.Channels(), c);
    all.push_back(MakeSeries(run, left, run.channels[At(c)], weight));
    if (run.unit == "um") all.back().spot_um = Project(run, run.Predicted(), weight);
  }
  for (const Pattern& pattern : run.patterns) {
    if (pattern.weight.size() == run.Channels() && run.Channels() > 1)
      all.push_back(MakeSeries(run, left, pattern.name, pattern.weight));
  }
  return all;
}

std::vector<std::pair<std::string, Eigen::VectorXd>> Variables(const Schedule& s) {
  Eigen::VectorXd direction(s.Readings());
  for (int i = 0; i < s.Readings(); ++i)
    direction[i] = s.phase[At(i)] == Phase::kFullCircle ? s.direction[At(i)] : kNaN;
  return {{"time_s", s.time_s},
          {"target_deg", InTurn_deg(s.target_rad / units::deg)},
          {"reference_deg", InTurn_deg(s.reference_rad / units::deg)},
          {"direction", direction},
          {"temperature_degC", s.temperature_degC},
          {"dwell_s", s.dwell_s},
          {"velocity_deg_s", s.velocity_rad_s / units::deg}};
}

/// Means of a series in each bin that has readings.
json Curve(const Bins& bins, const PlottedSeries& series) {
  struct Sum {
    int n = 0;
    double before = 0.0, after = 0.0, variance = 0.0;
  };
  std::vector<Sum> sums(bins.centre.size());
  for (std::size_t i = 0; i < bins.of_value.size(); ++i) {
    if (bins.of_value[i] < 0) continue;
    const auto k = static_cast<Eigen::Index>(i);
    Sum& sum = sums[At(bins.of_value[i])];
    ++sum.n;
    sum.before += series.before[k];
    sum.after += series.after[k];
    sum.variance += std::pow(series.sigma[k], 2);
  }
  json curve = {{"x", json::array()},
                {"n", json::array()},
                {"before", json::array()},
                {"after", json::array()},
                {"u", json::array()}};
  for (std::size_t b = 0; b < sums.size(); ++b) {
    const Sum& sum = sums[b];
    if (sum.n == 0) continue;
    curve["x"].push_back(Short(bins.centre[b]));
    curve["n"].push_back(sum.n);
    curve["before"].push_back(Short(sum.before / sum.n));
    curve["after"].push_back(Short(sum.after / sum.n));
    curve["u"].push_back(Short(std::sqrt(sum.variance) / sum.n));
  }
  return curve;
}

/// Mean over passes by set-up (rows) and position (columns).
json Map(const Schedule& s, const PlottedSeries& series) {
  std::map<int, std::map<int, std::array<double, 3>>> cells;
  std::set<int> positions;
  for (int i = 0; i < s.Readings(); ++i) {
    if (s.phase[At(i)] != Phase::kFullCircle) continue;
    positions.insert(s.position[At(i)]);
    auto& cell = cells[s.setup[At(i)]][s.position[At(i)]];
    cell[0] += 1.0;
    cell[1] += series.before[i];
    cell[2] += series.after[i];
  }
  json map = {
      {"setup", json::array()}, {"position", positions}, {"before", json::array()}, {"after", json::array()}};
  for (const auto& [setup, row] : cells) {
    map["setup"].push_back(setup);
    json before = json::array(), after = json::array();
    for (const int position : positions) {
      const auto cell = row.find(position);
      before.push_back(cell == row.end() ? json(nullptr) : Short(cell->second[1] / cell->second[0]));
      after.push_back(cell == row.end() ? json(nullptr) : Short(cell->second[2] / cell->second[0]));
    }
    map["before"].push_back(before);
    map["after"].push_back(after);
  }
  return map;
}

void AddCurve(const std::string& name, const Eigen::VectorXd& variable, const PlottedSeries& series,
              json& against) {
  if (variable.size() != series.before.size()) return;
  const Bins bins = MakeBins(variable, kMostValues, kBins);
  if (bins.centre.size() > 1) against[name][series.name] = Curve(bins, series);
}

}  // namespace

json PlotsJson(const DiagnosisRun& run) {
  const LeftOver left = FitAll(run.run, run.noise, run.accepted);
  json plots = {{"unit", run.run.unit}, {"against", json::object()}, {"maps", json::object()}};
  for (const PlottedSeries& series : AllSeries(run.run, left)) {
    if (run.run.IsMixed()) plots["units"][series.name] = series.unit;
    for (const auto& [name, variable] : Variables(run.run.schedule))
      AddCurve(name, variable, series, plots["against"]);
    AddCurve("spot_um", series.spot_um, series, plots["against"]);
    plots["maps"][series.name] = Map(run.run.schedule, series);
  }
  return plots;
}

}  // namespace twinbench::diagnose
