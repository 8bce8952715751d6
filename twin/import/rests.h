#pragma once

#include <cstddef>
#include <vector>

#include "twin/import/course.h"

/// Rests of a command, and when the device that follows it stands.
namespace twinbench::imports {

struct Rest {
  std::size_t begin = 0, end = 0;  // rows in which the command rests
  std::size_t stands = 0;          // from here on the device does too; without a device a third is left to it
  bool arrives = true;             // false: it is still on its way when the command goes on
};

/// @param shown  What the device shows [rad], whole turns aside where `turn_rad` is positive; empty: there is none.
///
/// The device stands where it ends: within six standard deviations of its own noise of the median of the last tenth of
/// the rest. It has not arrived if it goes on by more than 1/50 of the command's step, and twice its own spread, between the
/// last tenth and the one before. At least the first third of a rest is left out.
std::vector<Rest> RestsOf(const Course& course, const std::vector<double>& shown, double turn_rad);

/// So many rows at the beginning of a recording at one place are of the way there: a twentieth of a turn or more from where the device
/// ends, or half of the place itself, and three times as far as it ever goes in the second half. What drifts goes less far.
std::size_t RowsOnTheWay(std::vector<double> shown, double place_rad, double turn_rad);

}  // namespace twinbench::imports
