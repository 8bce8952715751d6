#include "twin/benches/encoder_comparison/diagnosis/part_of_readings.h"

#include <algorithm>
#include <cmath>

namespace twinbench::diagnose::encoder {
namespace {

constexpr std::size_t kEnoughReadings = 4000, kInARow = 16;

bool BeginsPass(const std::vector<Reading>& readings, std::size_t i) {
  return i == 0 || readings[i].pass != readings[i - 1].pass || readings[i].setup != readings[i - 1].setup;
}

}  // namespace

std::vector<Reading> PartOf(const std::vector<Reading>& readings, const std::vector<double>& events) {
  const std::size_t every = (readings.size() + kEnoughReadings / 2) / kEnoughReadings;
  if (every < 2) return readings;
  const auto about_group = static_cast<double>(2 * every * kInARow);
  const auto is_about = [&](const Reading& r) {
    return std::ranges::any_of(events, [&](double event) { return std::abs(r.reading - event) <= about_group; });
  };
  std::vector<Reading> part;
  std::size_t in_pass = 0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    in_pass = BeginsPass(readings, i) ? 0 : in_pass + 1;
    if (in_pass / kInARow % every == 0 || is_about(readings[i])) part.push_back(readings[i]);
  }
  return part;
}

}  // namespace twinbench::diagnose::encoder
