#include "twin/import/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "twin/core/errors.h"
#include "twin/core/reading.h"
#include "twin/import/clock.h"
#include "twin/import/common.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

constexpr std::size_t kMostWords = 1000;  // different ones; a column with more is free text

enum class Kind { kNumber, kInstant, kWord };

/// A column while it is read.
class Gatherer {
 public:
  explicit Gatherer(Kind kind) : kind_(kind) {}

  void Take(std::string_view field, bool decimal_comma) {
    if (kind_ == Kind::kNumber) {
      TakeNumber(field, decimal_comma);
    } else if (kind_ == Kind::kInstant) {
      TakeInstant(field);
    } else {
      TakeWord(field);
    }
  }
  Kind kind() const { return kind_; }
  bool HasDate() const { return has_date_; }
  std::vector<double> TakeValues() { return std::move(values_); }
  std::vector<std::string> TakeWords() { return std::move(words_); }

  /// That its cells have, of the first one.
  std::string UnitOfCells() const { return unit_; }

 private:
  void TakeNumber(std::string_view field, bool decimal_comma) {
    const auto cell = CellOf(field, decimal_comma);
    values_.push_back(cell ? cell->number : kNaN);
    if (!cell || cell->unit.empty() || cell->unit == unit_) return;
    if (unit_.empty()) unit_ = cell->unit;
    const auto own = UnitNamed(cell->unit), first = UnitNamed(unit_);
    values_.back() *= own->dimension == first->dimension ? own->to_SI / first->to_SI : kNaN;
  }
  /// A clock without a date that jumps back has passed midnight.
  void TakeInstant(std::string_view field) {
    const auto instant = ParseInstant(field);
    double time_s = instant ? instant->time_s : kNaN;
    has_date_ = has_date_ || (instant && instant->has_date);
    if (instant && !instant->has_date) {
      if (!values_.empty() && time_s + midnight_s_ < values_.back() - 43200.0) midnight_s_ += 86400.0;
      time_s += midnight_s_;
    }
    values_.push_back(time_s);
  }
  void TakeWord(std::string_view field) {
    const auto found = number_.find(field);
    if (found != number_.end()) return values_.push_back(found->second);
    if (words_.size() >= kMostWords) return values_.push_back(kNaN);
    number_.emplace(std::string(field), static_cast<double>(words_.size()));
    values_.push_back(static_cast<double>(words_.size()));
    words_.emplace_back(field);
  }

  Kind kind_;
  std::vector<double> values_;
  std::vector<std::string> words_;
  std::map<std::string, double, std::less<>> number_;
  std::string unit_;
  double midnight_s_ = 0.0;
  bool has_date_ = false;
};

/// Kinds of the columns by a few rows.
std::vector<Kind> KindsOf(const std::vector<std::vector<std::string_view>>& rows, const Fields& how) {
  std::vector<Kind> kinds;
  for (std::size_t c = 0; c < rows.front().size(); ++c) {
    int numbers = 0, instants = 0, words = 0;
    for (const auto& row : rows) {
      if (c >= row.size() || row[c].empty()) continue;
      if (CellOf(row[c], how.decimal_comma)) {
        ++numbers;
      } else if (ParseInstant(row[c])) {
        ++instants;
      } else {
        ++words;
      }
    }
    kinds.push_back(words + instants > numbers ? instants > words ? Kind::kInstant : Kind::kWord : Kind::kNumber);
  }
  return kinds;
}

/// Most of a row's fields hold something that is no name.
bool IsRow(const std::vector<std::string_view>& fields, const Fields& how) {
  if (fields.size() < 2) return !fields.empty() && CellOf(fields[0], how.decimal_comma);
  const auto numbers = std::ranges::count_if(fields, [&how](std::string_view field) {
    return CellOf(field, how.decimal_comma).has_value() || ParseInstant(field).has_value();
  });
  return numbers >= 1 && (CellOf(fields[0], how.decimal_comma) || ParseInstant(fields[0]) ||
                          2 * numbers >= std::ssize(fields));
}

/// Names with units, the units perhaps from a row of their own.
struct Heading {
  std::vector<NameAndUnit> columns;
  bool found = false;
};

bool AllUnits(const std::vector<std::string_view>& fields) {
  return std::ranges::all_of(fields, [](std::string_view field) { return BareUnit(field).has_value(); }) &&
         std::ranges::any_of(
             fields, [](std::string_view field) {
               return UnitNamed(*BareUnit(field)).has_value() || field.starts_with('[') || field.starts_with('(');
             });
}

/// A name comes once, a unit as often as there are quantities of it.
bool Repeats(std::vector<std::string_view> fields) {
  std::ranges::sort(fields);
  return std::ranges::adjacent_find(fields) != fields.end();
}

std::string_view WithoutMark(std::string_view line) {
  line = Trimmed(line);
  const std::size_t first = line.find_first_not_of("#%/ \t");
  return IsComment(line) && first != std::string_view::npos ? line.substr(first) : line;
}

/// Reads one table of a text: goes through its lines once.
class TableReader {
 public:
  TableReader(std::string_view text, const Layout& layout, const ClockSettings& clock, Recording& recording)
      : text_(text), layout_(layout), clock_(clock), recording_(recording) {}

  void Read() {
    const std::vector<std::string_view> first = FirstLines(text_);
    how_ = FindFields(first, layout_);
    if (how_.separator == '\0')
      how_.separator = layout_.separator == "auto" ? ' ' : SeparatorNamed(layout_.separator);
    Lines lines(text_);
    Begin();
    for (std::string_view line; lines.Next(line);) TakeLine(line);
    End();
    Report();
  }

 private:
  void Begin() {
    track_ = {};
    track_.name = recording_.file;
    heading_ = {};
    above_.clear();
    waiting_.clear();
    gatherers_.clear();
    open_ = layout_.section.empty();
    named_ = layout_.header.empty();
  }

  void TakeLine(std::string_view line) {
    if (!layout_.section.empty() && Trimmed(line).starts_with(layout_.section)) {
      End();
      Begin();
      open_ = true;
      return;
    }
    if (!open_ || Trimmed(line).empty() || IsRule(line)) return;
    if (!named_) return TakeLineAbove(line);
    if (IsComment(line)) return TakeAside(line);
    Split(line, how_.separator, fields_);
    if (IsRow(fields_, how_) && (!heading_.found || fields_.size() > 1 || heading_.columns.size() == 1))
      return TakeRow();
    TakeAside(line);
  }

  /// Before the header that the map names.
  void TakeLineAbove(std::string_view line) {
    AddNumbers(line, track_);
    if (!Trimmed(line).starts_with(layout_.header)) return;
    Split(line, how_.separator, fields_);
    TakeHeader(fields_);
    named_ = true;
  }

  /// A line that is no row: above the rows it may hold names, units or numbers; between them it is text.
  void TakeAside(std::string_view line) {
    if (Gathering()) {
      if (!IsComment(line)) ++text_lines_;
      return;
    }
    if (!waiting_.empty() && !IsHeadingBehindRows(line)) {
      if (!IsComment(line)) ++text_lines_;
      return;
    }
    waiting_.clear();
    above_.emplace_back(line);
    AddNumbers(WithoutMark(line), track_);
  }

  /// What looked like a few rows stood above the names of the table.
  bool IsHeadingBehindRows(std::string_view line) {
    if (!layout_.header.empty() || waiting_.size() >= 5) return false;
    Split(WithoutMark(line), how_.separator, fields_);
    return fields_.size() > 1 && fields_.size() >= waiting_.back().size();
  }

  void TakeHeader(const std::vector<std::string_view>& fields) {
    heading_.found = true;
    heading_.columns.clear();
    for (const std::string_view field : fields) heading_.columns.push_back(SplitHeader(field));
  }

  bool Gathering() const { return !gatherers_.empty(); }

  void TakeRow() {
    if (Gathering()) return Append(fields_);
    waiting_.push_back(fields_);
    if (waiting_.size() >= 50) Settle();
  }

  /// Enough rows are there to say what the columns are.
  void Settle() {
    if (waiting_.empty()) return;
    std::map<std::size_t, int> counts;
    for (const auto& row : waiting_) ++counts[row.size()];
    width_ = std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; })->first;
    std::vector<std::vector<std::string_view>> rows;
    std::ranges::copy_if(waiting_, std::back_inserter(rows),
                         [this](const auto& row) { return row.size() == width_; });
    if (!heading_.found) FindHeading();
    if (heading_.found && heading_.columns.size() > width_) width_ = heading_.columns.size();
    rows.front().resize(std::max(width_, rows.front().size()));
    for (const Kind kind : KindsOf(rows, how_)) gatherers_.emplace_back(kind);
    const auto held = std::move(waiting_);
    waiting_.clear();
    for (const auto& row : held) Append(row);
  }

  /// The nearest line above the rows with a name for each column; one between may have the units.
  void FindHeading() {
    std::vector<std::string_view> names;
    std::vector<std::string> units;
    for (std::size_t i = above_.size(); i-- > 0 && above_.size() - i <= 3;) {
      Split(WithoutMark(above_[i]), how_.separator, names);
      if (width_ == 1) names = {WithoutMark(above_[i])};
      if (names.size() > 1 && names.back().empty()) names.pop_back();
      if (names.size() != width_ && !(names.size() + 1 == width_ || names.size() == width_ + 1)) continue;
      if (units.empty() && names.size() == width_ && i > 0 && (AllUnits(names) || (Repeats(names) && IsAsWide(above_[i - 1])))) {
        units.assign(names.begin(), names.end());
        continue;
      }
      TakeHeader(names);
      for (std::size_t c = 0; c < std::min(units.size(), heading_.columns.size()); ++c)
        heading_.columns[c].unit = BareUnit(units[c]).value_or(units[c]);
      return;
    }
  }
  bool IsAsWide(std::string_view line) const {
    std::vector<std::string_view> fields;
    Split(WithoutMark(line), how_.separator, fields);
    return fields.size() == width_;
  }

  void Append(const std::vector<std::string_view>& fields) {
    const std::size_t slack = layout_.header.empty() ? 0 : 1;  // some add a remark behind the last column
    if (fields.size() > width_ + slack || fields.size() + (heading_.found ? width_ : 0) < width_) {
      ++misfits_;
      return;
    }
    for (std::size_t c = 0; c < gatherers_.size(); ++c)
      gatherers_[c].Take(c < fields.size() ? fields[c] : std::string_view(), how_.decimal_comma);
    ++rows_;
  }

  std::string NameOf(std::size_t c) const {
    if (c < layout_.names.size()) return SplitHeader(layout_.names[c]).name;
    if (heading_.found && c < heading_.columns.size() && !heading_.columns[c].name.empty())
      return heading_.columns[c].name;
    return fmt::format("column {}", c + 1);
  }

  /// "angle (2)" where an "angle" is there already.
  std::string OwnName(const std::string& name) const {
    std::string own = name;
    const auto is_taken = [this, &own] { return std::ranges::find(track_.columns, own, &Column::name) != track_.columns.end(); };
    for (int k = 2; is_taken(); ++k) own = fmt::format("{} ({})", name, k);
    return own;
  }

  /// As the map's name has it, else as the file's.
  std::string UnitOf(std::size_t c) const {
    const std::string said = c < layout_.names.size() ? SplitHeader(layout_.names[c]).unit : "";
    return said.empty() && c < heading_.columns.size() ? heading_.columns[c].unit : said;
  }

  void End() {
    if (!open_) return;
    Settle();
    if (!Gathering()) return;
    if (!heading_.found && layout_.names.empty()) unnamed_ = true;
    for (std::size_t c = 0; c < gatherers_.size(); ++c) {
      Gatherer& g = gatherers_[c];
      Column column{OwnName(NameOf(c)), UnitOf(c), g.TakeValues(), g.TakeWords()};
      if (column.unit.empty()) column.unit = g.UnitOfCells();
      if (g.kind() == Kind::kInstant) column.unit = g.HasDate() ? "instant" : "time of day";
      track_.columns.push_back(std::move(column));
    }
    JoinDateAndTime();
    FindClock(clock_, recording_.file, track_);
    recording_.tracks.push_back(std::move(track_));
    gatherers_.clear();
  }

  /// A date in one column and the time of day in the next are one instant.
  void JoinDateAndTime() {
    for (std::size_t c = 0; c + 1 < track_.columns.size(); ++c) {
      Column& date = track_.columns[c];
      const Column& time = track_.columns[c + 1];
      if (date.unit != "instant" || time.unit != "time of day") continue;
      for (std::size_t i = 0; i < date.value.size(); ++i) date.value[i] += std::fmod(time.value[i], 86400.0);
      track_.columns.erase(track_.columns.begin() + static_cast<std::ptrdiff_t>(c) + 1);
    }
  }

  void Report() {
    recording_.layout = fmt::format("a table, {} between fields, decimal {}", SeparatorName(how_.separator),
                                    how_.decimal_comma ? "comma" : "point");
    recording_.parts_are_setups = !layout_.section.empty();
    if (misfits_ > 0) recording_.left_out.push_back({misfits_, "rows with another number of fields"});
    if (text_lines_ > 0) recording_.left_out.push_back({text_lines_, "lines of text between the rows"});
    if (unnamed_)
      recording_.remarks.push_back("the columns have no names: they are \"column 1\", \"column 2\", ...");
    if (rows_ == 0 && !layout_.section.empty() && recording_.tracks.empty())
      throw InputError(recording_.file, fmt::format("no part that begins with \"{}\" has rows", layout_.section),
                       layout_.header.empty() ? "rows of numbers" : "a line that begins with " + layout_.header);
    if (rows_ == 0)
      throw InputError(recording_.file,
                       named_ ? "no line is a row of numbers" : "no line begins with " + layout_.header,
                       "rows with the same number of fields; [file] of a map says how they are separated");
  }

  std::string_view text_;
  const Layout& layout_;
  const ClockSettings& clock_;
  Recording& recording_;
  Fields how_;
  Track track_;
  Heading heading_;
  bool open_ = true, named_ = true, unnamed_ = false;
  std::vector<std::string_view> above_, fields_;
  std::vector<std::vector<std::string_view>> waiting_;
  std::vector<Gatherer> gatherers_;
  std::size_t width_ = 0, rows_ = 0, misfits_ = 0, text_lines_ = 0;
};

}  // namespace

void ReadTable(std::string_view text, const Layout& layout, const ClockSettings& clock, Recording& recording) {
  TableReader(text, layout, clock, recording).Read();
}

namespace {

/// "4096 counts/rev": a number that says what it is behind it.
void AddNumberBefore(std::string_view part, Track& track) {
  const std::size_t end = part.find_first_of(" \t");
  if (end == std::string_view::npos) return;
  const std::string what = SmallLetters(Trimmed(part.substr(end)));
  const bool per_turn = std::ranges::any_of(std::array{"/rev", "/turn", "/umdr", "per rev", "per turn", "cpr", "ppr"},
                                            [&what](const char* word) { return what.find(word) != std::string::npos; });
  const auto number = FieldNumber(part.substr(0, end), false);
  if (per_turn && number) track.numbers[what] = *number;
}

}  // namespace

void AddNumbers(std::string_view line, Track& track) {
  while (!line.empty()) {
    const std::size_t comma = line.find_first_of(",;\t");
    const std::string_view part = line.substr(0, comma);
    line.remove_prefix(comma == std::string_view::npos ? line.size() : comma + 1);
    const std::size_t equals = part.find_first_of("=:");
    AddNumberBefore(Trimmed(equals == std::string_view::npos ? part : part.substr(equals + 1)), track);
    if (equals == std::string_view::npos) continue;
    std::string_view value = Trimmed(part.substr(equals + 1));
    value = value.substr(0, value.find_first_of(" \t\"%"));
    if (const auto number = FieldNumber(value, false))
      track.numbers[std::string(Trimmed(part.substr(0, equals)))] = *number;
  }
}

}  // namespace twinbench::imports
