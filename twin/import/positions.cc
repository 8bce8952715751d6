#include <algorithm>
#include <vector>

#include "twin/import/make_readings.h"

namespace twinbench::imports {

void NumberPositions(std::vector<Reading>& readings, const ReadingColumn& reference) {
  std::vector<double> places;
  for (Reading& reading : readings) places.push_back(reference.number(reading));
  std::vector<double> sorted = places;
  std::ranges::sort(sorted);
  std::vector<double> steps;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] - sorted[i - 1] > 1e-9) steps.push_back(sorted[i] - sorted[i - 1]);
  }
  if (steps.empty()) {
    for (Reading& reading : readings) reading.position = 0;
    return;
  }
  const double largest = std::ranges::max(steps);
  std::erase_if(steps, [largest](double step) { return step < 0.05 * largest; });  // within a stop
  const double same = 0.25 * std::ranges::min(steps);
  std::vector<double> stops;
  for (const double place : sorted) {
    if (stops.empty() || place - stops.back() > same) stops.push_back(place);
  }
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const auto above = std::ranges::upper_bound(stops, places[i]);
    readings[i].position = static_cast<int>(above - stops.begin()) - 1;
  }
}

}  // namespace twinbench::imports
