#pragma once

#include <cstdint>
#include <map>
#include <string>

/// The measured widths of an A/D converter's codes, from a CSV file.
namespace twinbench::sim {

/// Reads columns `code` (whole, increasing, 0 in the middle of the range) and either `width` [LSB] or `dnl_lsb`,
/// the width less one. A width of 0 is a code that never comes.
/// @param bits  Of the converter, whose codes are -2^(bits-1) .. 2^(bits-1) - 1.
/// @return by code how much wider than one LSB it is; codes that the file leaves out are as wide as they should be.
/// @throws InputError if the file cannot be read, lacks a column, has both or no rows, or a row's code is none of
/// the
///         converter's or not above the one before, or its width is negative.
std::map<std::int32_t, double> ReadExcessWidths_lsb(const std::string& path, int bits);

}  // namespace twinbench::sim
