#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "twin/core/devices.h"
#include "twin/core/machine.h"
#include "twin/core/table_limits.h"

namespace twinbench::procedure {

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
  /// Every look. An axis that does not stand where it stood, or is not on its way, counts from another zero (HasLostZero) if its connection was cut
  /// or no axis is that fast.
  /// @return whether all do that stood: elsewhere than they did.
  bool Seen(const std::vector<double>& at, Time now);
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

/// A machine of a real bench whose moves are looked at ten times a second, outside the record.
class WatchedMachine : public MachineController {
 public:
  WatchedMachine(MachineController& inner, const Clock& clock, const std::vector<AxisLimits>& limits)
      : inner_(inner), clock_(clock), limits_(limits), way_(inner.Axes()) {}
  const std::vector<MachineAxis>& Axes() const override { return inner_.Axes(); }
  std::vector<AxisLimits> Travel() override { return inner_.Travel(); }
  /// @throws what WatchedWay::Begins throws, and the machine.
  void StartMove(const std::vector<double>& to, double feed_m_s) override;
  void StartArc(const Arc& arc) override;
  void StartTurning(std::size_t axis, double speed_rad_s, Duration ramp) override;
  /// @return false at once where a look shows what whoever watches must see.
  /// @throws what WatchedWay::RequireOurs and Shows throw, RequireOnCircle, and the machine.
  bool Settles(Duration within) override;
  /// Where an axis counts from another zero, it says that it has lost its origin until it has found that again.
  std::vector<AxisState> State() override;
  void Stop() override;
  void Home() override;
  /// As a run that ended left them.
  void LoseZeros() { way_.LoseZeros(); }

 private:
  double OffCircle_m(const std::vector<AxisState>& states) const;
  /// @throws DeviceFault kFollowing of axes that have left the circle which they were sent round.
  void RequireOnCircle(const std::vector<AxisState>& states) const;

  MachineController& inner_;
  const Clock& clock_;
  const std::vector<AxisLimits>& limits_;
  WatchedWay way_;
  std::optional<Arc> round_;  // that they go
  double radius_m_ = kNaN;
};

/// The same of two tables that are sent one after the other: where they are is looked at behind the second.
class WatchedTables {
 public:
  WatchedTables(RotaryBench& bench, const TableLimits& target, const TableLimits& reference);
  RotaryTable& target() { return target_; }
  RotaryTable& reference() { return reference_; }
  /// As WatchedMachine.
  void LoseZeros();

 private:
  class Table : public RotaryTable {
   public:
    Table(RotaryTable& inner, const Clock& clock, const TableLimits& limits, const char* name, Table& other)
        : inner_(inner), clock_(clock), limits_(limits), way_({{name, true}}), other_(other) {}
    void StartMove(double angle_rad) override;
    bool Settles(Duration within) override;
    /// As WatchedMachine. Where both stand elsewhere at once, both count from another zero: no hand moves both.
    TableState State() override;
    void Stop() override;
    void Home() override;
    void LoseZero() { way_.LoseZeros(); }

   private:
    /// Both may hang on one controller.
    auto AskBoth(auto&& ask);
    bool IsElsewhere(const TableState& state);
    /// Where it stands before either of the two is sent: a zero may be set as the first is.
    void LookBefore() { from_rad_ = EncoderAngle_rad(); }
    void LookAtStart();
    /// @return false where it shows what whoever watches must see.
    bool LookOnWay();

    RotaryTable& inner_;
    const Clock& clock_;
    const TableLimits& limits_;
    WatchedWay way_;
    Table& other_;
    bool is_sent_ = false;                    // and was not looked at since
    double from_rad_ = kNaN, to_rad_ = kNaN;  // NaN: nobody has looked
    Time sent_{};
  };
  Table target_, reference_;
};

}  // namespace twinbench::procedure
