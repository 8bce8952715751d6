#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "twin/benches/encoder_comparison/estimators/angle_comparison.h"
#include "twin/benches/encoder_comparison/estimators/iso230_2.h"
#include "twin/core/units.h"
#include "twin/separate/mean.h"

namespace twinbench::measure {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using separate::Mean;

/// The readings at one position.
struct Stop {
  double first_rad = kNaN;                        // where the reference stood; the others count from here
  Mean offset_rad;                                // of the reference from first_rad
  double low_rad = 0.0, high_rad = 0.0;           // of that offset
  std::map<int, Mean> forward_rad, backward_rad;  // deviations by pass

  double Width() const { return high_rad - low_rad; }
};

bool StandsStill(const Reading& reading) {
  return reading.direction != 0 && !(std::abs(reading.velocity_rad_s) > 0.0);  // an unknown velocity passes
}

void Add(const Reading& reading, double deviation_rad, Stop& stop) {
  if (stop.offset_rad.count == 0) stop.first_rad = reading.reference_rad;
  const double offset_rad = std::remainder(reading.reference_rad - stop.first_rad, 2.0 * units::kPi);
  stop.offset_rad.Add(offset_rad);
  stop.low_rad = std::min(stop.low_rad, offset_rad);
  stop.high_rad = std::max(stop.high_rad, offset_rad);
  (reading.direction > 0 ? stop.forward_rad : stop.backward_rad)[reading.pass].Add(deviation_rad);
}

std::vector<double> Runs(const std::map<int, Mean>& passes) {
  std::vector<double> runs;
  runs.reserve(passes.size());
  for (const auto& [pass, mean] : passes) runs.push_back(mean.Value());
  return runs;
}

PositioningTarget TargetOf(const Stop& stop) {
  return {stop.first_rad + stop.offset_rad.Value(), Runs(stop.forward_rad), Runs(stop.backward_rad)};
}

void Append(const std::vector<double>& more, std::vector<double>& runs) {
  runs.insert(runs.end(), more.begin(), more.end());
}

/// Some number their readings instead of their stops: within a hundredth of the mean spacing it is one target.
std::vector<PositioningTarget> Merged(const std::vector<PositioningTarget>& by_position) {
  if (by_position.empty()) return {};
  const double span_rad = by_position.back().position - by_position.front().position;
  const double same_rad = 0.01 * span_rad / static_cast<double>(by_position.size());
  std::vector<PositioningTarget> merged = {by_position.front()};
  for (std::size_t i = 1; i < by_position.size(); ++i) {
    if (by_position[i].position - merged.back().position > same_rad) {
      merged.push_back(by_position[i]);
      continue;
    }
    Append(by_position[i].forward, merged.back().forward);
    Append(by_position[i].backward, merged.back().backward);
  }
  return merged;
}

double SmallestSpacing(const std::vector<PositioningTarget>& by_position) {
  double spacing = kInfinity;
  for (std::size_t i = 1; i < by_position.size(); ++i)
    spacing = std::min(spacing, by_position[i].position - by_position[i - 1].position);
  return spacing;
}

/// A reading further from its target than half way to the next one belongs to no target.
std::vector<std::string> NotesOn(const std::map<int, Stop>& stops, double spacing_rad) {
  std::vector<std::string> notes;
  for (const auto& [position, stop] : stops) {
    if (stop.Width() <= 0.5 * spacing_rad) continue;
    notes.push_back(fmt::format("readings of position {} lie up to {:.4g} deg apart: not measuring positions of one target",
                                position, stop.Width() / units::deg));
  }
  return notes;
}

int TargetsNeeded(double travel_rad) {
  const double travel_deg = travel_rad / units::deg * (1.0 - 1e-12);  // 90 deg in rad may round upwards
  if (travel_deg <= 90.0) return 3;
  return travel_deg <= 180.0 ? 5 : 8;
}

using RunsOf = std::vector<double> PositioningTarget::*;

std::vector<std::string> MissingRuns(const std::vector<PositioningTarget>& targets, RunsOf runs_of,
                                     const char* direction, const ToldIn& told) {
  constexpr std::size_t kRunsNeeded = 5;
  const auto fewest = std::ranges::min_element(
      targets, {}, [runs_of](const PositioningTarget& target) { return (target.*runs_of).size(); });
  if (fewest == targets.end() || ((*fewest).*runs_of).size() >= kRunsNeeded) return {};
  return {fmt::format("{} {} runs to the target at {:.4g} {}; ISO 230-2 wants {}", ((*fewest).*runs_of).size(),
                      direction, fewest->position / told.coarse, told.coarse_name, kRunsNeeded)};
}

void AppendMissingRuns(const std::vector<PositioningTarget>& targets, const ToldIn& told,
                       std::vector<std::string>& missing) {
  for (const auto& text : MissingRuns(targets, &PositioningTarget::forward, "forward", told))
    missing.push_back(text);
  for (const auto& text : MissingRuns(targets, &PositioningTarget::backward, "backward", told))
    missing.push_back(text);
}

}  // namespace

PositioningStops PositioningOf(const std::vector<Reading>& readings, int setup) {
  const AngleComparison comparison = CompareAngles(readings);
  PositioningStops result;
  result.left_out = static_cast<int>(std::ranges::count(readings, setup, &Reading::setup));
  std::map<int, Stop> stops;
  for (std::size_t i = 0; i < comparison.used.size(); ++i) {
    const Reading& reading = readings[static_cast<std::size_t>(comparison.used[i])];
    if (reading.setup != setup || !StandsStill(reading)) continue;
    Add(reading, comparison.error_rad[static_cast<Eigen::Index>(i)], stops[reading.position]);
    --result.left_out;
  }
  for (const auto& [position, stop] : stops) result.targets.push_back(TargetOf(stop));
  std::ranges::sort(result.targets, {}, &PositioningTarget::position);
  result.targets = Merged(result.targets);
  result.notes = NotesOn(stops, SmallestSpacing(result.targets));
  return result;
}

std::vector<std::string> MissingForRotaryAxis(const std::vector<PositioningTarget>& targets, double travel_rad) {
  std::vector<std::string> missing;
  const int needed = TargetsNeeded(travel_rad);
  if (std::ssize(targets) < needed)
    missing.push_back(fmt::format("{} targets for {:.4g} deg of travel; ISO 230-2 wants {}", targets.size(),
                                  travel_rad / units::deg, needed));
  AppendMissingRuns(targets, {}, missing);
  return missing;
}

std::vector<std::string> MissingForLinearAxis(const std::vector<PositioningTarget>& targets, double travel_m,
                                              const ToldIn& told) {
  std::vector<std::string> missing;
  const int needed = std::max(5, static_cast<int>(std::ceil(5.0 * std::min(travel_m, 2.0) - 1e-9)));
  if (std::ssize(targets) < needed)
    missing.push_back(fmt::format("{} targets for {:.4g} mm of travel; ISO 230-2 wants {}", targets.size(),
                                  travel_m / units::mm, needed));
  AppendMissingRuns(targets, told, missing);
  return missing;
}

}  // namespace twinbench::measure
