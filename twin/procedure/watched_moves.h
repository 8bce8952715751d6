#pragma once

#include <optional>
#include <vector>

#include "twin/core/devices.h"
#include "twin/core/machine.h"
#include "twin/core/table_limits.h"
#include "twin/procedure/watched_way.h"

namespace twinbench::procedure {

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
    /// As WatchedMachine: both may hang on one controller. Where both stand elsewhere at once, both count from another zero: no hand moves both.
    TableState State() override;
    void Stop() override;
    void Home() override;
    void LoseZero() { way_.LoseZeros(); }

   private:
    /// Both may hang on one controller.
    auto AskBoth(auto&& ask);
    TableState Asked();
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
