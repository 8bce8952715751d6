#pragma once

#include <string>
#include <string_view>
#include <vector>

/// The text that software of ball bars exports (`.b5r` and its kin): tags with the conditions of the test, then for
/// each run its values, one a line at even steps of the angle.
namespace twinbench::imports {

/// True of tags that say a radius and a feed, an angle or a way round, and of lines of one number behind them.
bool IsBarExport(const std::vector<std::string_view>& lines);

/// The same as a table of angle, deviation and conditions. Tags that are not known say nothing.
/// @param said  What was taken for granted, a line each.
/// @throws InputError if no run has values.
std::string TableOfBarExport(std::string_view text, const std::string& file, std::vector<std::string>& said);

}  // namespace twinbench::imports
