#pragma once

#include "mechanics/plant.h"

/// Units of the room's tests, and what those of plants share and compare.
namespace twinbench::mechanics {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kDegree = kPi / 180.0;
inline constexpr double kArcsec = kDegree / 3600.0;
inline constexpr double kMicrometre = 1e-6;

inline constexpr std::array<Fidelity, 3> kAll = {Fidelity::kKinematic, Fidelity::kLinear, Fidelity::kBullet};
inline constexpr std::array<Fidelity, 2> kBodies = {Fidelity::kLinear, Fidelity::kBullet};
inline constexpr double kTenDegrees = 10.0 * kDegree;

/// The default stack with 1.5 kg at 40 mm from the reference's axis.
inline StackParameters EccentricStack() {
  StackParameters p;
  p.payload.mass_kg = 1.5;
  p.payload.radius_m = 0.040;
  return p;
}

inline std::array<double, 14> Numbers(const StackState& s) {
  const BearingPose &t = s.target_bearing, &r = s.reference_bearing;
  return {s.target_rad, s.reference_rad, s.target_encoder_rad, s.reference_encoder_rad,
          t.x_m, t.y_m, t.z_m, t.rx_rad, t.ry_rad, r.x_m, r.y_m, r.z_m, r.rx_rad, r.ry_rad};
}

/// Largest difference of angles and tilts [rad] and of positions [m].
struct Difference {
  double yaw_rad = 0.0, tilt_rad = 0.0, position_m = 0.0;

  void Include(const StackState& a, const StackState& b) {
    const auto x = Numbers(a), y = Numbers(b);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const bool tilt = i == 7 || i == 8 || i >= 12;
      double& worst = i < 4 ? yaw_rad : tilt ? tilt_rad : position_m;
      worst = std::max(worst, std::abs(x[i] - y[i]));
    }
  }
  /// Both go on side by side.
  void GoOn(Plant& a, Plant& b, int steps, double step_s) {
    for (int k = 0; k < steps; ++k) {
      a.Advance(step_s);
      b.Advance(step_s);
      Include(a.State(), b.State());
    }
  }
};

}  // namespace twinbench::mechanics
