#pragma once

#include <string>
#include <vector>

/// Functions of a map's formulas about speeds that are kept.
namespace twinbench::imports {

/// The middle of all, to three digits.
std::vector<double> Whole(std::vector<double> x, const std::string& where);

/// Each row's level: of those at which a twentieth of the rows stays, to a few percent, the nearest one.
std::vector<double> Levels(std::vector<double> x, const std::string& where);

/// 1 in rows whose speed is not at its level, or no number, or has come to it so lately that an axis which lags has yet to take that up;
/// 0 in all others.
/// @param time_s  Of each row.
std::vector<double> Unsteady(const std::vector<double>& speed, const std::vector<double>& time_s, const std::string& where);

}  // namespace twinbench::imports
