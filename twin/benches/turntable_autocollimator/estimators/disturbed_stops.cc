#include "twin/benches/turntable_autocollimator/estimators/disturbed_stops.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "twin/core/distributions.h"
#include "twin/core/robust_scale.h"

namespace twinbench::separate::turntable {
namespace {

constexpr double kTimesOthers = 8.0;  // no tail of a noise that has a standard deviation
constexpr double kFew = 0.02;
constexpr std::size_t kFewestVisits = 3;
constexpr std::size_t kFewestToJudge = 12;

using Visits = std::vector<std::size_t>;  // grid stops of one place

std::vector<Visits> PlacesMetOften(const StopGrid& grid) {
  std::map<std::tuple<int, int, int>, Visits> places;
  for (std::size_t i = 0; i < grid.stops.size(); ++i) places[{grid.stops[i].setup, grid.stops[i].position, grid.stops[i].tooth}].push_back(i);
  std::vector<Visits> often;
  for (auto& [place, visits] : places)
    if (visits.size() >= kFewestVisits) often.push_back(std::move(visits));
  return often;
}

std::vector<double> OthersOf(const Visits& visits, std::size_t own, const std::vector<double>& x_rad) {
  std::vector<double> others;
  for (const std::size_t k : visits)
    if (k != own) others.push_back(x_rad[k]);
  return others;
}

/// The least that two readings of a place differ by: coarse ones are all the same, or that far apart.
double Step_rad(const std::vector<Visits>& places, const std::vector<double>& x_rad) {
  constexpr double kSame_rad = 1e-12;
  double step_rad = INFINITY;
  for (const Visits& visits : places)
    for (const std::size_t i : visits)
      for (const std::size_t k : visits)
        if (const double apart_rad = std::abs(x_rad[i] - x_rad[k]); apart_rad > kSame_rad) step_rad = std::min(step_rad, apart_rad);
  return std::isfinite(step_rad) ? step_rad : 0.0;
}

/// Less what its pass shows beyond the middle of each place, in its middle.
void TakeOutPasses(const std::vector<TurntableStop>& stops, const StopGrid& grid, const std::vector<Visits>& places, std::vector<double>& x_rad) {
  using Pass = std::pair<int, int>;
  const auto pass_of = [&](std::size_t i) { return Pass{stops[grid.stops[i].stop].setup, stops[grid.stops[i].stop].pass}; };
  std::map<Pass, std::vector<double>> beyond;
  for (const Visits& visits : places) {
    std::vector<double> all;
    for (const std::size_t i : visits) all.push_back(x_rad[i]);
    const double middle_rad = Median(std::move(all));
    for (const std::size_t i : visits) beyond[pass_of(i)].push_back(x_rad[i] - middle_rad);
  }
  std::map<Pass, double> offset_rad;
  for (auto& [pass, values] : beyond) offset_rad[pass] = Median(std::move(values));
  for (const Visits& visits : places)
    for (const std::size_t i : visits) x_rad[i] -= offset_rad.at(pass_of(i));
}

}  // namespace

std::vector<DisturbedStop> DisturbedStops(const std::vector<TurntableStop>& stops, const StopGrid& grid, double noise_rad) {
  const std::vector<Visits> places = PlacesMetOften(grid);
  std::vector<double> x_rad, sizes_rad;
  for (const GridStop& g : grid.stops) x_rad.push_back(stops[g.stop].x_rad);
  const double step_rad = Step_rad(places, x_rad);
  TakeOutPasses(stops, grid, places, x_rad);
  const auto beside_rad = [&x_rad](const Visits& visits, std::size_t i) { return std::abs(x_rad[i] - Median(OthersOf(visits, i, x_rad))); };
  for (const Visits& visits : places)
    for (const std::size_t i : visits) sizes_rad.push_back(beside_rad(visits, i));
  if (sizes_rad.size() < kFewestToJudge) return {};
  const double judged = static_cast<double>(sizes_rad.size()), usual_rad = std::max({RobustDeviation(std::move(sizes_rad)), noise_rad, step_rad});
  std::vector<DisturbedStop> disturbed;
  for (const Visits& visits : places) {
    for (const std::size_t i : visits) {
      const std::vector<double> others = OthersOf(visits, i, x_rad);
      const auto [least, most] = std::ranges::minmax(others);
      if (most - least < kTimesOthers * usual_rad && beside_rad(visits, i) > kTimesOthers * usual_rad)
        disturbed.push_back({grid.stops[i].stop, beside_rad(visits, i) / usual_rad});
    }
  }
  if (static_cast<double>(disturbed.size()) > std::max(1.0, kFew * judged)) return {};
  return disturbed;
}

}  // namespace twinbench::separate::turntable
