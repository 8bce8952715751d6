#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <memory>

#include "mechanics/chain.h"
#include "mechanics/scale.h"

/// The stack of two rotary tables as bodies: masses, bearings, drives, and Newton's law for them.
namespace twinbench::mechanics {

/// Coordinates of the stack, target table first: x, y, z [m], rx, ry [rad] of each bearing (see BearingPose), then
/// the angle of the rotor [rad]. Forces in the same order [N, Nm].
inline constexpr int kCoordinates = 12;
inline constexpr int kPerTable = 6;
inline constexpr int kSpin = 5;
using Vector12 = Eigen::Matrix<double, kCoordinates, 1>;
using Matrix12 = Eigen::Matrix<double, kCoordinates, kCoordinates>;

inline constexpr int SpinIndex(int table) {
  return kPerTable * table + kSpin;
}

/// Friction of a drive after the LuGre model: bristles that bend over `presliding_rad` before they slip.
/// Reference: Canudas de Wit et al., IEEE Trans. Automatic Control 40 (1995) 419-425.
struct FrictionParameters {
  double coulomb_Nm = 0.0;    // 0: none
  double static_ratio = 1.2;  // breakaway / Coulomb torque
  double stribeck_rad_s = 1e-3;
  double presliding_rad = 50e-6;       // Coulomb torque / stiffness of the bristles
  double bristle_damping_ratio = 0.3;  // of the bristles against the inertia they hold
  double viscous_Nm_s = 0.0;
};

/// Cables and hoses that lead to a rotor: they wind up, and their bend makes a torque once a turn.
struct CableParameters {
  double stiffness_Nm_rad = 0.0;
  double torque_Nm = 0.0;    // amplitude
  double azimuth_rad = 0.0;  // of the rotor where the latter vanishes, and holds it
};

/// What a rotor is not balanced by.
struct Unbalance {
  double kg_m = 0.0;         // mass times radius
  double azimuth_rad = 0.0;  // on the rotor
};

/// A rigid body with its axis of symmetry along z.
struct SymmetricBody {
  double mass_kg = std::numeric_limits<double>::quiet_NaN();
  double height_m = 0.0;  // of the centre of mass above the origin of its table
  double transverse_inertia_kg_m2 = std::numeric_limits<double>::quiet_NaN();  // about the centre of mass
  double axial_inertia_kg_m2 = std::numeric_limits<double>::quiet_NaN();
};

struct TableParameters {
  SymmetricBody rotor;
  double axial_stiffness_N_m = std::numeric_limits<double>::quiet_NaN();
  double radial_stiffness_N_m = std::numeric_limits<double>::quiet_NaN();
  double tilt_stiffness_Nm_rad = std::numeric_limits<double>::quiet_NaN();
  double servo_Hz = std::numeric_limits<double>::quiet_NaN();
  double torque_limit_Nm = std::numeric_limits<double>::quiet_NaN();
  double backlash_rad = 0.0;  // full width, of the encoder against the rotor
  FrictionParameters friction;
  CableParameters cable;
  Unbalance unbalance;
  ScaleParameters scale;  // of the encoder that the controller reads
};

/// Point mass with a small inertia on the reference rotor.
struct Payload {
  double mass_kg = 0.0;
  double radius_m = 0.0;
  double azimuth_rad = 0.0;     // on the rotor
  double height_m = 0.05;       // above the reference's origin
  double inertia_kg_m2 = 1e-3;  // about each axis through its centre; used only with a mass
};

/// kAdaptive: strides of servo periods as AdaptiveStack finds them long enough. Else fixed sub-steps by
/// StackDynamics::Step.
enum class Integrator { kAdaptive, kRungeKutta4 };

/// Defaults: a plausible 200 mm air-bearing stack (assumed, not data of a real table).
struct StackParameters {
  std::array<TableParameters, 2> table = {
      TableParameters{{12.0, 0.0, 0.060, 0.060}, 200e6, 100e6, 0.60e6, 30.0, 20.0, 0.0, {}, {}, {}, {}},
      TableParameters{{6.0, 0.0, 0.022, 0.022}, 120e6, 60e6, 0.25e6, 40.0, 10.0, 0.0, {}, {}, {}, {}}};
  SymmetricBody housing{9.0, -0.030, 0.045, 0.050};  // of the reference; stands on the target's rotor
  Payload payload;
  ChainGeometry geometry;
  double damping_ratio = 0.03;         // of each bearing against the mass it carries
  double reaction_feed_forward = 0.0;  // 1: each drive knows the torque by which the other's motion turns it
  double gravity_m_s2 = 9.81;
  double servo_period_s = 500e-6;
  double step_s = 250e-6;  // longest sub-step, of friction where adaptive; shortened to divide the servo period and
                           // to be stable
  Integrator integrator = Integrator::kAdaptive;
};

/// @throws std::invalid_argument unless masses, stiffnesses, times and bandwidths are positive and all is finite.
void Check(const StackParameters& parameters);

/// Stiffness and damping of the twelve coordinates; zero for the rotors' angles.
Vector12 BearingStiffness(const StackParameters& parameters);
Vector12 BearingDamping(const StackParameters& parameters);

/// Springs' constant force: it carries the stack without payload, because the bench is levelled and aligned under
/// its own weight. With no payload, offset or tilt the deflection is exactly zero.
Vector12 BearingPreload(const StackParameters& parameters);

/// Inertia about the vertical axes: (a, b) is the torque on drive a for a unit acceleration of rotor b.
Eigen::Matrix2d SpinInertia(const StackParameters& parameters);

BearingPose BearingOf(const Vector12& q, int table);

/// Newton's law of the stack by Bullet's articulated-body algorithm. Holds scratch memory: one instance a thread.
/// Geometry is not read back from Bullet; Chain is fed with the coordinates instead.
class StackDynamics {
 public:
  explicit StackDynamics(const StackParameters& parameters);
  ~StackDynamics();
  StackDynamics(StackDynamics&&) noexcept;
  StackDynamics& operator=(StackDynamics&&) noexcept;

  /// Acceleration under springs, damping, weight, the two drives' torques [Nm] and DriveLoads.
  Vector12 Accelerate(const Vector12& q, const Vector12& qd, const Eigen::Vector2d& torque_Nm);

  /// Acceleration under `force` alone, weightless, and without springs.
  Vector12 AccelerateFreely(const Vector12& q, const Vector12& qd, const Vector12& force);

  /// Inverse of the mass matrix at q.
  Matrix12 InverseMass(const Vector12& q);

  /// One step of `step_s` with constant torques, by Runge and Kutta.
  void Step(double step_s, const Eigen::Vector2d& torque_Nm, Vector12& q, Vector12& qd);

  /// Poses of the rotors as Bullet sees them, for the test that compares them with Chain.
  Pose BulletRotorPose(const Vector12& q, int table);

  /// Kinetic energy, energy of the springs and potential energy [J]; the latter two are zero at q = 0.
  double Energy(const Vector12& q, const Vector12& qd);

  const StackParameters& parameters() const { return parameters_; }

 private:
  struct Bullet;  // Bullet's headers stay in the .cc

  StackParameters parameters_;
  Vector12 stiffness_;
  Vector12 damping_;
  Vector12 preload_;
  bool loaded_;
  std::unique_ptr<Bullet> bullet_;
};

/// Highest natural frequency [rad/s] at q = 0; bounds the step of the integrators.
double HighestFrequency(StackDynamics& dynamics);

/// Lowest natural frequency of the bearings [rad/s] at q = 0, rotors free: nothing on them swings on more slowly.
double LowestFrequency(StackDynamics& dynamics);

/// Number of equal sub-steps of a servo period: each at most step_s and short enough for the stiffest mode
/// (2/omega; the limit of Runge and Kutta is 2.8/omega).
int SubSteps(StackDynamics& dynamics);

}  // namespace twinbench::mechanics
