#include "twin/core/reading_column.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>

namespace twinbench {
namespace {

template <class Field>
ReadingColumn WholeNumber(const std::string& name, ColumnRole role, Field field) {
  return {name, role, [=](const Reading& r) { return fmt::format("{}", field(r)); },
          [=](Reading& r, const std::string& text) {
            const auto number = ParseWholeNumber(text);
            if (!number || *number < 0 || *number > std::numeric_limits<int>::max()) return false;
            field(r) = static_cast<int>(*number);
            return true;
          },
          "a whole number, 0 or more"};
}

/// In extended precision: a double loses nanoseconds after 104 days.
bool ParseTime(Time& time, const std::string& text) {
  long double time_s = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), time_s);
  if (error != std::errc() || end != text.data() + text.size()) return false;
  if (!(std::abs(time_s) < 9.2e9L)) return false;  // 2^63 ns
  time = Time(Duration(std::llround(time_s * 1e9L)));
  return true;
}

ReadingColumn Direction(bool rest) {
  const auto parse = [rest](Reading& reading, const std::string& text) {
    const auto direction = ParseWholeNumber(text);
    if (!direction || *direction < -1 || *direction > 1 || (*direction == 0 && !rest)) return false;
    reading.direction = static_cast<int>(*direction);
    return true;
  };
  return {"direction", ColumnRole::kRequired, [](const Reading& r) { return fmt::format("{}", r.direction); },
          parse, rest ? "1, -1 or 0 (at rest)" : "1 or -1"};
}

/// Takes over the value of a name that has been looked up; false if there was none.
template <class Value>
bool Assign(Value& field, const std::optional<Value>& found) {
  if (found) field = *found;
  return found.has_value();
}

ReadingColumn StartTime() {
  return {"time_s", ColumnRole::kRequired, [](const Reading& r) { return PrintTime(r.time); },
          [](Reading& r, const std::string& text) { return ParseTime(r.time, text); },
          "seconds since the start of the run"};
}

ReadingColumn PhaseColumn() {
  return {"phase", ColumnRole::kRequired, [](const Reading& r) { return std::string(PhaseName(r.phase)); },
          [](Reading& r, const std::string& text) { return Assign(r.phase, PhaseOf(text)); },
          "calibration, full_circle, stability or verification"};
}

ReadingColumn StatusColumn() {
  return {kStatusColumn, ColumnRole::kOptional,
          [](const Reading& r) { return std::string(ReadingStatusName(r.status)); },
          [](Reading& r, const std::string& text) { return Assign(r.status, ReadingStatusOf(text)); },
          "ok, saturated, no_light, clipped_spot, overrun or missing"};
}

}  // namespace

std::string PrintTime(Time time) {
  const std::int64_t count_ns = time.time_since_epoch().count();
  const std::uint64_t size_ns = count_ns < 0 ? ~static_cast<std::uint64_t>(count_ns) + 1 : count_ns;
  std::string text = fmt::format("{}{}.{:09}", count_ns < 0 ? "-" : "", size_ns / 1000000000, size_ns % 1000000000);
  text.erase(text.find_last_not_of('0') + 1);
  return text.back() == '.' ? text + '0' : text;
}

std::vector<ReadingColumn> CommonColumns(bool rest) {
  constexpr ColumnRole kRequired = ColumnRole::kRequired;
  return {WholeNumber(
              "reading", kRequired, [](auto& r) -> auto& { return r.reading; }),
          StartTime(),
          WholeNumber(
              "setup", kRequired, [](auto& r) -> auto& { return r.setup; }),
          WholeNumber(
              "pass", kRequired, [](auto& r) -> auto& { return r.pass; }),
          Direction(rest),
          WholeNumber(
              "position", kRequired, [](auto& r) -> auto& { return r.position; }),
          PhaseColumn(),
          StatusColumn()};
}

std::vector<ReadingColumn> ConditionColumns() {
  constexpr ColumnRole kOptional = ColumnRole::kOptional;
  ReadingColumn samples = WholeNumber(
      "n_samples", kOptional, [](auto& r) -> auto& { return r.n_samples; });
  samples.print = [](const Reading& r) { return r.n_samples > 0 ? fmt::format("{}", r.n_samples) : ""; };
  return {samples,
          NumberColumn(
              "dwell_s", 1.0, kOptional, [](auto& r) -> auto& { return r.dwell_s; }),
          NumberColumn(
              "temperature_degC", 1.0, kOptional, [](auto& r) -> auto& { return r.temperature_degC; })};
}

std::vector<ReadingColumn> Joined(std::vector<std::vector<ReadingColumn>> lists) {
  std::vector<ReadingColumn> all;
  for (std::vector<ReadingColumn>& list : lists)
    all.insert(all.end(), std::make_move_iterator(list.begin()), std::make_move_iterator(list.end()));
  return all;
}

}  // namespace twinbench
