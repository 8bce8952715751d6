#pragma once

#include <string_view>
#include <vector>

#include "twin/import/unit_names.h"

/// The names above a table's rows.
namespace twinbench::imports {

/// Names with units, the units perhaps from a row of their own.
struct Heading {
  std::vector<NameAndUnit> columns;
  bool found = false;
};

Heading HeadingOf(const std::vector<std::string_view>& fields);

/// The nearest line above the rows with a name for each column; one between may have the units.
/// @param above  The lines above the rows.
/// @param width  Fields of a row.
Heading FindHeading(const std::vector<std::string_view>& above, std::size_t width, char separator);

/// A line without the mark of a comment before it.
std::string_view WithoutMark(std::string_view line);

}  // namespace twinbench::imports
