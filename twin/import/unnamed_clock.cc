#include "twin/import/unnamed_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "twin/import/clock.h"
#include "twin/import/common.h"
#include "twin/import/companions.h"

namespace twinbench::imports {
namespace {

constexpr std::size_t kFewestOfAClock = 12;

/// The usual step of a column that rises strictly, each step within `off` of the usual one; 0: it does not.
double StepWithin(double off, const std::vector<double>& values) {
  const std::vector<double> steps = StepsOf(values);
  if (steps.size() + 1 != values.size() || values.size() < kFewestOfAClock) return 0.0;
  const double usual = MedianOf(steps);
  const bool all = usual > 0.0 && std::ranges::all_of(steps, [&](double step) { return step > 0.0 && std::abs(step - usual) <= off * usual; });
  return all ? usual : 0.0;
}

bool FirstIsAngle(const Track& track) {
  const Column& first = track.columns.front();
  return std::any_of(track.columns.begin() + 1, track.columns.end(), [&first](const Column& other) { return other.IsNumber() && GoTogether(first, other); });
}

/// Of a column that rises evenly, up to the rounding of its last digit, or in seconds since 1970, say; or as evenly as a computer logs,
/// if it is not itself an angle that goes with the others.
double StepOfClock(const Track& track) {
  constexpr double kEqual = 0.02, kLogged = 0.9;
  const std::vector<double>& values = track.columns.front().value;
  if (const auto clock = ClockOf(values, ""); clock && clock->absolute) return StepWithin(std::numeric_limits<double>::infinity(), values);
  const double step = StepWithin(kEqual, track.columns.front().value);
  return step > 0.0 ? step : FirstIsAngle(track) ? 0.0 : StepWithin(kLogged, track.columns.front().value);
}

/// Of what two files have in common: there may be gaps, but not an angle that the second column shows.
double StepOfSharedClock(const Track& track) {
  return FirstIsAngle(track) ? 0.0 : StepWithin(std::numeric_limits<double>::infinity(), track.columns.front().value);
}

/// Two columns that go together one to one: the reference and the device are there already.
bool TwoOthersFollow(const Track& track) {
  for (std::size_t a = 1; a < track.columns.size(); ++a) {
    for (std::size_t b = a + 1; b < track.columns.size(); ++b) {
      const Column &first = track.columns[a], &second = track.columns[b];
      if (first.IsNumber() && second.IsNumber() && GoTogether(first, second)) return true;
    }
  }
  return false;
}

/// Two files of one quantity each begin with the same column: they were written at the same instants.
bool IsShared(const std::vector<Recording>& recordings) {
  const auto is_table = [](const Recording& r) { return r.tracks.size() == 1 && r.tracks[0].columns.size() == 2; };
  return recordings.size() == 2 && std::ranges::all_of(recordings, is_table) &&
         recordings[0].tracks[0].columns.front().value == recordings[1].tracks[0].columns.front().value;
}

bool IsSpokenOf(const std::string& name, const Map& map) {
  return std::ranges::any_of(map.columns, [&name](const MappedColumn& c) { return c.expression.find(name) != std::string::npos; });
}

NumberClock ClockByStep(const std::vector<double>& values, double step) {
  const NumberClock by_size = *ClockOf(values, "");
  if (by_size.absolute) return by_size;
  return *ClockOf(values, step != std::round(step) ? "s" : step < 1000.0 ? "ms" : "us");
}

void Take(Track& track, double step, Recording& recording) {
  const Column column = std::move(track.columns.front());
  track.columns.erase(track.columns.begin());
  if (step == 1.0) {
    recording.remarks.push_back(fmt::format("\"{0}\" rises by one from row to row: it counts the rows; --column 'time_s=[{0}]' makes it a clock", column.name));
    return;
  }
  const NumberClock clock = ClockByStep(column.value, step);
  track.time_s = column.value;
  for (double& t : track.time_s) t = (t - clock.origin) * clock.to_s;
  track.absolute = clock.absolute;
  track.clock = fmt::format("{} [{}]", column.name, clock.words);
  recording.remarks.push_back(fmt::format("\"{0}\" rises in steps of {1:.6g}: it is taken as a clock in {2}; --column 'time_s=[{0}]' says another unit", column.name,
                                          step, clock.words));
}

}  // namespace

void TakeUnnamedClock(const Map& map, std::vector<Recording>& recordings) {
  if (!map.clock.column.empty() || map.clock.rate_Hz > 0.0) return;
  const bool is_shared = IsShared(recordings);
  for (Recording& recording : recordings) {
    for (Track& track : recording.tracks) {
      if (track.HasClock() || track.columns.size() < 2) continue;
      const Column& first = track.columns.front();
      if (first.name != "column 1" || !first.IsNumber() || IsSpokenOf(first.name, map)) continue;
      const double step = is_shared ? StepOfSharedClock(track) : StepOfClock(track);
      if (step > 0.0 && (is_shared || TwoOthersFollow(track))) Take(track, step, recording);
    }
  }
}

}  // namespace twinbench::imports
