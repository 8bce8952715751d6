#include "twin/benches/encoder_comparison/diagnosis/part_of_readings.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace twinbench::diagnose::encoder {
namespace {

constexpr std::size_t kEnoughReadings = 4000, kInARow = 16;

bool BeginsPass(const std::vector<Reading>& readings, std::size_t i) {
  return i == 0 || readings[i].pass != readings[i - 1].pass || readings[i].setup != readings[i - 1].setup;
}

/// Which of the groups of a block is taken: at equal distances an order would look like one that is as many groups higher.
std::size_t TakenOf(std::size_t block, std::size_t every) {
  return block == 0 ? 0 : std::mt19937_64(block)() % every;
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
  bool is_taken = true;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    in_pass = BeginsPass(readings, i) ? 0 : in_pass + 1;
    const std::size_t group = in_pass / kInARow, block = group / every;
    if (in_pass % kInARow == 0) is_taken = group % every == TakenOf(block, every);
    if (is_taken || is_about(readings[i])) part.push_back(readings[i]);
  }
  return part;
}

}  // namespace twinbench::diagnose::encoder
