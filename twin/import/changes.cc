#include "twin/import/layouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "twin/core/errors.h"
#include "twin/import/clock.h"
#include "twin/import/text.h"

namespace twinbench::imports {
namespace {

struct Change {
  std::string_view name;
  double time_s = 0.0, value = 0.0;
};

enum class Line { kChange, kMessage, kArray, kOther };

bool IsArray(const std::vector<std::string_view>& fields, double first) {
  return first > 1.0 && fields.size() > 5 && static_cast<double>(fields.size()) == first + 4.0;
}

Line Understand(std::string_view line, std::vector<std::string_view>& fields, Change& change) {
  Split(line, ' ', fields);
  if (fields.empty()) return Line::kOther;
  if (line.find("***") != std::string_view::npos) return Line::kMessage;
  if (fields.size() < 4) return Line::kOther;
  // The client's own stamps (-t c) stand in brackets.
  const std::string_view date = fields[1].starts_with('(') ? fields[1].substr(1) : fields[1];
  const std::string_view clock = fields[2].ends_with(')') ? fields[2].substr(0, fields[2].size() - 1) : fields[2];
  const auto day = ParseInstant(date), time = ParseInstant(clock);
  const auto value = FieldNumber(fields[3], false);
  if (!day || !day->has_date || !time || !value) return Line::kOther;
  if (IsArray(fields, *value)) return Line::kArray;
  change = {fields[0], day->time_s + time->time_s, *value};
  return Line::kChange;
}

Track& TrackOf(std::string_view name, Recording& recording) {
  const auto found =
      std::ranges::find_if(recording.tracks, [name](const Track& track) { return track.columns[0].name == name; });
  if (found != recording.tracks.end()) return *found;
  Track track;
  track.name = std::string(name);
  track.clock = "the stamp of each change";
  track.absolute = track.on_change = true;
  track.columns.push_back({std::string(name), "", {}, {}});
  recording.tracks.push_back(std::move(track));
  return recording.tracks.back();
}

/// Stamps of one channel that come out of order.
void Sort(Track& track, Recording& recording) {
  if (std::ranges::is_sorted(track.time_s)) return;
  std::vector<std::size_t> order(track.time_s.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&track](std::size_t i) { return track.time_s[i]; });
  std::vector<double> time_s, value;
  for (const std::size_t i : order) {
    time_s.push_back(track.time_s[i]);
    value.push_back(track.columns[0].value[i]);
  }
  track.time_s = std::move(time_s);
  track.columns[0].value = std::move(value);
  recording.remarks.push_back(fmt::format("stamps of {} go back: its changes were put in order", track.name));
}

/// The first line of a channel has the stamp of its last change before the recording, which may be days old.
void MoveFirstValues(Recording& recording) {
  double start_s = std::numeric_limits<double>::infinity();
  for (const Track& track : recording.tracks) {
    if (track.time_s.size() > 1) start_s = std::min(start_s, track.time_s[1]);
  }
  if (!std::isfinite(start_s)) return;
  int moved = 0;
  for (Track& track : recording.tracks) {
    if (track.time_s.front() >= start_s - 1.0) continue;
    ++moved;
    if (track.time_s.size() > 1 && track.time_s[1] <= start_s) {  // it was told anew at once
      track.time_s.erase(track.time_s.begin());
      track.columns[0].value.erase(track.columns[0].value.begin());
    } else {
      track.time_s.front() = start_s;
    }
  }
  if (moved > 0)
    recording.remarks.push_back(
        fmt::format("{} channels open with a value from before the recording: it counts from the start", moved));
}

}  // namespace

void ReadChanges(std::string_view text, Recording& recording) {
  Lines lines(text);
  std::vector<std::string_view> fields;
  Change change;
  std::size_t messages = 0, arrays = 0, others = 0;
  for (std::string_view line; lines.Next(line);) {
    switch (Understand(line, fields, change)) {
      case Line::kChange: {
        Track& track = TrackOf(change.name, recording);
        track.time_s.push_back(change.time_s);
        track.columns[0].value.push_back(change.value);
        break;
      }
      case Line::kMessage:
        ++messages;
        break;
      case Line::kArray:
        ++arrays;
        break;
      case Line::kOther:
        others += Trimmed(line).empty() ? 0 : 1;
        break;
    }
  }
  recording.layout = "one change a line: name, date, time, value (camonitor)";
  if (recording.tracks.empty())
    throw InputError(recording.file, "no line has a name, a date, a time and a number",
                     "lines as camonitor writes them");
  for (Track& track : recording.tracks) Sort(track, recording);
  MoveFirstValues(recording);
  if (messages > 0) recording.left_out.push_back({messages, "lines that tell of a lost connection or an error"});
  if (arrays > 0) recording.left_out.push_back({arrays, "lines with an array"});
  if (others > 0) recording.left_out.push_back({others, "lines without a number"});
}

}  // namespace twinbench::imports
