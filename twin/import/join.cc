#include "twin/import/join.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"
#include "twin/core/reading.h"
#include "twin/core/units.h"
#include "twin/import/common.h"
#include "twin/import/course.h"
#include "twin/import/expression.h"

namespace twinbench::imports {
namespace {

constexpr std::size_t kFewestRows = 12;  // of a part that is worth a set-up

/// A column in a track, with the track's clock on the run's.
struct Source {
  const Track* track = nullptr;
  const Column* column = nullptr;
  double shift_s = 0.0;
};

struct Side {
  const Track* track = nullptr;
  std::size_t file = 0;
};
/// Tracks of one set-up, with the files that they come from.
using Together = std::vector<Side>;

bool SameColumns(const Recording& a, const Recording& b) {
  return a.tracks.size() == b.tracks.size() &&
         std::ranges::equal(a.tracks, b.tracks, [](const Track& x, const Track& y) {
           return std::ranges::equal(x.columns, y.columns, {}, &Column::name, &Column::name);
         });
}

std::vector<Together> Group(const std::vector<Recording>& recordings, const Map& map, Joined& joined) {
  const bool alike =
      std::ranges::all_of(recordings, [&](const Recording& r) { return SameColumns(r, recordings[0]); });
  const bool one_after_the_other =
      map.course.files == "setups" || (map.course.files == "auto" && recordings.size() > 1 && alike);
  if (map.course.files == "auto" && one_after_the_other)
    joined.remarks.push_back("the files have the same columns: each is taken as a mounting (course.files)");
  std::vector<Together> groups;
  std::size_t too_short = 0;
  for (std::size_t f = 0; f < recordings.size(); ++f) {
    const Recording& recording = recordings[f];
    if (groups.empty() || one_after_the_other) groups.emplace_back();
    for (const Track& track : recording.tracks) {
      if (recording.parts_are_setups) {
        if (track.Rows() < kFewestRows) {
          ++too_short;
          continue;
        }
        if (!groups.back().empty()) groups.emplace_back();
      }
      groups.back().push_back({&track, f});
    }
  }
  std::erase_if(groups, [](const Together& group) { return group.empty(); });
  if (too_short > 0)
    joined.left_out.push_back({too_short, fmt::format("parts of fewer than {} rows", kFewestRows)});
  if (groups.empty())
    throw InputError(recordings[0].file, "no part is long enough", fmt::format("{} rows", kFewestRows));
  return groups;
}

/// The file number in front of a name, "2:angle", or nothing.
std::optional<std::size_t> FileIn(std::string& name) {
  if (name.size() < 3 || name[1] != ':' || name[0] < '1' || name[0] > '9') return std::nullopt;
  const auto file = static_cast<std::size_t>(name[0] - '1');
  name.erase(0, 2);
  return file;
}

bool IsOfFormulas(const std::string& name) {
  return name == "time_s" || name == "count" || name == "index";
}

/// A file of one number a line may be read as a list or as a table.
bool IsListCalled(const std::string& name, const Track& track) {
  return track.columns.size() == 1 && ((name == "entry" && track.columns[0].name == "column 1") || (name == "column 1" && track.columns[0].name == "entry"));
}

std::vector<Source> Candidates(const Together& together, std::string name) {
  const auto file = FileIn(name);
  const NameAndUnit split = SplitHeader(name);
  std::vector<Source> found, with_unit, without_unit;
  for (const Side& side : together) {
    if (file && side.file != *file) continue;
    for (const Column& column : side.track->columns) {
      if (column.name == name || IsListCalled(name, *side.track)) found.push_back({side.track, &column, 0.0});
      if (column.name == split.name && column.unit == split.unit) with_unit.push_back({side.track, &column, 0.0});
      if (!IsOfFormulas(name) && UnitAtEnd(column.name) && BaseOf(column.name) == name) without_unit.push_back({side.track, &column, 0.0});
    }
  }
  if (!found.empty()) return found;
  return with_unit.empty() ? without_unit : with_unit;  // "angle [deg]", as the head of the file has it; "angle" of "angle_deg"
}

/// The period at which a column starts again, in whatever unit it is; 0: it does not.
double PeriodOf(const std::vector<double>& x) {
  if (x.size() < 3) return 0.0;
  const auto [low, high] = std::ranges::minmax(x);
  const double range = high - low;
  std::vector<double> steps = StepsOf(x);
  for (double& step : steps) step = std::abs(step);
  if (!(range > 0.0) || std::ranges::max(steps) < 0.75 * range || MedianOf(steps) > 0.25 * range) return 0.0;
  std::vector<double> known = {360.0, 2.0 * units::kPi, 400.0, 6283.185307179586, 21600.0, 360000.0, 1296000.0};
  for (int bits = 8; bits <= 32; ++bits) known.push_back(std::ldexp(1.0, bits));
  for (const double period : known) {
    if (range > 0.9 * period && range <= 1.002 * period) return period;
  }
  return 0.0;
}

/// Reads one source at the times of another.
class Reader {
 public:
  Reader(const Source& source, const std::vector<double>& time_s) : time_s_(time_s) {
    for (std::size_t i = 0; i < source.track->Rows(); ++i) {
      const double t = source.track->time_s[i] + source.shift_s;
      if (!std::isfinite(t) || !std::isfinite(source.column->value[i])) continue;
      if (!t_.empty() && t <= t_.back()) continue;
      t_.push_back(t);
      x_.push_back(source.column->value[i]);
    }
    std::vector<double> steps;
    for (std::size_t i = 1; i < t_.size(); ++i) steps.push_back(t_[i] - t_[i - 1]);
    if (const double period = PeriodOf(x_); period > 0.0) Unwrap(period, x_);
    usual_s_ = MedianOf(std::move(steps));
    holds_ = source.track->on_change;
  }

  /// @param gaps  Counts the times that lie in a gap.
  std::vector<double> Values(std::size_t& outside, std::size_t& gaps) const {
    std::vector<double> values;
    values.reserve(time_s_.size());
    for (const double t : time_s_) values.push_back(At(t, outside, gaps));
    return values;
  }

 private:
  double At(double t, std::size_t& outside, std::size_t& gaps) const {
    const auto after = std::ranges::upper_bound(t_, t);
    if (t_.empty() || after == t_.begin()) return ++outside, kNaN;
    const auto i = static_cast<std::size_t>(after - t_.begin()) - 1;
    if (t == t_[i]) return x_[i];
    if (i + 1 == t_.size()) return holds_ ? x_[i] : (++outside, kNaN);
    const double way_s = t_[i + 1] - t_[i];
    if (way_s <= kGapIntervals * usual_s_) return x_[i] + (x_[i + 1] - x_[i]) * (t - t_[i]) / way_s;
    if (holds_) {  // it stood still, then moved within the last usual interval
      const double moving_s = t_[i + 1] - usual_s_;
      return t <= moving_s ? x_[i] : x_[i] + (x_[i + 1] - x_[i]) * (t - moving_s) / usual_s_;
    }
    if (x_[i] == x_[i + 1]) return x_[i];
    return ++gaps, kNaN;
  }

  const std::vector<double>& time_s_;
  std::vector<double> t_, x_;
  double usual_s_ = 0.0;
  bool holds_ = false;
};

/// Evaluates all columns of the map on one set-up.
class Evaluation {
 public:
  Evaluation(const Together& together, const std::vector<Recording>& recordings, const Map& map, Joined& joined)
      : together_(together), recordings_(recordings), map_(map), joined_(joined) {}

  Session Of(const std::string& shown) {
    ChooseBase(shown);
    Session session;
    session.name = base_->name;
    session.has_clock = base_->HasClock();
    for (std::size_t i = 0; i < base_->Rows(); ++i) time_s_.push_back(base_->time_s[i]);
    for (const MappedColumn& column : map_.columns) session.value[column.column] = Evaluate(column);
    session.time_s = time_s_;
    return session;
  }

 private:
  std::vector<std::string> NamesIn(const MappedColumn& column) const {
    if (!Candidates(together_, column.expression).empty()) return {column.expression};
    return Expression(column.expression, column.where).Names();
  }

  /// The clock of the device under test; a set-up of one track has but one.
  void ChooseBase(const std::string& shown) {
    base_ = together_[0].track;
    for (const MappedColumn& column : map_.columns) {
      if (column.column != shown) continue;
      for (const std::string& name : NamesIn(column)) {
        const auto found = Candidates(together_, name);
        if (found.empty()) continue;
        base_ = found[0].track;
        return;
      }
    }
  }

  [[noreturn]] void Unknown(const std::string& name, const std::string& where) const {
    std::vector<std::string> known;
    for (const Side& side : together_) {
      for (const Column& column : side.track->columns) known.push_back(column.name);
    }
    throw InputError(
        where, fmt::format("no column or number is called \"{}\"", name),
        fmt::format("one of {}; the nearest is \"{}\"", ColumnNames(recordings_), Nearest(name, known)));
  }

  Values LookUp(const std::string& name, const std::string& where) {
    const std::vector<Source> found = Candidates(together_, name);
    if (found.size() > 1)
      throw InputError(where, fmt::format("{} columns are called \"{}\"", found.size(), name),
                       "the file's number in front, as in [2:angle], or other names");
    if (found.size() == 1) return Column_(found[0], name);
    if (name == "time_s") {
      Values values{time_s_, nullptr};
      const double first = time_s_.empty() ? 0.0 : time_s_[0];
      for (double& t : values.value) t -= first;
      return values;
    }
    if (name == "count") return {{static_cast<double>(time_s_.size())}, nullptr};
    if (name == "index") {
      Values values{std::vector<double>(time_s_.size()), nullptr};
      std::iota(values.value.begin(), values.value.end(), 0.0);
      return values;
    }
    for (const Side& side : together_) {
      const auto number = side.track->numbers.find(name);
      if (number != side.track->numbers.end()) return {{number->second}, nullptr};
    }
    Unknown(name, where);
  }

  Values Column_(Source source, const std::string& name) {
    const std::vector<std::string>* words = source.column->IsNumber() ? nullptr : &source.column->words;
    if (source.track == base_) return {source.column->value, words};
    if (!source.track->HasClock() && !base_->HasClock() && source.track->Rows() == base_->Rows()) {
      joined_.remarks.push_back(fmt::format("{} is taken beside {}, row by row", recordings_[FileOf(*source.track)].file, recordings_[FileOf(*base_)].file));
      return {source.column->value, words};
    }
    if (words)
      throw InputError(recordings_[0].file, fmt::format("\"{}\" holds words on a clock of its own", name),
                       "numbers");
    source.shift_s = ShiftOf(*source.track);
    std::size_t outside = 0, gaps = 0;
    Values values{Reader(source, time_s_).Values(outside, gaps), nullptr};
    if (outside == time_s_.size()) RefuseClocks(source);
    joined_.remarks.push_back(fmt::format("{} is taken to the clock of {}", name, base_->name));
    if (outside > 0)
      joined_.left_out.push_back({outside, fmt::format("rows before or after {} was recorded", name)});
    if (gaps > 0) joined_.left_out.push_back({gaps, fmt::format("rows in gaps of {}", name)});
    return values;
  }

  std::size_t FileOf(const Track& track) const { return std::ranges::find(together_, &track, &Side::track)->file; }

  /// Between the clocks of two files: those that know the date need none but what the map says.
  double ShiftOf(const Track& track) {
    if (FileOf(track) == FileOf(*base_)) return 0.0;
    const double said_s = FileOf(track) > FileOf(*base_) ? map_.course.clock_offset_s : -map_.course.clock_offset_s;
    if (track.absolute && base_->absolute) return said_s;
    if (!track.HasClock() || !base_->HasClock())
      throw InputError(recordings_[FileOf(track)].file, "two files are to be joined and one of them has no clock",
                       "[time] rate_Hz or a time column");
    joined_.remarks.push_back(
        "the clocks of the files do not both know the date: they are taken to start together "
        "(course.clock_offset_s)");
    return base_->time_s.front() - track.time_s.front() + said_s;
  }

  [[noreturn]] void RefuseClocks(const Source& source) const {
    throw InputError(
        recordings_[FileOf(*source.track)].file,
        fmt::format("its clock runs from {:.3f} s to {:.3f} s, that of {} from {:.3f} s to {:.3f} s: they "
                    "do not overlap",
                    source.track->time_s.front() + source.shift_s, source.track->time_s.back() + source.shift_s,
                    base_->name, base_->time_s.front(), base_->time_s.back()),
        fmt::format("[course] clock_offset_s in the map; {:.3f} would let them start together",
                    base_->time_s.front() - source.track->time_s.front()));
  }

  /// To SI of the bench's column; lengths become angles of a linear axis.
  double Factor(const MappedColumn& column, const std::string& unit_of_file) {
    const auto wanted = UnitAtEnd(column.column);
    if (!wanted) return 1.0;
    const auto given = UnitNamed(unit_of_file.empty() ? column.unit : unit_of_file);
    if (!given)
      throw InputError(column.where, fmt::format("{} is in \"{}\"", column.expression, unit_of_file),
                       fmt::format("a factor: {} = \"[{}] * ...\"", column.column, column.expression));
    if (given->dimension == wanted->dimension) return given->to_SI;
    if (wanted->dimension == Dimension::kAngle && given->dimension == Dimension::kLength) {
      joined_.linear = true;
      return given->to_SI * units::turn / joined_.turn_m;
    }
    const bool is_rate = given->dimension == Dimension::kTurning || given->dimension == Dimension::kSpeed;
    throw InputError(column.where, fmt::format("{} is in {}{}", column.expression, unit_of_file.empty() ? column.unit : unit_of_file, is_rate ? ", a rate" : ""),
                     is_rate ? "a column of the angle that the rate adds up to; or rates on both sides, each as a formula to one unit, as in --column 'reference_rad=[Rate] * 0.1047'"
                             : fmt::format("a unit that can be {}", wanted->name));
  }

  std::vector<double> Evaluate(const MappedColumn& column) {
    const std::vector<Source> whole = Candidates(together_, column.expression);
    std::vector<double> values;
    std::string unit_of_file;
    if (!whole.empty()) {  // a column as it is: the file's unit counts
      values = LookUp(column.expression, column.where).value;
      if (whole[0].column->unit != column.unit && BareUnitOf(whole[0].column->unit))
        unit_of_file = whole[0].column->unit;
      if (!unit_of_file.empty() && !column.where.empty())
        joined_.remarks.push_back(fmt::format("{} is in {} as its file says", column.expression, unit_of_file));
    } else {
      const Expression expression(column.expression, column.where);
      values =
          expression.Evaluate(time_s_.size(), [&](const std::string& name) { return LookUp(name, column.where); });
    }
    joined_.unit[column.column] = unit_of_file.empty() ? column.unit : unit_of_file;
    const double factor = Factor(column, unit_of_file);
    for (double& x : values) x *= factor;
    return values;
  }

  static bool BareUnitOf(const std::string& unit) { return UnitNamed(unit).has_value(); }

  const Together& together_;
  const std::vector<Recording>& recordings_;
  const Map& map_;
  Joined& joined_;
  const Track* base_ = nullptr;
  std::vector<double> time_s_;
};

/// Set-ups follow each other on the run's clock: those that know the date as they did, the others with a pause.
void PutInOrder(const std::vector<Together>& groups, std::vector<Session>& sessions) {
  const bool dated = std::ranges::all_of(groups, [](const Together& g) { return g[0].track->absolute; });
  const double origin_s = sessions[0].time_s.empty() ? 0.0 : sessions[0].time_s[0];
  double free_s = 0.0;
  for (Session& session : sessions) {
    if (session.time_s.empty()) continue;
    double shift_s = dated ? -origin_s : free_s - session.time_s[0];
    if (session.time_s[0] + shift_s < free_s) shift_s = free_s - session.time_s[0];
    for (double& t : session.time_s) t += shift_s;
    free_s = session.time_s.back() + 60.0;
  }
}

void Unique(std::vector<std::string>& remarks) {
  std::vector<std::string> once;
  for (const std::string& remark : remarks) {
    if (std::ranges::find(once, remark) == once.end()) once.push_back(remark);
  }
  remarks = std::move(once);
}

}  // namespace

std::string FullName(const std::string& column, const Recording& recording, const std::vector<Recording>& recordings) {
  const auto has = [&column](const Recording& r) {
    return std::ranges::any_of(r.tracks, [&column](const Track& t) { return IsListCalled(column, t) || std::ranges::count(t.columns, column, &Column::name) > 0; });
  };
  if (recordings.size() != 2 || std::ranges::count_if(recordings, has) < 2) return column;
  return fmt::format("{}:{}", &recording - recordings.data() + 1, column);
}

std::string ColumnNames(const std::vector<Recording>& recordings) {
  std::string names;
  for (const Recording& recording : recordings) {
    for (const Track& track : recording.tracks) {
      for (const Column& column : track.columns) {
        const std::string name = FullName(column.name, recording, recordings);
        if (names.size() < 600 && names.find('"' + name + '"') == std::string::npos)
          names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", name);
      }
    }
  }
  return names;
}

Joined Join(const std::vector<Recording>& recordings, const Map& map, const std::string& shown) {
  Joined joined;
  joined.turn_m = map.course.turn_m > 0.0 ? map.course.turn_m : 360.0 * units::mm;
  const std::vector<Together> groups = Group(recordings, map, joined);
  for (const Together& group : groups)
    joined.sessions.push_back(Evaluation(group, recordings, map, joined).Of(shown));
  PutInOrder(groups, joined.sessions);
  if (joined.linear)
    joined.remarks.push_back(
        fmt::format("a linear axis: {:g} mm count as a turn{}", joined.turn_m / units::mm,
                    map.course.turn_m > 0.0 ? "" : ", a degree a millimetre (course.turn_mm)"));
  Unique(joined.remarks);
  return joined;
}

}  // namespace twinbench::imports
