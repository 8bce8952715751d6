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
  /// What it should show, but for a constant of each set-up; empty or NaN: not known.
  std::function<double(const Reading&)> follows = {};
  bool is_angle = false;  // follows: by what is shown with it, whole turns apart
  bool is_of_place =
      false;             // at a place it is the same in every pass, but for noise and what is the same everywhere
  double repeats = 0.0;  // by how much coming to a place again may change it, beyond noise
};

/// What it shows in a reading [SI].
double ValueOf(const ClaimedColumn& claim, const Reading& reading);
/// By how much it may differ between two readings of a place.
double AllowedAtPlace(const ClaimedColumn& claim);

/// Of a reading and the one before in its set-up.
/// @throws DeviceFault kMoved where from one to the next a column did not go the way that it should by angles,
/// within half of it, or by
///         places, within a tenth of it and a hundredth of its range: what should have moved stands elsewhere than
///         its controller says.
void RequireGoesAlong(const std::vector<ClaimedColumn>& claims, const Reading& reading, const Reading& before);

/// Of a reading that is taken again at its place.
/// @throws DeviceFault kImplausible where a column shows something else than before, by thirty times the noise, or
/// nothing.
void RequireAsBefore(const std::vector<ClaimedColumn>& claims, const Reading& again, const Reading& before);

/// Instruments of a real bench, which are not believed at once. Every reading at rest is taken twice at its place,
/// and both must agree within ten times the noise: those that answer late by one show the place before, and a spike
/// comes alone. One that is the reading before to the last digit, or nothing but zeros, is taken again until
/// another comes, and then once more, which counts; so is what one channel shows twice, where it hardly ever did before. In motion: no column shows the very same for 16 samples, no angle for 64. What
/// is read again is in no record: replays need it not.
class DoubtedInstruments : public InstrumentSet {
 public:
  DoubtedInstruments(InstrumentSet& inner, std::vector<ClaimedColumn> claims)
      : inner_(inner), claims_(std::move(claims)), same_(claims_.size()), twice_(claims_.size()) {}
  /// @throws DeviceFault kStuck of what is dead, stuck or late; kProtocol of a value out of range.
  Reading Read() override;
  Reading Look() override { return inner_.Look(); }
  void Arm(int samples, int lines) override;
  LatchedSamples Latched() override;

 private:
  void RequireInRange(const Reading& shown);
  /// The one that was shown, or a fresh one in its place.
  Reading Alive(const Reading& shown);
  /// The second, which agrees with the one that was shown.
  Reading OfThisPlace(const Reading& shown);
  void RequireNoise(const Reading& shown, const Reading& again);
  void RequireMoving(const Reading& sample);

  InstrumentSet& inner_;
  std::vector<ClaimedColumn> claims_;
  std::optional<Reading> last_;  // of all answers
  std::vector<int> same_;        // samples in a row, a column
  /// How often a column was read twice at its place, and showed another value.
  struct Twice {
    int read = 0, differed = 0;
  };
  std::vector<Twice> twice_;
};

}  // namespace twinbench::procedure
