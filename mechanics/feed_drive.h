#pragma once

#include <cstdint>
#include <memory>

#include "mechanics/calm_feed.h"
#include "mechanics/feed_body.h"
#include "mechanics/feed_motion.h"

namespace twinbench::mechanics {

struct FeedState {
  double time_s = 0.0;
  double slide_m = 0.0, slide_m_s = 0.0;
  double nut_m = 0.0, nut_m_s = 0.0;
};

/// One axis that follows circles.
///
///   linear   slide and screw by the exact solution of their linear equations over a servo period, friction held
///   for
///            it. No play.
///   bullet   a slide on a prismatic and a screw on a revolute joint by Bullet's articulated-body algorithm, in
///   steps.
///
/// While the slide slips one way and nothing rings, all but the friction is linear, and that changes slowly: then
/// many periods are taken at once (see CalmFeed), at an error of 0.1 nm or less.
///
/// Equal calls give equal bits. One instance a thread.
class FeedDrive {
 public:
  /// @throws std::invalid_argument if Check does, for Fidelity::kKinematic, which needs no body, for the linear
  ///         fidelity with play, and for a servo that is not stable.
  FeedDrive(Fidelity fidelity, const FeedDriveParameters& parameters, CircleAxis axis);
  ~FeedDrive();
  FeedDrive(FeedDrive&&) noexcept;
  FeedDrive& operator=(FeedDrive&&) noexcept;

  /// Sets time to zero and the drive as if it had long followed a motion at constant rate, in mid-travel: its
  /// bristles slip. Not beside a reversal.
  void Begin(const CircleMotion& motion);

  /// From now on.
  void Command(const CircleMotion& motion);

  /// Goes on by at least one servo period, by more where it can and `until_s` is not reached.
  void Step(double until_s);

  FeedState State() const;
  double time_s() const;
  const CircleMotion& motion() const { return motion_; }
  const FeedDriveParameters& parameters() const { return p_; }
  /// Whether many periods may be taken at once; true in a new drive.
  void set_leaps(bool leaps) { leaps_ = leaps; }

 private:
  void Tick();
  bool Leap(double until_s);
  bool Rest(int most);
  std::complex<double> Phasor_m(std::int64_t tick) const;

  FeedDriveParameters p_;
  CircleAxis axis_;
  CircleMotion motion_;
  std::unique_ptr<FeedBody> body_;
  PositionLoop loop_;
  Bristles bristles_;
  CalmFeed calm_;
  FeedVector at_;
  std::int64_t tick_ = 0;
  bool leaps_ = true;
};

}  // namespace twinbench::mechanics
