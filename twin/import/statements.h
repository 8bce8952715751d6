#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "twin/import/recording.h"
#include "twin/import/unit_names.h"

/// What lines of text say of the rows below them.
namespace twinbench::imports {

/// A number with its unit behind a word: "Radius [mm]: 150", "feed rate = 1000 mm/min". Empty: it says no unit.
struct Statement {
  double number = 0.0;
  std::string unit;
};
/// @param word  In small letters; what it says has to fit the dimension.
std::optional<Statement> StatementIn(const std::string& line, const std::string& word, Dimension dimension);

/// What all lines state one number of: "Servo position: 45". Empty: they state several things, or something else.
std::string OneQuantity(std::string_view text);

/// One value a row: that of the last line above it that says one; NaN above the first.
/// @param words  In small letters, the clearest first; the first that any line speaks of counts.
/// @param to     The unit of the values.
std::vector<double> StatedValues(const Track& track, const std::vector<std::string>& words, const NamedUnit& to);

/// The way round that lines speak of, likewise.
std::vector<double> StatedTurns(const Track& track);

}  // namespace twinbench::imports
