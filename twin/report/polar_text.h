#pragma once

#include <string>
#include <vector>

namespace twinbench::report {

/// Values over an angle, drawn with one mark.
struct PolarSeries {
  char mark = '+';
  std::vector<double> angle_rad;  // counter-clockwise from the right
  std::vector<double> value;      // in the unit of the plot; NaN: left out
};

/// A polar plot of characters: a circle of dots where the value is zero, values outside of it positive and
/// magnified so that the largest fill the plot. Where two series meet stands a `#`.
/// @param unit  Of the values: "um".
/// @return lines; the last one says what the distance from the circle means. Without a finite value there is none.
std::string PolarText(const std::vector<PolarSeries>& series, const std::string& unit);

}  // namespace twinbench::report
