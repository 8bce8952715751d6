#include "twin/import/layouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/import/common.h"
#include "twin/import/run_names.h"
#include "twin/import/text.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

/// One run to all targets.
struct Run {
  int direction = 0;  // 0: not said
  std::vector<double> value;
};

struct CycleTable {
  std::string target_unit, value_unit;
  std::vector<double> target;
  std::vector<Run> runs;
};

/// The unit of a deviation beside the target's: both are known or it is the same.
double Ratio(const std::string& from, const std::string& to) {
  const auto a = UnitNamed(from), b = UnitNamed(to);
  return a && b && a->dimension == b->dimension ? a->to_SI / b->to_SI : 1.0;
}

class CycleReader {
 public:
  CycleReader(std::string_view text, const Layout& layout, Recording& recording)
      : text_(text), open_(layout.columns_are_open), recording_(recording), how_(FindFields(FirstLines(text), layout)) {}

  void Read() {
    if (how_.separator == '\0') Refuse("no line is a row of numbers");
    Lines lines(text_);
    for (std::string_view line; lines.Next(line);) TakeLine(line);
    EndTable();
    Write();
  }

 private:
  [[noreturn]] void Refuse(const std::string& what) const {
    throw InputError(recording_.file, what, "a row a target, a column a run, and what says up or down");
  }

  void TakeLine(std::string_view line) {
    if (IsRule(line)) return;
    Split(line, how_.separator, fields_);
    if (IsRow()) return TakeRow();
    EndTable();
    if (Trimmed(line).empty()) return;
    if (const int direction = DirectionIn(line); direction != 0 && fields_.size() < 3) said_ = direction;
    above_ = line;
  }

  bool IsRow() const {
    if (fields_.size() < 2) return false;
    return std::ranges::all_of(fields_, [this](std::string_view f) {
      return f.empty() || FieldNumber(f, how_.decimal_comma).has_value();
    });
  }

  void TakeRow() {
    if (table_.target.empty()) BeginTable();
    if (fields_.size() != width_) return;
    const auto at = [this](std::size_t c) {
      return FieldNumber(fields_[c], how_.decimal_comma).value_or(std::nan(""));
    };
    table_.target.push_back(one_place_ ? 0.0 : at(first_));
    for (std::size_t c = first_run_; c < width_; ++c) table_.runs[c - first_run_].value.push_back(at(c));
  }

  void BeginTable() {
    std::vector<std::string_view> names;
    Split(above_, how_.separator, names);
    width_ = fields_.size();
    const bool named = names.size() == width_;
    first_ = named && CountsRows(names[0]) && width_ > 2 ? 1 : 0;
    one_place_ = named && IsOnePlace(names);
    numbered_ = open_ && named && NumbersRuns(names);
    first_run_ = first_ + (one_place_ ? 0 : 1);
    table_ = {};
    if (named) table_.target_unit = SplitHeader(names[first_]).unit;
    for (std::size_t c = first_run_; c < width_; ++c) {
      const int own = named ? DirectionIn(SplitHeader(names[c]).name) : 0;
      if (named && table_.value_unit.empty()) table_.value_unit = SplitHeader(names[c]).unit;
      table_.runs.push_back({own != 0 ? own : said_, {}});
    }
  }

  /// The first table of a direction has the readings; what follows is worked out from them.
  void EndTable() {
    if (table_.target.size() >= 2) {
      for (Run& run : table_.runs) {
        if (run.direction == 0 && !numbered_) Refuse("nothing says in which direction the runs went");
      }
      if (tables_.empty() || (tables_.size() == 1 && IsOtherDirection())) tables_.push_back(std::move(table_));
    }
    table_ = {};
  }

  bool IsOtherDirection() const {
    return table_.target == tables_[0].target && table_.runs.size() == tables_[0].runs.size() &&
           std::ranges::none_of(table_.runs, [this](const Run& run) {
             return std::ranges::any_of(tables_[0].runs,
                                        [&run](const Run& r) { return r.direction == run.direction; });
           });
  }

  /// Entries that are nearer to nothing than to the target are deviations.
  bool AreDeviations() const {
    double from_target = 0.0, from_zero = 0.0;
    for (const CycleTable& table : tables_) {
      for (const Run& run : table.runs) {
        for (std::size_t i = 0; i < table.target.size(); ++i) {
          if (!std::isfinite(run.value[i])) continue;
          from_target += std::abs(run.value[i] * Ratio(table.value_unit, table.target_unit) - table.target[i]);
          from_zero += std::abs(run.value[i] * Ratio(table.value_unit, table.target_unit));
        }
      }
    }
    return from_zero < from_target;
  }

  void Write() {
    if (tables_.empty()) Refuse("there is no table of runs");
    const std::string& unit = tables_[0].target_unit;
    Track track;
    track.name = recording_.file;
    track.columns = {
        {"target", unit, {}, {}}, {"actual", unit, {}, {}}, {"direction", "", {}, {}}, {"run", "", {}, {}}};
    if (one_place_ && tables_.size() == 1) return WriteOnePlace(std::move(track));
    if (std::ranges::any_of(tables_[0].runs, [](const Run& run) { return run.direction == 0; })) return WritePasses(std::move(track));
    const bool deviations = AreDeviations();
    std::array<std::vector<const Run*>, 2> runs;  // up, down
    for (const CycleTable& table : tables_) {
      for (const Run& run : table.runs) runs[run.direction > 0 ? 0 : 1].push_back(&run);
    }
    for (std::size_t r = 0; r < std::max(runs[0].size(), runs[1].size()); ++r) {
      for (const auto& side : runs) {
        if (r < side.size()) Append(*side[r], static_cast<int>(r) + 1, deviations, track);
      }
    }
    for (std::size_t i = 0; i < track.Rows(); ++i) track.time_s.push_back(static_cast<double>(i));
    recording_.layout = fmt::format(
        "a positioning test (ISO 230-2): {} targets, {} runs up, {} down, entries are {}", tables_[0].target.size(),
        runs[0].size(), runs[1].size(), deviations ? "deviations" : "positions");
    recording_.tracks.push_back(std::move(track));
  }

  /// Runs of which nobody says where they went: all in the order of the rows, a pass each.
  void WritePasses(Track track) {
    const CycleTable& table = tables_[0];
    const bool deviations = AreDeviations();
    track.columns[2].name = "pass";
    track.columns.pop_back();
    for (std::size_t r = 0; r < table.runs.size(); ++r) {
      for (std::size_t i = 0; i < table.target.size(); ++i) {
        track.columns[0].value.push_back(table.target[i]);
        track.columns[1].value.push_back(ActualOf(table.runs[r], i, deviations));
        track.columns[2].value.push_back(static_cast<double>(r));
        track.time_s.push_back(static_cast<double>(track.time_s.size()));
      }
    }
    recording_.layout = fmt::format("a table of {} targets and {} runs, entries are {}", table.target.size(), table.runs.size(), deviations ? "deviations" : "positions");
    recording_.remarks.push_back(fmt::format("nothing says in which direction the {} runs went: each is a pass in the order of the rows", table.runs.size()));
    recording_.tracks.push_back(std::move(track));
  }

  double ActualOf(const Run& run, std::size_t i, bool deviations) const {
    const CycleTable& table = tables_[0];
    return run.value[i] * Ratio(table.value_unit, table.target_unit) + (deviations ? table.target[i] : 0.0);
  }

  /// Row by row, as such a test is done.
  void WriteOnePlace(Track track) {
    const CycleTable& table = tables_[0];
    for (std::size_t row = 0; row < table.target.size(); ++row) {
      for (const Run& run : table.runs) {
        track.columns[0].value.push_back(0.0);
        track.columns[1].value.push_back(run.value[row]);
        track.columns[2].value.push_back(run.direction);
        track.columns[3].value.push_back(static_cast<double>(row) + 1.0);
        track.time_s.push_back(static_cast<double>(track.time_s.size()));
      }
    }
    recording_.layout = fmt::format("a test at one place from both sides: {} repetitions", table.target.size());
    recording_.tracks.push_back(std::move(track));
  }

  void Append(const Run& run, int number, bool deviations, Track& track) const {
    const CycleTable& table = tables_[0];
    for (std::size_t k = 0; k < table.target.size(); ++k) {
      const bool ascending = table.target.back() >= table.target.front();
      const std::size_t i = (run.direction > 0) == ascending ? k : table.target.size() - 1 - k;
      track.columns[0].value.push_back(table.target[i]);
      track.columns[1].value.push_back(ActualOf(run, i, deviations));
      track.columns[2].value.push_back(run.direction);
      track.columns[3].value.push_back(number);
    }
  }

  std::string_view text_;
  bool open_;  // no map says what the columns are
  Recording& recording_;
  Fields how_;
  std::vector<std::string_view> fields_;
  std::string_view above_;
  int said_ = 0;
  std::size_t width_ = 0, first_ = 0, first_run_ = 1;
  bool one_place_ = false, numbered_ = false;
  CycleTable table_;
  std::vector<CycleTable> tables_;
};

}  // namespace

bool AreCycles(const std::vector<std::string_view>& lines) {
  const Fields how = FindFields(lines, {});
  std::vector<std::string_view> names;
  return how.separator != '\0' && std::ranges::any_of(lines, [&](std::string_view line) {
    Split(line, how.separator, names);
    return !IsComment(line) && (NamesRuns(names) || NumbersRuns(names) || IsOnePlace(names));
  });
}

void ReadCycles(std::string_view text, const Layout& layout, Recording& recording) {
  CycleReader(text, layout, recording).Read();
}

}  // namespace twinbench::imports
