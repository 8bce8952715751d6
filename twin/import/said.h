#pragma once

#include <string>

#include "twin/import/map.h"

/// What a quantity of the bench was taken from, in the words of the map or the file: for messages.
namespace twinbench::imports {

/// Where the map says it, or the expression in quotes.
std::string NameOf(const Map& map, const std::string& column);

/// To be used inside a formula: "[position]", "(counts * 360 / 4096)".
std::string ExpressionOf(const Map& map, const std::string& column);

/// The key with the unit that counted: "measured_arcsec".
std::string KeyOf(const Map& map, const std::string& column);

}  // namespace twinbench::imports
