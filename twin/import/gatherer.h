#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "twin/import/heading.h"
#include "twin/import/text.h"

/// What the cells of a table's column are, and the column while it is read.
namespace twinbench::imports {

enum class Kind { kNumber, kInstant, kWord, kDegreesOfColons };

/// A column while it is read.
class Gatherer {
 public:
  explicit Gatherer(Kind kind) : kind_(kind) {}

  void Take(std::string_view field, bool decimal_comma);
  Kind kind() const { return kind_; }
  std::size_t size() const { return values_.size(); }
  bool HasDate() const { return has_date_; }
  std::vector<double> TakeValues() { return std::move(values_); }
  std::vector<std::string> TakeWords() { return std::move(words_); }

  /// That its cells have, of the first one.
  std::string UnitOfCells() const { return unit_; }

 private:
  void TakeNumber(std::string_view field, bool decimal_comma);
  void TakeInstant(std::string_view field);
  void TakeWord(std::string_view field);

  Kind kind_;
  std::vector<double> values_;
  std::vector<std::string> words_;
  std::map<std::string, double, std::less<>> number_;
  std::string unit_;
  double midnight_s_ = 0.0;
  bool has_date_ = false;
};

/// Kinds of the columns by a few rows, and by their names: "12:30:15" below "reference" or "angle [deg]" is an angle.
std::vector<Kind> KindsOf(const std::vector<std::vector<std::string_view>>& rows, const Heading& heading, const Fields& how);

/// Most of a row's fields hold something that is no name.
bool IsRow(const std::vector<std::string_view>& fields, const Fields& how);

}  // namespace twinbench::imports
