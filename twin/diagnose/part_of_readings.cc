#include "twin/diagnose/part_of_readings.h"

#include <random>
#include <set>

namespace twinbench::diagnose {
namespace {

constexpr std::size_t kInARow = 16;

bool BeginsPass(const std::vector<Reading>& readings, std::size_t i) {
  return i == 0 || readings[i].pass != readings[i - 1].pass || readings[i].setup != readings[i - 1].setup;
}

/// Which of the groups of a block is taken: at equal distances an order would look like one that is as many groups higher.
std::size_t TakenOf(std::size_t block, std::size_t every) {
  return block == 0 ? 0 : std::mt19937_64(block)() % every;
}

}  // namespace

std::vector<Reading> PartOf(const std::vector<Reading>& readings, const PartWanted& wanted) {
  const std::size_t every = (readings.size() + wanted.enough / 2) / wanted.enough;
  if (every < 2) return readings;
  const auto about = static_cast<double>(wanted.about > 0 ? wanted.about : 2 * every * kInARow);
  const std::set<double> events(wanted.events.begin(), wanted.events.end());
  const auto is_about = [&](const Reading& r) {
    const auto next = events.lower_bound(r.reading - about);
    return next != events.end() && *next <= r.reading + about;
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

}  // namespace twinbench::diagnose
