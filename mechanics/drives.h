#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "mechanics/linear_model.h"
#include "mechanics/plant.h"
#include "mechanics/profile.h"
#include "mechanics/servo.h"

/// What the plants share: commanded motions of two axes, and the rhythm of their controllers.
namespace twinbench::mechanics {

/// Time since the plant was made, counted so that sums of pieces are exact [ns].
using Nanoseconds = std::int64_t;

/// @throws std::invalid_argument for a negative time.
Nanoseconds ToNanoseconds(double time_s);
inline double ToSeconds(Nanoseconds time) {
  return static_cast<double>(time) / 1e9;
}

inline std::size_t Index(Axis axis) {
  return axis == Axis::kTarget ? 0 : 1;
}

/// Commanded motions of both axes.
class Commands {
 public:
  void Start(Axis axis, double to_rad, double duration_s, Nanoseconds now);
  /// @return whether there was a motion to be brought to rest.
  bool Stop(Axis axis, double duration_s, Nanoseconds now);
  ProfilePoint At(std::size_t axis, Nanoseconds time) const {
    return profile_[axis].At(ToSeconds(time - start_[axis]));
  }
  bool Ended(std::size_t axis, Nanoseconds time) const {
    return ToSeconds(time - start_[axis]) >= profile_[axis].duration_s();
  }
  Nanoseconds start(std::size_t axis) const { return start_[axis]; }
  const QuinticProfile& profile(std::size_t axis) const { return profile_[axis]; }
  /// Until both have ended.
  double Left_s(Nanoseconds now) const;
  /// What the controllers are told for the period that begins at `time`.
  PeriodCommand Period(Nanoseconds time, Nanoseconds period) const;

 private:
  std::array<QuinticProfile, 2> profile_ = {QuinticProfile(0.0), QuinticProfile(0.0)};
  std::array<Nanoseconds, 2> start_ = {0, 0};
};

/// A plant that lives from servo period to servo period. A plant at rest begins its periods anew at the next move.
class DrivenPlant : public Plant {
 public:
  explicit DrivenPlant(const StackParameters& parameters);

  void StartMove(Axis axis, double to_rad, double duration_s) final;
  void Stop(Axis axis) final;
  double CommandedEnd_rad(Axis axis) const final { return commands_.profile(Index(axis)).to_rad(); }
  void Advance(double dt_s) final;
  using Plant::Settled;
  bool Settled(Axis axis) const final { return quiet_[Index(axis)] >= kQuiet; }
  StackState State() const final;
  void Mount(const ChainGeometry& geometry) final;

 protected:
  double ProfileLeft_s() const final { return commands_.Left_s(now_); }
  /// Moves the stack through the period that begins at `time`.
  virtual void Step(Nanoseconds time) = 0;
  /// Makes sure that Coordinates can look into the period that begins at `time`.
  virtual void Prepare(Nanoseconds) {}
  /// Encoders' shafts minus commands at the end of the last period.
  virtual Eigen::Vector2d Deviation_rad() const = 0;
  /// Bodies `since` after the beginning of the period that begins at `time`, in whatever form Bearings takes; but
  /// the rotors' are encoders' shafts minus commands.
  virtual Vector12 Coordinates(Nanoseconds time, Nanoseconds since) const = 0;
  /// Bearings for rotors at these angles.
  virtual std::array<BearingPose, 2> Bearings(const Vector12& coordinates, double target_rad,
                                              double reference_rad) const = 0;
  /// Whether any number of periods may pass at once now that both have settled.
  virtual bool CanRest() const = 0;
  virtual void Rest(std::int64_t periods) = 0;
  /// The last period is broken off after `since`: another begins.
  virtual void OnWake(Nanoseconds) {}
  virtual void OnStart() {}
  virtual void OnMount() {}

  const StackParameters& parameters() const { return parameters_; }
  const Commands& commands() const { return commands_; }
  Nanoseconds period() const { return period_; }

 private:
  static constexpr Nanoseconds kQuiet = 10'000'000;

  void Wake();
  void Tick();
  void FollowBacklash();
  void WatchQuiet();
  double ShownDeviation_rad(std::size_t table, double deviation_rad) const;

  StackParameters parameters_;
  Commands commands_;
  std::array<Backlash, 2> backlash_;
  Nanoseconds period_;
  Nanoseconds now_ = 0;
  Nanoseconds stepped_ = 0;                              // up to when the periods are done
  std::array<Nanoseconds, 2> quiet_ = {kQuiet, kQuiet};  // for how long each encoder has been near its command
};

/// Makers behind MakePlant.
std::unique_ptr<Plant> MakeKinematicPlant(const StackParameters& parameters);
std::unique_ptr<Plant> MakeLinearPlant(const StackParameters& parameters);
std::unique_ptr<Plant> MakeBulletPlant(const StackParameters& parameters);
/// Bullet in the fixed sub-steps of SubSteps, for parameters.integrator other than kAdaptive: what the adaptive one
/// is measured by.
std::unique_ptr<Plant> MakeFixedStepPlant(const StackParameters& parameters);

}  // namespace twinbench::mechanics
