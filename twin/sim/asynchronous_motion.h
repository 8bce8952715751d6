#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mechanics/chain.h"

namespace twinbench::sim {

/// Root mean squares of what a bearing does not repeat from turn to turn; one of two tables.
struct AsynchronousSettings {
  double radial_m = 0.0;  // along each of x and y
  double axial_m = 0.0;
  double tilt_rad = 0.0;  // about each of x and y
};

/// Asynchronous error motion (ISO 230-7, 3.2.3): the part of a bearing's motion at frequencies that are no whole
/// multiple of the rotation's. Waves along the angle the rotor has turned through in all, of 24 orders between
/// whole ones whose amplitudes fall as 1 / (1 + order), with phases from the seed, of their own for each of the
/// five motions. It moves as the rotor turns and stands when it stands; another turn finds another value.
class AsynchronousMotion {
 public:
  static constexpr int kWaves = 24;

  /// @param name  "target" or "reference": begins the name of its random stream.
  AsynchronousMotion(const AsynchronousSettings& settings, std::uint64_t seed, const std::string& name);

  /// In the frame of the bearing's stator. @param rotor_rad  Unwrapped.
  mechanics::BearingPose At(double rotor_rad) const;

 private:
  static constexpr int kMotions = 5;  // x, y, z, rx, ry
  struct Wave {
    double order;
    std::array<double, kMotions> cosine, sine;
  };

  std::vector<Wave> waves_;
};

}  // namespace twinbench::sim
