#include "twin/benches/encoder_comparison/estimators/head_readings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "twin/benches/encoder_comparison/estimators/angle_comparison.h"
#include "twin/core/units.h"
#include "twin/separate/mean.h"

namespace twinbench::separate::encoder {
namespace {

/// Heads that are read at one time belong together: the first set-up among them names the mounting.
std::vector<HeadStop> StopsOf(const std::vector<Reading>& readings, const measure::AngleComparison& comparison) {
  std::map<Time, HeadStop> by_time;
  for (std::size_t i = 0; i < comparison.used.size(); ++i) {
    const Reading& r = readings[static_cast<std::size_t>(comparison.used[i])];
    if (r.direction == 0 || !std::isfinite(r.head_rad)) continue;
    HeadStop& stop = by_time[r.time];
    stop.reference_rad = r.reference_rad;
    stop.values.push_back({r.setup, r.head_rad, kNaN, comparison.error_rad[static_cast<Eigen::Index>(i)]});
  }
  std::vector<HeadStop> stops;
  for (auto& [time, stop] : by_time) {
    if (stop.values.size() < 2) continue;
    std::ranges::sort(stop.values, {}, &HeadValue::setup);
    stop.first_setup = stop.values.front().setup;
    stops.push_back(std::move(stop));
  }
  return stops;
}

/// A head that failed at a stop must not make another mounting of it.
void NameMountings(std::vector<HeadStop>& stops) {
  std::map<int, int> first;  // by set-up
  for (const HeadStop& stop : stops) {
    for (const HeadValue& value : stop.values) {
      int& of = first.try_emplace(value.setup, stop.first_setup).first->second;
      of = std::min(of, stop.first_setup);
    }
  }
  for (HeadStop& stop : stops) stop.first_setup = first.at(stop.first_setup);
}

/// Where the ring stands under each head: as the first one of its mounting shows it.
void EnterRingAngles(std::vector<HeadStop>& stops) {
  std::map<int, Mean> shown_rad;  // x + head, by mounting
  for (const HeadStop& stop : stops) {
    const HeadValue& first = stop.values.front();
    if (first.setup == stop.first_setup) shown_rad[stop.first_setup].Add(first.x_rad + first.head_rad);
  }
  for (HeadStop& stop : stops) {
    const double mounting_rad = shown_rad[stop.first_setup].Value();
    for (HeadValue& value : stop.values) value.ring_rad = stop.reference_rad + mounting_rad - value.head_rad;
  }
}

/// The zeros of the heads are some turns, the errors arcseconds: sums of squares are to be of the second alone.
void TakeOutMeans(std::vector<HeadStop>& stops) {
  std::map<int, Mean> mean_rad;  // by set-up
  for (const HeadStop& stop : stops) {
    for (const HeadValue& value : stop.values) mean_rad[value.setup].Add(value.x_rad);
  }
  for (HeadStop& stop : stops) {
    for (HeadValue& value : stop.values) value.x_rad -= mean_rad.at(value.setup).Value();
  }
}

}  // namespace

int HeadReadings::Values() const {
  int count = 0;
  for (const HeadStop& stop : stops) count += static_cast<int>(stop.values.size());
  return count;
}

double HeadReadings::WidestGap_rad() const {
  std::vector<double> at_rad;
  for (const HeadStop& stop : stops)
    at_rad.push_back(stop.reference_rad - units::turn * std::floor(stop.reference_rad / units::turn));
  if (at_rad.empty()) return units::turn;
  std::ranges::sort(at_rad);
  double widest_rad = at_rad.front() + units::turn - at_rad.back();
  for (std::size_t i = 1; i < at_rad.size(); ++i) widest_rad = std::max(widest_rad, at_rad[i] - at_rad[i - 1]);
  return widest_rad;
}

HeadReadings SortHeads(const std::vector<Reading>& readings) {
  HeadReadings sorted;
  sorted.stops = StopsOf(readings, measure::CompareAngles(readings));
  NameMountings(sorted.stops);
  EnterRingAngles(sorted.stops);
  TakeOutMeans(sorted.stops);
  std::set<double> heads_rad;
  for (const HeadStop& stop : sorted.stops) {
    for (const HeadValue& value : stop.values) heads_rad.insert(value.head_rad);
  }
  sorted.heads_rad.assign(heads_rad.begin(), heads_rad.end());
  sorted.left_out = static_cast<int>(readings.size()) - sorted.Values();
  return sorted;
}

bool HaveHeads(const std::vector<Reading>& readings) {
  return std::ranges::any_of(readings, [](const Reading& r) { return std::isfinite(r.head_rad); });
}

}  // namespace twinbench::separate::encoder
