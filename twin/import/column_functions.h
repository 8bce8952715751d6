#pragma once

#include <string>
#include <string_view>
#include <vector>

/// The functions of formulas that look at columns as wholes; expression.h says what each is.
namespace twinbench::imports {

using OfColumn = std::vector<double> (*)(std::vector<double> x, const std::string& where);
using OfColumns = std::vector<double> (*)(const std::vector<double>& a, const std::vector<double>& b,
                                          const std::string& where);

/// nullptr: none is called so.
OfColumn ColumnFunction(std::string_view name);
OfColumns ColumnsFunction(std::string_view name);

}  // namespace twinbench::imports
