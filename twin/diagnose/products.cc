#include "twin/diagnose/products.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "twin/core/units.h"
#include "twin/diagnose/engine/candidates.h"
#include "twin/diagnose/engine/time_series.h"
#include "twin/model/signals.h"

namespace twinbench::diagnose {
namespace {

/// Even in 1 / period, so close that a wave between two of them keeps nearly all of its size.
std::vector<double> Periods(double range, double shortest, double longest) {
  const double first = 1.0 / longest, last = 1.0 / shortest;
  const int count = 2 + static_cast<int>(std::ceil(2.0 * (last - first) * range));
  std::vector<double> periods;
  for (int k = count - 1; k >= 0; --k) periods.push_back(1.0 / (first + (last - first) * k / (count - 1)));
  return periods;
}

Eigen::ArrayXd Along(const std::vector<Reading>& readings, const std::function<double(const Reading&)>& along) {
  Eigen::ArrayXd at(std::ssize(readings));
  for (std::size_t i = 0; i < readings.size(); ++i) at[static_cast<Eigen::Index>(i)] = along(readings[i]);
  return at;
}

/// Fewer readings of a mounting before a step, or behind it, are readings that are far off and no place where it stays.
bool IsAtAnEnd(const std::vector<Reading>& readings, double onset) {
  constexpr int kFewest = 4;
  const auto first = std::ranges::lower_bound(readings, onset, {}, &Reading::reading);
  if (first == readings.end()) return true;
  const auto before = std::count_if(readings.begin(), first, [&](const Reading& r) { return r.setup == first->setup; });
  const auto behind = std::count_if(first, readings.end(), [&](const Reading& r) { return r.setup == first->setup; });
  return before < kFewest || behind < kFewest;
}

}  // namespace

TwinComparison::Product WaveAlong(const std::string& effect, const std::string& where, const std::string& point,
                                  const std::string& period, std::function<double(const Reading&)> along,
                                  double shortest, double longest) {
  const auto periods = [along, shortest, longest](const std::vector<Reading>& readings) {
    const Eigen::ArrayXd at = Along(readings, along);
    return Periods(at.maxCoeff() - at.minCoeff(), shortest, longest);
  };
  const auto wave = [along](const std::vector<Reading>& readings, double length) {
    return model::Wave(units::turn * Along(readings, along) / length);
  };
  return {effect, where, point, {"cosine", "sine"}, period, periods, wave};
}

TwinComparison::Product SlipAt(const std::string& where, const std::string& point) {
  const auto onsets = [](const std::vector<Reading>& readings) {
    std::vector<double> at_reading = OnsetsOf(model::CourseOf(readings)).at_reading;
    std::erase_if(at_reading, [&readings](double onset) { return IsAtAnEnd(readings, onset); });
    return at_reading;
  };
  const auto step = [](const std::vector<Reading>& readings, double at_reading) {
    return Eigen::MatrixXd(model::Step(model::CourseOf(readings).reading, at_reading));
  };
  return {"slip", where, point, {"step"}, "at_reading", onsets, step};
}

std::vector<double> TemperatureLags_s() {
  std::vector<double> lags_s = Ratios(100.0, 20000.0, 16);
  lags_s.insert(lags_s.begin(), 0.0);
  return lags_s;
}

TwinComparison::Product FollowsTemperature(const std::string& effect, const std::string& where,
                                           const std::string& point, const std::string& size,
                                           double reference_degC) {
  const auto followed = [reference_degC](const std::vector<Reading>& readings, double lag_s) {
    const model::Course course = model::CourseOf(readings);
    const Eigen::VectorXd above_K = model::Above_K(course, reference_degC);
    return Eigen::MatrixXd(lag_s > 0.0 ? model::Lagged(course.time_s, above_K, lag_s) : above_K);
  };
  return {effect, where, point, {size}, "lag", [](const std::vector<Reading>&) { return TemperatureLags_s(); }, followed};
}

std::vector<TwinComparison::Scatter> RepeatabilityOf(const std::string& table,
                                                     const std::array<double, kComponents>& sd) {
  std::vector<TwinComparison::Scatter> scatter;
  for (std::size_t c = 0; c < kComponents; ++c) scatter.push_back({table + "." + kComponentNames[c], sd[c]});
  return scatter;
}

}  // namespace twinbench::diagnose
