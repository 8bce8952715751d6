#include "twin/import/layouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <limits>

#include "twin/core/errors.h"
#include "twin/core/reading.h"
#include "twin/import/clock.h"
#include "twin/import/common.h"
#include "twin/import/text.h"

namespace twinbench::imports {
namespace {

char SeparatorOf(std::string_view text) {
  const std::size_t name = text.find("Name");
  return name == std::string_view::npos || name + 4 >= text.size() ? '\t' : text[name + 4];
}

bool IsNumberInScope(std::string_view field) {
  return FieldNumber(field, false).has_value() || FieldNumber(field, true).has_value();
}

/// A group of channels with one time: where its time stands in a row.
struct ChannelGroup {
  std::size_t time = 0;
  std::size_t end = 0;
};

class ScopeReader {
 public:
  ScopeReader(std::string_view text, Recording& recording)
      : text_(text), recording_(recording), separator_(SeparatorOf(text)) {}

  void Read() {
    Lines lines(text_);
    for (std::string_view line; lines.Next(line);) TakeLine(line);
    if (groups_.empty())
      throw InputError(recording_.file, "no row of channel names that begins with Name",
                       "the text export of a scope");
    if (rows_ == 0) throw InputError(recording_.file, "there is no row of numbers", "the text export of a scope");
    for (Track& track : recording_.tracks) Finish(track);
    std::erase_if(recording_.tracks, [](const Track& track) { return track.Rows() == 0; });
    recording_.layout =
        fmt::format("a TwinCAT scope export, {} between fields, {} groups of channels with a clock each",
                    SeparatorName(separator_), groups_.size());
    if (repeated_ > 0) recording_.left_out.push_back({repeated_, "samples that repeat an earlier time"});
    if (others_ > 0) recording_.left_out.push_back({others_, "lines that are no rows"});
  }

 private:
  void TakeLine(std::string_view line) {
    if (Trimmed(line).empty()) return;
    Split(line, separator_, fields_);
    if (!groups_.empty() && (IsNumberInScope(fields_[0]) || fields_[0].empty())) return TakeRow();
    if (fields_[0] == "Starttime of export" && fields_.size() > 1) return TakeStart();
    if (fields_[0] == "Name") return TakeNames();
    if (fields_[0] == "Unit" && !groups_.empty()) return TakeUnits();
    if (rows_ > 0 && fields_[0] != "EOF") ++others_;
  }

  void TakeStart() {
    if (const auto start = FieldNumber(fields_[1], false)) start_s_ = (*start - kFileTimeOf1970) * 1e-7;
  }

  /// The first line of a file with a full head is called Name too: the last one above the rows counts.
  void TakeNames() {
    groups_.clear();
    recording_.tracks.clear();
    while (fields_.size() > 2 && fields_.back().empty()) fields_.pop_back();
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (fields_[i] == "Name") {
        groups_.push_back({i, i + 1});
        recording_.tracks.emplace_back();
        continue;
      }
      recording_.tracks.back().columns.push_back({std::string(fields_[i]), "", {}, {}});
      groups_.back().end = i + 1;
    }
  }

  /// "V (Voltage)", "(None)"
  void TakeUnits() {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      for (std::size_t i = groups_[g].time + 1; i < std::min(groups_[g].end, fields_.size()); ++i) {
        const std::string_view unit = fields_[i].substr(0, fields_[i].find(' '));
        if (unit != "(None)") recording_.tracks[g].columns[i - groups_[g].time - 1].unit = std::string(unit);
      }
    }
  }

  double At(std::size_t i) {
    if (i >= fields_.size() || fields_[i].empty()) return kNaN;
    if (const auto number = FieldNumber(fields_[i], decimal_comma_)) return *number;
    if (const auto number = FieldNumber(fields_[i], !decimal_comma_)) {
      decimal_comma_ = !decimal_comma_;
      return *number;
    }
    if (fields_[i] == "True" || fields_[i] == "TRUE") return 1.0;
    return fields_[i] == "False" || fields_[i] == "FALSE" ? 0.0 : kNaN;
  }

  void TakeRow() {
    ++rows_;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      Track& track = recording_.tracks[g];
      const double time_s = 1e-3 * At(groups_[g].time);
      if (!std::isfinite(time_s)) continue;
      if (!track.time_s.empty() &&
          time_s == track.time_s.back()) {  // a slow group is filled up to the rows of a fast one
        ++repeated_;
        continue;
      }
      track.time_s.push_back(time_s);
      for (std::size_t c = 0; c < track.columns.size(); ++c)
        track.columns[c].value.push_back(At(groups_[g].time + 1 + c));
    }
  }

  void Finish(Track& track) {
    track.name = track.columns.empty() ? "" : track.columns[0].name;
    track.clock = "time of its group [ms]";
    if (TakeFileTimes(track)) return;
    if (start_s_ == 0.0) return;
    track.clock += ", from the start of the export [Windows file time]";
    track.absolute = true;
    for (double& t : track.time_s) t += start_s_;
  }

  /// Some exports stamp every row with the Windows file time.
  static bool TakeFileTimes(Track& track) {
    const auto clock = track.time_s.empty() ? std::nullopt : ClockOf({1e3 * track.time_s[0]}, "");
    if (!clock || !clock->absolute || clock->origin == 0.0) return false;
    for (double& t : track.time_s) t = (1e3 * t - clock->origin) * clock->to_s;
    track.clock = "time of its group [Windows file time]";
    track.absolute = true;
    return true;
  }

  std::string_view text_;
  Recording& recording_;
  char separator_;
  std::vector<std::string_view> fields_;
  std::vector<ChannelGroup> groups_;
  bool decimal_comma_ = false;
  double start_s_ = 0.0;
  std::size_t rows_ = 0, repeated_ = 0, others_ = 0;
};

}  // namespace

void ReadScope(std::string_view text, Recording& recording) {
  ScopeReader(text, recording).Read();
}

}  // namespace twinbench::imports
