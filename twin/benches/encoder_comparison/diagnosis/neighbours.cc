#include "twin/benches/encoder_comparison/diagnosis/neighbours.h"

#include <algorithm>
#include <cmath>

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
  std::vector<Reading> read;
  std::ranges::copy_if(readings, std::back_inserter(read), IsRead);
  const std::size_t every = (read.size() + enough / 2) / enough;
  if (every < 2 || HasClock(read) || !GoOneWay(read)) return {};
  std::vector<Reading> means;
  for (auto begin = read.cbegin(); begin != read.cend();) {
    const auto most = begin + static_cast<std::ptrdiff_t>(
                                  std::min<std::size_t>(every, static_cast<std::size_t>(read.cend() - begin)));
    const auto end = std::find_if(
        begin, most, [&](const Reading& r) { return r.pass != begin->pass || r.setup != begin->setup; });
    means.push_back(MeanOf(begin, end));
    begin = end;
  }
  return means;
}

}  // namespace twinbench::diagnose::encoder
