#pragma once

#include <string>
#include <vector>

/// Errors of an angle that repeat with the turn of a part.
namespace twinbench::mechanics {

/// amplitude cos(order angle + phase); the order counts periods a turn of the part that causes it.
struct AngleHarmonic {
  double order = 1.0;
  double amplitude_rad = 0.0;
  double phase_rad = 0.0;
};

/// A sum of harmonics and its derivatives by the angle, at one angle.
struct AngleSeries {
  double value_rad = 0.0;
  double slope = 0.0;
  double bend_1_rad = 0.0;
};

AngleSeries Evaluate(const std::vector<AngleHarmonic>& harmonics, double angle_rad);

/// @throws std::invalid_argument, naming `where`, unless all is finite.
void Check(const std::vector<AngleHarmonic>& harmonics, const std::string& where);

}  // namespace twinbench::mechanics
