#include "twin/import/gatherer.h"

#include <algorithm>

#include "twin/core/reading.h"
#include "twin/import/clock.h"
#include "twin/import/column_words.h"
#include "twin/import/common.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {

namespace {
constexpr std::size_t kMostWords = 1000;  // different ones; a column with more is free text
/// By what the column is called: an angle, or a quantity of the bench that is no time.
bool IsCalledAngle(const NameAndUnit& column) {
  const auto unit = UnitNamed(column.unit);
  const std::string name = SmallLetters(column.name), unit_text = SmallLetters(column.unit);
  if (unit) return unit->dimension == Dimension::kAngle;
  if (name.find("time") != std::string::npos || name.find("zeit") != std::string::npos) return false;
  return unit_text.starts_with("d") || unit_text.starts_with("°") || Clearness(column.name, Speaks::kReference) > 0 ||
         Clearness(column.name, Speaks::kDevice) > 0;
}

/// Degrees with minutes and seconds in every cell, and no time of day by the name or by the size.
bool AreDegreesOfColons(const std::vector<std::vector<std::string_view>>& rows, std::size_t column, const Heading& heading, const Fields& how) {
  bool called = column < heading.columns.size() && IsCalledAngle(heading.columns[column]);
  std::size_t cells = 0;
  for (const auto& row : rows) {
    if (column >= row.size() || row[column].empty()) continue;
    if (!DegreesOfColons(row[column], how.decimal_comma)) return false;
    called = called || !ParseInstant(row[column]);
    ++cells;
  }
  return called && cells > 0;
}

}  // namespace

void Gatherer::Take(std::string_view field, bool decimal_comma) {
  if (kind_ == Kind::kNumber) {
    TakeNumber(field, decimal_comma);
  } else if (kind_ == Kind::kInstant) {
    TakeInstant(field);
  } else if (kind_ == Kind::kDegreesOfColons) {
    values_.push_back(DegreesOfColons(field, decimal_comma).value_or(kNaN));
  } else {
    TakeWord(field);
  }
}

void Gatherer::TakeNumber(std::string_view field, bool decimal_comma) {
  const auto cell = CellOf(field, decimal_comma);
  values_.push_back(cell ? cell->number : kNaN);
  if (!cell || cell->unit.empty() || cell->unit == unit_) return;
  if (unit_.empty()) unit_ = cell->unit;
  const auto own = UnitNamed(cell->unit), first = UnitNamed(unit_);
  values_.back() *= own->dimension == first->dimension ? own->to_SI / first->to_SI : kNaN;
}

/// A clock without a date that jumps back has passed midnight.
void Gatherer::TakeInstant(std::string_view field) {
  const auto instant = ParseInstant(field);
  double time_s = instant ? instant->time_s : kNaN;
  has_date_ = has_date_ || (instant && instant->has_date);
  if (instant && !instant->has_date) {
    if (!values_.empty() && time_s + midnight_s_ < values_.back() - 43200.0) midnight_s_ += 86400.0;
    time_s += midnight_s_;
  }
  values_.push_back(time_s);
}

void Gatherer::TakeWord(std::string_view field) {
  const auto found = number_.find(field);
  if (found != number_.end()) return values_.push_back(found->second);
  if (words_.size() >= kMostWords) return values_.push_back(kNaN);
  number_.emplace(std::string(field), static_cast<double>(words_.size()));
  values_.push_back(static_cast<double>(words_.size()));
  words_.emplace_back(field);
}

std::vector<Kind> KindsOf(const std::vector<std::vector<std::string_view>>& rows, const Heading& heading, const Fields& how) {
  std::vector<Kind> kinds;
  for (std::size_t c = 0; c < rows.front().size(); ++c) {
    if (AreDegreesOfColons(rows, c, heading, how)) {
      kinds.push_back(Kind::kDegreesOfColons);
      continue;
    }
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

bool IsRow(const std::vector<std::string_view>& fields, const Fields& how) {
  if (fields.size() < 2) return !fields.empty() && CellOf(fields[0], how.decimal_comma);
  const auto numbers = std::ranges::count_if(fields, [&how](std::string_view field) {
    return CellOf(field, how.decimal_comma).has_value() || ParseInstant(field).has_value() || DegreesOfColons(field, how.decimal_comma).has_value();
  });
  return numbers >= 1 && (CellOf(fields[0], how.decimal_comma) || ParseInstant(fields[0]) ||
                          2 * numbers >= std::ssize(fields));
}

}  // namespace twinbench::imports
