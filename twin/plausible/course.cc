#include "twin/plausible/checks.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>

namespace twinbench::plausible {
namespace {

constexpr double kFollows = 0.5;  // of the course, at most, is left where it is shown
constexpr double kUnlike = 0.7;   // and at least where it is not
constexpr double kLater = 0.3;    // of what is left at a reading's own place, at most, is left at the one before
constexpr double kLaterOneWay = 0.1;
constexpr double kSeen = 5.0;     // times the noise

const Channel* Named(const std::string& column, const std::vector<Channel>& channels) {
  const auto found = std::ranges::find(channels, column, [](const Channel& channel) { return channel.column->name; });
  return found == channels.end() ? nullptr : &*found;
}

bool GoesBothWays(const Channel& channel) {
  const auto goes = [&](int direction) { return std::ranges::any_of(channel.reading, [=](const Reading* r) { return r->direction == direction; }); };
  return goes(1) && goes(-1);
}

/// The course of the reading before, as an instrument shows it that answers one reading late. One way round alone a tilt to
/// another side would do the same, if it were that of the very step.
bool ComesLate(const Channel& channel, const Expected& claim, double left) {
  if (left < kSeen * claim.noise * std::sqrt(static_cast<double>(channel.size()))) return false;
  std::map<const Reading*, double> before;
  for (std::size_t i = 1; i < channel.size(); ++i) {
    if (channel.reading[i]->setup == channel.reading[i - 1]->setup)
      before[channel.reading[i]] = claim.course(*channel.reading[i - 1]);
  }
  Channel same_rows{channel.column, {}, {}};
  for (std::size_t i = 0; i < channel.size(); ++i) {
    if (!before.contains(channel.reading[i])) continue;
    same_rows.reading.push_back(channel.reading[i]);
    same_rows.value.push_back(channel.value[i]);
  }
  Expected late = claim;
  late.course = [&before](const Reading& reading) { return before.at(&reading); };
  return SpreadAbout(same_rows, late).left < (GoesBothWays(channel) ? kLater : kLaterOneWay) * left;
}

}  // namespace

CourseSpread SpreadAbout(const Channel& channel, const Expected& claim) {
  std::map<int, std::vector<Eigen::Array3d>> setups;  // shown, expected, left
  for (std::size_t i = 0; i < channel.size(); ++i) {
    const double course = claim.course(*channel.reading[i]);
    if (std::isfinite(course))
      setups[channel.reading[i]->setup].emplace_back(channel.value[i], course, channel.value[i] - course);
  }
  Eigen::Array3d all = Eigen::Array3d::Zero();
  for (const auto& [setup, rows] : setups) {
    Eigen::Array3d mean = Eigen::Array3d::Zero(), squares = Eigen::Array3d::Zero();
    const double count = static_cast<double>(rows.size());
    for (const Eigen::Array3d& row : rows) mean += row / count;
    for (const Eigen::Array3d& row : rows) squares += (row - mean).square();
    if (std::sqrt(squares[1] / count) > kMuch * claim.noise) all += squares;
  }
  return {std::sqrt(all[0]), std::sqrt(all[1]), std::sqrt(all[2])};
}

void CheckCourse(const Expected& claim, const std::vector<Channel>& channels, std::vector<Finding>& findings) {
  const Channel* own = Named(claim.column, channels);
  if (own == nullptr || own->size() < kFewestToJudge) return;
  const CourseSpread here = SpreadAbout(*own, claim);
  if (!(here.expected > 0.0)) return;
  if (ComesLate(*own, claim, here.left))
    findings.push_back({false, fmt::format("{} is what the scenario says of the reading before: does the instrument answer one "
                                           "reading late?",
                                           claim.column)});
  if (here.left < kUnlike * here.expected) return;
  const Channel* other = Named(claim.not_in, channels);
  if (other != nullptr && SpreadAbout(*other, claim).left < kFollows * here.expected) {
    findings.push_back({true, fmt::format("{} shows what the scenario says of {}, which does not: are the two exchanged?",
                                          claim.not_in, claim.column)});
    return;
  }
  Expected reversed = claim;
  reversed.course = [&claim](const Reading& reading) { return -claim.course(reading); };
  if (SpreadAbout(*own, reversed).left < kFollows * here.expected)
    findings.push_back({false, fmt::format("{} goes the other way than the scenario says: is a sign another, or what was "
                                           "mounted turned by half a turn?",
                                           claim.column)});
}

}  // namespace twinbench::plausible
