#pragma once

namespace twinbench::mechanics {

/// Law of a LuGre friction: bristles that bend over `presliding` before they slip. Lengths, speeds and forces may
/// be those of a slide (m, N) or angles and torques of a rotor (rad, Nm). Reference: Canudas de Wit et al., IEEE
/// Trans. Automatic Control 40 (1995) 419-425.
struct BristleLaw {
  double coulomb = 0.0;  // 0: none
  double static_ratio = 1.2;
  double stribeck_speed = 0.0;
  double presliding = 0.0;
  double damping = 0.0;  // force by speed of bending

  double Stiffness() const { return coulomb / presliding; }
  /// Bend at which they slip.
  double Slip(double speed) const;
  /// Change of Slip by speed.
  double SlipSlope(double speed) const;
};

/// The bristles' equation is stiff and linear while the speed is constant, so a step takes its exact solution and
/// is stable for every length.
class Bristles {
 public:
  explicit Bristles(const BristleLaw& law) : law_(law) {}

  /// By which they pull forwards on what they are bent by, after it moved at `speed` for `step_s`; against the
  /// motion it counts with the opposite sign.
  double Pull(double speed, double step_s);
  double bend() const { return bend_; }
  void set_bend(double bend) { bend_ = bend; }
  const BristleLaw& law() const { return law_; }

 private:
  BristleLaw law_;
  double bend_ = 0.0;
};

}  // namespace twinbench::mechanics
