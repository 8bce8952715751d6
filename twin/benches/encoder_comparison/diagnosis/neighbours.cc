#include "twin/benches/encoder_comparison/diagnosis/neighbours.h"

#include <algorithm>
#include <cmath>

#include "twin/core/distributions.h"
#include "twin/core/reading_clock.h"
#include "twin/core/units.h"

namespace twinbench::diagnose::encoder {
namespace {

bool IsRead(const Reading& r) {
  return r.status == ReadingStatus::kOk && std::isfinite(r.reference_rad) && std::isfinite(r.measured_rad);
}

bool GoOneWay(const std::vector<Reading>& readings) {
  return std::ranges::all_of(
      readings, [&](const Reading& r) { return r.direction == readings.front().direction && r.direction != 0; });
}

/// Of errors, so that a device that begins anew at a turn may do so among them.
Reading MeanOf(std::vector<Reading>::const_iterator begin, std::vector<Reading>::const_iterator end) {
  Reading mean = *begin;
  const double first_rad = begin->measured_rad - begin->reference_rad;
  double reference_rad = 0.0, error_rad = 0.0;
  for (auto r = begin; r != end; ++r) {
    reference_rad += r->reference_rad;
    error_rad += std::remainder(r->measured_rad - r->reference_rad - first_rad, units::turn);
  }
  const auto count = static_cast<double>(end - begin);
  mean.reference_rad = reference_rad / count;
  mean.measured_rad = mean.reference_rad + first_rad + error_rad / count;
  return mean;
}

}  // namespace

std::vector<Reading> MeansOfNeighbours(const std::vector<Reading>& readings, std::size_t enough) {
  constexpr double kGap = 4.0;  // usual steps
  const std::size_t every = (readings.size() + enough / 2) / enough;
  if (every < 2 || HasClock(readings) || !GoOneWay(readings) || !std::ranges::all_of(readings, IsRead)) return {};
  std::vector<double> step_rad;
  for (std::size_t i = 1; i < readings.size(); ++i)
    step_rad.push_back(std::abs(readings[i].reference_rad - readings[i - 1].reference_rad));
  const double usual_rad = Median(step_rad);
  if (!(usual_rad > 0.0)) return {};  // places that are read again and again
  std::vector<Reading> means;
  for (std::size_t begin = 0, end = 1; begin < readings.size(); begin = end++) {
    const Reading& first = readings[begin];
    const auto goes_on = [&](std::size_t i) {
      return readings[i].pass == first.pass && readings[i].setup == first.setup &&
             step_rad[i - 1] < kGap * usual_rad;
    };
    while (end < std::min(begin + every, readings.size()) && goes_on(end)) ++end;
    means.push_back(MeanOf(readings.begin() + static_cast<std::ptrdiff_t>(begin),
                           readings.begin() + static_cast<std::ptrdiff_t>(end)));
  }
  return means;
}

}  // namespace twinbench::diagnose::encoder
