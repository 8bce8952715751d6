#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "twin/core/machine.h"

namespace twinbench::procedure {

/// What is claimed of a column that instruments show [SI].
struct ClaimedColumn {
  ReadingColumn column;
  double noise = 0.0;  // of one reading; 0: not stated, or less than the instrument's steps
  double range = 0.0;  // largest size; 0: not known
  /// An angle that it follows, of those that are shown with it; empty or NaN: none.
  std::function<double(const Reading&)> follows = {};
};

/// Instruments of a real bench, which are not believed at once. Readings at rest: the first two, those behind a fault and every
/// sixteenth are taken twice at their place, and must agree within ten times the noise; of instruments that once did not, all are
/// (those that answer late by one show the place before); a reading that is the one before to the last digit, or nothing but zeros,
/// is taken again until it is another. In motion: no column shows the very same for 64 samples. What is read again is in no record:
/// replays need it not.
class DoubtedInstruments : public InstrumentSet {
 public:
  DoubtedInstruments(InstrumentSet& inner, std::vector<ClaimedColumn> claims)
      : inner_(inner), claims_(std::move(claims)), same_(claims_.size()) {}
  /// @throws DeviceFault kStuck of what is dead, stuck or late; kProtocol of a value out of range.
  Reading Read() override;
  Reading Look() override { return inner_.Look(); }
  void Arm(int samples, int lines) override;
  LatchedSamples Latched() override;

 private:
  [[noreturn]] void Fail(const std::string& what);
  void RequireInRange(const Reading& shown);
  void RequireAlive(const Reading& shown);
  void RequireOfThisPlace(const Reading& shown);
  void RequireMoving(const Reading& sample);

  InstrumentSet& inner_;
  std::vector<ClaimedColumn> claims_;
  std::optional<Reading> last_;
  std::vector<int> same_;  // samples in a row, a column
  int unproven_ = 2, read_ = 0;
  bool is_late_ = false;
};

}  // namespace twinbench::procedure
