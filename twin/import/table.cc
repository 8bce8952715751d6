#include "twin/import/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/core/errors.h"
#include "twin/import/gatherer.h"
#include "twin/import/heading.h"
#include "twin/import/seconds_of_arc.h"

namespace twinbench::imports {
namespace {

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
    waiting_lines_.clear();
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
    if (!layout_.header.empty() && IsSaid(fields_[0])) return TakeAside(line);
    if (!NamesPlaces() && IsRow(fields_, how_) && (!heading_.found || fields_.size() > 1 || heading_.columns.size() == 1))
      return TakeRow(line);
    TakeAside(line);
  }

  /// "Position; 0°; 30°; 60°" above the rows: columns that are called by where something stood.
  bool NamesPlaces() const {
    if (Gathering() || !waiting_.empty() || fields_.size() < 3 || CellOf(fields_[0], how_.decimal_comma)) return false;
    return std::ranges::all_of(fields_.begin() + 1, fields_.end(), [this](std::string_view field) {
      const auto cell = CellOf(field, how_.decimal_comma);
      const auto unit = cell ? UnitNamed(cell->unit) : std::nullopt;
      return unit && unit->dimension == Dimension::kAngle;
    });
  }

  /// "INFO: DITHER by -1.995", whatever numbers stand behind it.
  static bool IsSaid(std::string_view field) {
    const std::size_t colon = field.find(": ");
    return colon != std::string_view::npos && colon > 0 && std::isalpha(static_cast<unsigned char>(field[colon - 1]));
  }

  /// Before the header that the map names.
  void TakeLineAbove(std::string_view line) {
    AddNumbers(line, track_);
    if (!Trimmed(line).starts_with(layout_.header)) return;
    Split(line, how_.separator, fields_);
    heading_ = HeadingOf(fields_);
    named_ = true;
  }

  /// A line that is no row: above the rows it may hold names, units or numbers; between them it is text.
  void TakeAside(std::string_view line) {
    if (waiting_.empty()) KeepLine(line);
    if (Gathering()) {
      if (!IsComment(line)) ++text_lines_;
      return;
    }
    if (!waiting_.empty() && !IsHeadingBehindRows(line)) {
      KeepLine(line);
      if (!IsComment(line)) ++text_lines_;
      return;
    }
    if (!waiting_.empty()) {
      for (TextLine& above : track_.lines) above.row = 0;
      for (const std::string_view statement : waiting_lines_) track_.lines.push_back({0, std::string(statement)});
      waiting_.clear();
      waiting_lines_.clear();
      KeepLine(line);
    }
    above_.emplace_back(line);
    AddNumbers(WithoutMark(line), track_);
  }

  void KeepLine(std::string_view line) {
    constexpr std::size_t kMostLines = 2000;
    if (track_.lines.size() >= kMostLines) return;
    const std::size_t row = Gathering() ? gatherers_.front().size() : waiting_.size();
    track_.lines.push_back({row, std::string(WithoutMark(line))});
  }

  /// "Radius;150", "Feed;1000": names with values are no rows of a table whose names come below.
  bool AreStatements() const {
    return std::ranges::all_of(waiting_, [this](const auto& row) { return !CellOf(row.front(), how_.decimal_comma); });
  }

  /// What looked like a few rows stood above the names of the table.
  bool IsHeadingBehindRows(std::string_view line) {
    if (!layout_.header.empty() || (waiting_.size() >= 5 && !AreStatements())) return false;
    Split(WithoutMark(line), how_.separator, fields_);
    return fields_.size() > 1 && fields_.size() >= waiting_.back().size();
  }

  /// Names of columns state nothing: "U (k=2)", "run 1".
  bool IsTheHeading(std::string_view line) const {
    std::vector<std::string_view> names;
    Split(line, how_.separator, names);
    return heading_.found && names.size() > 1 &&
           std::ranges::equal(HeadingOf(names).columns, heading_.columns, {}, &NameAndUnit::name, &NameAndUnit::name);
  }

  bool Gathering() const { return !gatherers_.empty(); }

  void TakeRow(std::string_view line) {
    if (Gathering()) return Append(fields_);
    waiting_.push_back(fields_);
    waiting_lines_.push_back(line);
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
    if (!heading_.found) heading_ = FindHeading(above_, width_, how_.separator);
    std::erase_if(track_.lines, [this](const TextLine& line) { return IsTheHeading(line.text); });
    if (heading_.found && heading_.columns.size() > width_) width_ = heading_.columns.size();
    rows.front().resize(std::max(width_, rows.front().size()));
    for (const Kind kind : KindsOf(rows, heading_, how_)) gatherers_.emplace_back(kind);
    const auto held = std::move(waiting_);
    waiting_.clear();
    waiting_lines_.clear();
    for (const auto& row : held) Append(row);
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
      if (g.kind() == Kind::kDegreesOfColons) column.unit = "deg";
      if (g.kind() == Kind::kInstant) column.unit = g.HasDate() ? "instant" : "time of day";
      track_.columns.push_back(std::move(column));
    }
    JoinDateAndTime();
    TakeMoves();
    TakeSecondsOfArc(track_, recording_.remarks);
    FindClock(clock_, recording_.file, track_);
    recording_.tracks.push_back(std::move(track_));
    gatherers_.clear();
  }

  /// From where on the readings count, by the first numbers of the lines that say so.
  void TakeMoves() {
    if (layout_.moved_by.empty()) return;
    Column moved{"moved", "", std::vector<double>(track_.Rows(), 0.0), {}};
    for (const TextLine& line : track_.lines) {
      if (!std::string_view(line.text).starts_with(layout_.moved_by)) continue;
      Split(std::string_view(line.text).substr(layout_.moved_by.size()), how_.separator, fields_);
      const double by = FieldNumber(Trimmed(fields_[0]), how_.decimal_comma).value_or(0.0);
      for (std::size_t i = line.row; i < moved.value.size(); ++i) moved.value[i] += by;
    }
    track_.columns.push_back(std::move(moved));
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
    if (const std::string quantity = rows_ == 0 && named_ ? OneQuantity(text_) : ""; !quantity.empty())
      throw InputError(recording_.file, fmt::format("each line states one quantity, \"{}\", and nothing beside it", quantity),
                       "two at least: where the device should be, or a reference is, and what the device shows");
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
  std::vector<std::string_view> above_, fields_, waiting_lines_;
  std::vector<std::vector<std::string_view>> waiting_;
  std::vector<Gatherer> gatherers_;
  std::size_t width_ = 0, rows_ = 0, misfits_ = 0, text_lines_ = 0;
};

}  // namespace

void ReadTable(std::string_view text, const Layout& layout, const ClockSettings& clock, Recording& recording) {
  TableReader(text, layout, clock, recording).Read();
}

}  // namespace twinbench::imports
