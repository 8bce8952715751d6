#include "twin/import/layouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <deque>
#include <functional>
#include <optional>

#include "twin/core/errors.h"
#include "twin/core/reading.h"
#include "twin/core/units.h"
#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/statements.h"
#include "twin/import/text.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

constexpr std::size_t kFewestValues = 12;  // lines of numbers that are a run
constexpr double kWhole_deg = 360.0;

/// What tags say of the runs behind them.
struct BarTest {
  double radius_mm = kNaN, feed_mm_min = kNaN, start_deg = kNaN, end_deg = kNaN, arc_deg = kNaN,
         overshoot_deg = kNaN;
  double samples_Hz = kNaN, temperature_degC = kNaN;

  double Start() const { return std::isfinite(start_deg) ? start_deg : 0.0; }
  double Arc() const {
    if (std::isfinite(arc_deg)) return arc_deg;
    if (!std::isfinite(end_deg)) return kWhole_deg;
    const double arc = std::abs(end_deg - Start());
    return arc > 0.0 ? arc : kWhole_deg;
  }
};

struct BarTag {
  double BarTest::*field;
  Dimension dimension;
  double to_SI;  // of the field
  std::vector<std::string> words;
};

const std::vector<BarTag>& BarTags() {
  static const std::vector<BarTag> tags = {
      {&BarTest::radius_mm,
       Dimension::kLength,
       units::mm,
       {"test radius", "testradius", "nominal radius", "nominalradius", "radius", "bar length", "barlength",
        "ballbar length", "ballbarlength", "nominal length", "nominallength"}},
      {&BarTest::feed_mm_min,
       Dimension::kSpeed,
       units::mm / 60.0,
       {"feedrate", "feed rate", "feed_rate", "feed", "vorschub"}},
      {&BarTest::start_deg,
       Dimension::kAngle,
       units::deg,
       {"start angle", "startangle", "start_angle", "angle start", "startwinkel"}},
      {&BarTest::end_deg,
       Dimension::kAngle,
       units::deg,
       {"end angle", "endangle", "end_angle", "stop angle", "stopangle", "stop_angle", "angle end", "endwinkel"}},
      {&BarTest::arc_deg,
       Dimension::kAngle,
       units::deg,
       {"data arc", "dataarc", "data_arc", "capture arc", "capturearc", "capture_arc"}},
      {&BarTest::overshoot_deg,
       Dimension::kAngle,
       units::deg,
       {"overshoot arc", "overshootarc", "overshoot_arc", "overshoot angle", "overshootangle", "overshoot",
        "overrun"}},
      {&BarTest::samples_Hz,
       Dimension::kPure,
       1.0,
       {"sample rate", "samplerate", "sample_rate", "sampling rate", "samplingrate", "sampling_rate",
        "sample frequency", "sampling frequency", "samplingfrequency"}},
      {&BarTest::temperature_degC, Dimension::kTemperature, 1.0, {"temperature", "temp", "temperatur"}}};
  return tags;  // constant
}

/// "<v>1.25</v>" is 1.25 as well.
std::optional<double> ValueIn(std::string_view line) {
  line = Trimmed(line);
  if (line.starts_with('<') && line.find('>') < line.rfind('<'))
    line = line.substr(line.find('>') + 1, line.rfind('<') - line.find('>') - 1);
  while (!line.empty() && std::string_view(",; \t").find(line.back()) != std::string_view::npos)
    line.remove_suffix(1);
  const auto marks = std::ranges::count_if(line, [](char c) { return c == '.' || c == ','; });
  if (marks > 1 || line.find_first_of(" \t") != std::string_view::npos)
    return std::nullopt;  // two numbers, or one with marks of thousands
  return FieldNumber(line, line.find(',') != std::string_view::npos);
}

/// "10,5", "11,7": angles and whole numbers behind a comma.
bool ArePairsOfNumbers(const std::vector<std::string_view>& lines) {
  std::vector<double> first;
  for (const std::string_view line : lines)
    if (line.find(',') != std::string_view::npos) first.push_back(std::trunc(*ValueIn(line)));
  return first.size() == lines.size() && std::ranges::adjacent_find(first, std::greater_equal()) == first.end();
}

/// @return whether the line is a known tag.
bool TakeTag(const std::string& line, BarTest& test) {
  if (std::ranges::none_of(line, [](unsigned char c) { return std::isalpha(c); })) return false;
  for (const BarTag& tag : BarTags()) {
    for (const std::string& word : tag.words) {
      const auto statement = StatementIn(line, word, tag.dimension);
      if (!statement) continue;
      const auto unit = UnitNamed(statement->unit);
      const bool is_own = unit && unit->dimension == tag.dimension && tag.dimension != Dimension::kPure;
      test.*tag.field = is_own ? statement->number * unit->to_SI / tag.to_SI : statement->number;
      return true;
    }
  }
  return false;
}

bool IsTag(const std::string& line) {
  BarTest none;
  return TakeTag(line, none);
}

/// The unit that a tag gives the values: "Units: mm", "data units=microns".
std::optional<NamedUnit> UnitOfValues(const std::string& line) {
  const std::string small = SmallLetters(line);
  if (small.find("unit") == std::string::npos && small.find("einheit") == std::string::npos) return std::nullopt;
  const std::size_t sign = line.find_last_of("=:<;,\t ");
  if (sign == std::string::npos) return std::nullopt;
  const std::size_t closed = line.find('>');
  const bool is_element = closed != std::string::npos && line.rfind('<') > closed;
  const auto unit = UnitNamed(is_element ? std::string_view(line).substr(closed + 1, line.rfind('<') - closed - 1)
                                         : Trimmed(std::string_view(line).substr(sign + 1)));
  return unit && unit->dimension == Dimension::kLength ? unit : std::nullopt;
}

struct BarRun {
  BarTest test;
  int turn = 0;  // 0: not said
  std::vector<double> values;
};

/// Goes through the lines once.
class BarReader {
 public:
  explicit BarReader(std::string_view text) {
    Lines lines(text);
    for (std::string_view line; lines.Next(line);) Take(line);
    End();
  }
  const std::vector<BarRun>& runs() const { return runs_; }
  const std::optional<NamedUnit>& unit() const { return unit_; }

 private:
  void Take(std::string_view line) {
    if (Trimmed(line).empty()) return;
    const std::string text(line);
    if (const auto value = ValueIn(line); value && !IsTag(text)) return values_.push_back(*value);
    End();
    if (const auto unit = UnitOfValues(text)) unit_ = unit;
    const bool is_known = TakeTag(text, test_);
    if (const int turn = TurnIn(text); turn != 0 && !is_known) turns_.push_back(turn);
  }

  /// Ways round may be said above each run, or above the first one for all.
  void End() {
    if (values_.size() >= kFewestValues) {
      if (!turns_.empty()) turn_ = turns_.front();
      if (turns_.size() > 1)
        turns_.pop_front();
      else
        turns_.clear();
      runs_.push_back({test_, turn_, values_});
    }
    values_.clear();
  }

  BarTest test_;
  std::deque<int> turns_;
  int turn_ = 0;
  std::vector<double> values_;
  std::vector<BarRun> runs_;
  std::optional<NamedUnit> unit_;
};

/// Of the values, those before and behind the arc that are its overshoot: as many as the sampling says.
std::size_t OvershootOf(const BarRun& run) {
  const BarTest& t = run.test;
  const double step_deg = t.feed_mm_min / 60.0 / t.samples_Hz / t.radius_mm / units::deg;
  if (!(t.overshoot_deg > 0.0) || !std::isfinite(step_deg)) return 0;
  const double gone_deg = step_deg * static_cast<double>(run.values.size()),
               all_deg = t.Arc() + 2.0 * t.overshoot_deg;
  if (std::abs(gone_deg - all_deg) > std::abs(gone_deg - t.Arc())) return 0;
  return static_cast<std::size_t>(std::lround(t.overshoot_deg / all_deg * static_cast<double>(run.values.size())));
}

/// A circle's last value may be its first place again: the step is the rounder one of both.
double StepOf(double arc_deg, std::size_t values) {
  const double between = arc_deg / static_cast<double>(values),
               with_end = arc_deg / static_cast<double>(values - 1);
  const auto off = [](double step) { return std::abs(step * 1000.0 - std::round(step * 1000.0)); };
  return arc_deg >= kWhole_deg && off(between) < off(with_end) ? between : with_end;
}

void AppendRows(const BarRun& run, std::size_t number, const std::string& columns, std::string& table) {
  const std::size_t overshoot = OvershootOf(run), count = run.values.size() - 2 * overshoot;
  const double step_deg = StepOf(run.test.Arc(), count), arc_deg = step_deg * static_cast<double>(count - 1);
  for (std::size_t k = 0; k < count; ++k) {
    const double gone_deg = step_deg * static_cast<double>(k),
                 at_deg = run.test.Start() + (run.turn < 0 ? arc_deg - gone_deg : gone_deg);
    table += fmt::format("{},{:.6f},{}", number, at_deg, run.values[k + overshoot]);
    if (run.turn != 0) table += fmt::format(",{}", run.turn);
    for (const auto& [name, field] :
         {std::pair{"radius", &BarTest::radius_mm}, std::pair{"feed", &BarTest::feed_mm_min},
          std::pair{"temperature", &BarTest::temperature_degC}})
      if (columns.find(name) != std::string::npos) table += fmt::format(",{}", run.test.*field);
    table += "\n";
  }
}

}  // namespace

bool IsBarExport(const std::vector<std::string_view>& lines) {
  BarTest test;
  std::size_t tags = 0;
  std::vector<std::string_view> values;
  bool turns = false;
  for (const std::string_view line : lines) {
    if (ValueIn(line) && !IsTag(std::string(line))) {
      values.push_back(line);
      if (values.size() >= kFewestValues) break;
      continue;
    }
    values.clear();
    tags += TakeTag(std::string(line), test);
    turns |= TurnIn(std::string(line)) != 0;
  }
  const bool is_circle = std::isfinite(test.feed_mm_min) || std::isfinite(test.start_deg) || turns;
  return values.size() >= kFewestValues && !ArePairsOfNumbers(values) && tags > 0 &&
         std::isfinite(test.radius_mm) && is_circle;
}

std::string TableOfBarExport(std::string_view text, const std::string& file, std::vector<std::string>& said) {
  const BarReader reader(text);
  const std::vector<BarRun>& runs = reader.runs();
  if (runs.empty())
    throw InputError(file, "no run of the ball bar has values",
                     fmt::format("{} lines of one number and more behind its tags", kFewestValues));
  const auto all = [&runs](auto has) { return std::ranges::all_of(runs, has); };
  const bool turns = all([](const BarRun& run) { return run.turn != 0; });
  const bool lengths = all([](const BarRun& run) { return MedianOf(run.values) > 0.5 * run.test.radius_mm; });
  const NamedUnit unit = reader.unit().value_or(*UnitNamed(lengths ? "mm" : "um"));
  std::string header = fmt::format("run,angle [deg],{} [{}]{}", lengths ? "length" : "deviation", unit.name,
                                   turns ? ",direction" : "");
  for (const auto& [name, field] :
       {std::pair{",radius [mm]", &BarTest::radius_mm}, std::pair{",feed [mm/min]", &BarTest::feed_mm_min},
        std::pair{",temperature [degC]", &BarTest::temperature_degC}})
    if (all([f = field](const BarRun& run) { return std::isfinite(run.test.*f); })) header += name;
  if (!reader.unit()) said.push_back(fmt::format("no tag says the unit of the values: taken as {}", unit.name));
  said.push_back(
      "angles are not in the file: values are taken at even steps, of a clockwise run from the end of its arc "
      "back");
  std::string table = header + "\n";
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const BarTest& t = runs[k].test;
    BarRun run = runs[k];
    if (!turns) run.turn = 0;
    AppendRows(run, k + 1, header, table);
    said.push_back(
        fmt::format("run {}: {} values from {:g} deg over {:g} deg, {} of overshoot at either end left out", k + 1,
                    run.values.size(), t.Start(), t.Arc(), OvershootOf(run)));
  }
  return table;
}

}  // namespace twinbench::imports
