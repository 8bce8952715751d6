#include "twin/benches/circular_motion/estimators/far_radii.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "twin/benches/circular_motion/columns.h"
#include "twin/core/units.h"

namespace twinbench::separate::circular {

std::vector<FarOnCourse> TakeOutFar(std::vector<Reading>& readings) {
  constexpr double kLeast_m = 1e-9, kBehindReversal = 5.0;  // steps
  std::map<std::pair<int, int>, std::map<int, std::vector<OnCourse>>> that_way;  // set-up and direction; pass
  for (const Reading& r : readings) {
    const double radius_m = benches::circular::DeviationOf(r).radial_m;
    if (r.status == ReadingStatus::kOk && std::isfinite(radius_m)) that_way[{r.setup, r.direction}][r.pass].push_back({r.reading, r.target_rad, radius_m});
  }
  const auto turns_round = [](double angle_rad, double step_rad) {
    return std::abs(std::remainder(angle_rad, 0.5 * units::kPi)) < kBehindReversal * step_rad;
  };
  std::vector<FarOnCourse> far;
  for (auto& [way, by_pass] : that_way) {
    std::vector<std::vector<OnCourse>> passes;
    for (auto& [number, pass] : by_pass) passes.push_back(std::move(pass));
    std::ranges::copy(FarOnCourses(std::move(passes), kLeast_m, turns_round), std::back_inserter(far));
  }
  std::set<int> numbers;
  for (const FarOnCourse& one : far) numbers.insert(one.reading);
  std::erase_if(readings, [&](const Reading& r) { return numbers.contains(r.reading); });
  return far;
}

}  // namespace twinbench::separate::circular
