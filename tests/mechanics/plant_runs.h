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

inline StackParameters ReseatedStack() {
  StackParameters p = EccentricStack();
  p.payload.azimuth_rad = 0.6;
  p.geometry.reseat_rad = -0.7;
  return p;
}

/// The same on tables that are not mounted straight either.
inline StackParameters CrookedStack() {
  StackParameters p = ReseatedStack();
  p.geometry.centring_m = {30e-6, -20e-6};
  p.geometry.mount_tilt_rad = {100e-6, 150e-6};
  return p;
}

/// Bullet's bodies, integrated more closely.
inline StackParameters Fine(StackParameters p, double step_s = 250e-6) {
  p.integrator = Integrator::kRungeKutta4;
  p.step_s = step_s;
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
};

/// Two plants that are sent and go on side by side.
struct Both {
  std::unique_ptr<Plant> a, b;
  Difference difference = {};

  void Send(Axis axis, double to_rad, double duration_s = 0.6) {
    for (Plant* plant : {a.get(), b.get()}) plant->StartMove(axis, to_rad, duration_s);
  }
  void Counter(int position) {
    Send(Axis::kTarget, position * kTenDegrees);
    Send(Axis::kReference, -position * kTenDegrees);
  }
  void GoOn(int steps, double step_s, Difference& into) const {
    for (int k = 0; k < steps; ++k) {
      a->Advance(step_s);
      b->Advance(step_s);
      into.Include(a->State(), b->State());
    }
  }
  void GoOn(int steps, double step_s) { GoOn(steps, step_s, difference); }
};

inline Both LinearAndBullet(const StackParameters& p) {
  return {MakePlant(Fidelity::kLinear, p), MakePlant(Fidelity::kBullet, p)};
}

}  // namespace twinbench::mechanics
