#pragma once

#include <string>
#include <vector>

/// The circle on which most rows of a log lie, whatever stands before and behind it: functions of a map's formulas.
namespace twinbench::imports {

/// Its middle in the direction of x.
/// @throws InputError if there is no such circle.
std::vector<double> CircleMiddle(const std::vector<double>& x, const std::vector<double>& y, const std::string& where);

/// To six digits.
/// @throws InputError if there is no such circle.
std::vector<double> CircleRadius(const std::vector<double>& x, const std::vector<double>& y, const std::string& where);

}  // namespace twinbench::imports
