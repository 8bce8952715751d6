#pragma once

#include <vector>

#include "twin/core/machine.h"

namespace twinbench::procedure {

inline constexpr double kNear = 1e-3;  // m or rad: where axes settle, as slowly as they like

/// What encoders show on a way that axes were sent, all at once, and where they stand [m or rad]. Which axes are slow, and for how long
/// they may be, is learned from the ways that came to their end.
class WatchedWay {
 public:
  explicit WatchedWay(std::vector<MachineAxis> axes)
      : axes_(std::move(axes)), fastest_(axes_.size(), 0.0), has_lost_zero_(axes_.size(), false) {}
  /// They stood at `from` and were sent to `to`; `at` is where they are since then, at most `took` later.
  /// @throws what RequireOnWay throws.
  void Begins(const std::vector<double>& from, const std::vector<double>& to, const std::vector<double>& at,
              Time now, Duration took);
  /// @param stall_s  Of the limits; as long as no way has come to its end nothing else is known.
  /// @throws DeviceFault kStalled where none has gone at a tenth of its speed for longer than on any way before,
  /// twice that and a
  ///         little more, and some have far to go.
  void Shows(const std::vector<double>& at, Time now, double stall_s);
  /// Once a controller has as its targets where the axes were sent, nothing else may come: some tell how far they are instead.
  /// @throws what TellSentElsewhere throws.
  void RequireOurs(const std::vector<double>& commanded);
  void HasEnded();
  /// What moves does not go at its own speed. @param to  Where it goes straight; none: it does not.
  void IsAnother(std::vector<double> to = {});
  /// From the first look on that shows no motion they stand.
  void HasStopped() { has_stopped_ = true; }

  /// An answer stayed out: whoever is asked next may have been switched off and on.
  void IsCut() { is_cut_ = true; }
  bool WasCut() const { return is_cut_; }
  /// Every look. Of an axis that counts from another zero (HasLostZero) two hold: it does not stand where it stood, or is not on its way; it has
  /// come there faster than it goes; its connection was cut, and then all on that controller do.
  /// @return whether all are elsewhere than they stood, or than their way leads.
  bool Seen(const std::vector<double>& at, Time now);
  /// Whether such a look would tell of other zeros: one garbled answer does, too.
  bool MayBeGarbled(const std::vector<double>& at, Time now) const;
  bool HasLostZero(std::size_t axis) const { return has_lost_zero_[axis]; }
  void LoseZeros() { has_lost_zero_.assign(axes_.size(), true); }
  void HasFoundZeros();
  /// @throws DeviceFault kRestarted.
  void RequireZeros() const;
  /// NaN: unknown.
  double To(std::size_t axis) const { return axis < to_.size() ? to_[axis] : kNaN; }

 private:
  bool IsSlow(const std::vector<double>& at, double in_s);
  bool HasFarToGo(const std::vector<double>& at) const;

  enum class Course { kUnknown, kStands, kGoes };

  std::vector<MachineAxis> axes_;
  std::vector<double> fastest_;  // m/s or rad/s, ever
  std::vector<double> to_, at_;  // of this way; none: nothing is known of it
  Course course_ = Course::kUnknown;
  std::vector<double> target_, seen_;  // where it leads, and where they were last
  Time seen_at_{};
  bool is_cut_ = false, has_stopped_ = false;
  std::vector<bool> has_lost_zero_;
  bool has_our_targets_ = false;
  Time shown_{};
  double slow_s_ = 0.0, slowest_s_ = 0.0;  // since when, and for how long at most on this way
  double known_slow_s_ = kNaN;             // on all before
};

}  // namespace twinbench::procedure
