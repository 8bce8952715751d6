#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "twin/core/number_text.h"
#include "twin/core/reading.h"

/// The columns of readings.csv. A bench lists its own in the order in which they are written; unit and place of
/// each stand here once, for both ways.
namespace twinbench {

enum class ColumnRole {
  kRequired,  // must be there, with a value in every row
  kShown,     // what the bench showed: must be there; where it is empty the reading is missing
  kShownToo,  // likewise, but it may be left out, and a reading without it is whole
  kOptional,  // circumstances
};

struct ReadingColumn {
  std::string name;  // with its unit: "target_deg"
  ColumnRole role = ColumnRole::kOptional;
  std::function<std::string(const Reading&)> print;         // empty: not available
  std::function<bool(Reading&, const std::string&)> parse;  // false: not what is expected
  std::string expected;
  std::function<double&(Reading&)> number = {};  // where its number lives in a reading; empty: it is none
  bool may_be_absent = false;  // of what was shown: a run may have none of it

  bool MustBeThere() const {
    return role == ColumnRole::kRequired || (role == ColumnRole::kShown && !may_be_absent);
  }
  bool MayBeEmpty() const { return role != ColumnRole::kRequired; }
  /// Of a reading that has no numbers these are not kept.
  bool IsShown() const { return role == ColumnRole::kShown || role == ColumnRole::kShownToo; }
  /// What another instrument shows in the place of the bench's own: few runs have it, and those that do have nothing
  /// else. It is written only where it was read.
  bool IsOfAnotherInstrument() const { return may_be_absent && role == ColumnRole::kShownToo; }
};

/// The place of a quantity that has no field of its own in a reading.
struct Quantity {
  std::string column;
  double& operator()(Reading& r) const {
    for (auto& [name, value] : r.quantities) {
      if (name == column) return value;
    }
    return r.quantities.emplace_back(column, kNaN).second;
  }
  double operator()(const Reading& r) const {
    for (const auto& [name, value] : r.quantities) {
      if (name == column) return value;
    }
    return kNaN;
  }
};

/// @param field  Gives the number's place in a reading, as in `[](auto& r) -> auto& { return r.dwell_s; }`, or a
///               Quantity.
template <class Field>
ReadingColumn NumberColumn(const std::string& name, double to_SI, ColumnRole role, Field field) {
  ReadingColumn column;
  column.name = name;
  column.role = role;
  column.print = [=](const Reading& r) { return std::isfinite(field(r)) ? PrintInUnit(field(r), to_SI) : ""; };
  column.parse = [=](Reading& r, const std::string& text) {
    if (const auto number = ParseInUnit(text, to_SI)) field(r) = *number;
    return std::isfinite(field(r));
  };
  column.expected = "a finite number";
  column.number = [=](Reading& r) -> double& { return field(r); };
  return column;
}

/// What the bench showed.
/// @param unit  For messages: "deg".
template <class Field>
ReadingColumn ShownColumn(const std::string& name, double to_SI, const std::string& unit, Field field) {
  ReadingColumn column = NumberColumn(name, to_SI, ColumnRole::kShown, field);
  column.expected = "a finite number of " + unit + ", or nothing";
  return column;
}

inline constexpr const char* kStatusColumn = "status";

/// The columns that every bench has: which reading it is, where it stands in the run, and its status.
/// @param rest  A reading may be taken at rest: 0 is a direction too.
std::vector<ReadingColumn> CommonColumns(bool rest);

/// n_samples, dwell_s and temperature_degC.
std::vector<ReadingColumn> ConditionColumns();

/// One list after the other.
std::vector<ReadingColumn> Joined(std::vector<std::vector<ReadingColumn>> lists);

/// Seconds with all nine decimals that are not zero, so that every nanosecond survives.
std::string PrintTime(Time time);

}  // namespace twinbench
