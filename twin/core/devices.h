#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/time.h"

/// What a procedure may ask of a bench. Calls block, as a bench engineer would write them: the twin's devices run
/// the event queue until the condition holds, the hardware's wait in real time, the replayed ones look it up.
/// Every call may throw BenchError.
namespace twinbench {

class Clock {
 public:
  virtual ~Clock() = default;
  virtual Time Now() const = 0;
  virtual void Wait(Duration duration) = 0;
};

class RotaryTable {
 public:
  virtual ~RotaryTable() = default;
  /// Starts a move to an unwrapped angle, counter-clockwise positive seen from above; returns at once.
  virtual void StartMove(double angle_rad) = 0;
  /// Returns when the profile has ended and the controller reports in-position.
  virtual void WaitSettled() = 0;
  virtual double EncoderAngle_rad() = 0;
};

/// What one block of samples of one channel came to.
struct ChannelBlock {
  double mean_V = kNaN;
  double std_V = kNaN;  // sample standard deviation, n - 1
  double min_V = kNaN;
  double max_V = kNaN;
};

struct Acquisition {
  Time start{};
  ReadingStatus status = ReadingStatus::kOk;
  int n_samples = 0;
  std::array<ChannelBlock, kChannels> channel{};
  std::vector<std::int16_t> raw;  // scans x channels, only if asked for
};

class AdConverter {
 public:
  virtual ~AdConverter() = default;
  /// Takes `n_samples` scans of all channels at the configured rate.
  virtual Acquisition Acquire(int n_samples, bool keep_raw) = 0;
};

struct AutocollimatorReading {
  double yaw_rad = kNaN;   // about z, counter-clockwise positive
  double tilt_rad = kNaN;  // about x, normal upwards positive
};

class Autocollimator {
 public:
  virtual ~Autocollimator() = default;
  virtual AutocollimatorReading Read() = 0;
};

class Thermometer {
 public:
  virtual ~Thermometer() = default;
  virtual double Read_degC() = 0;
};

/// Turns the grating about the laser spot by small known-by-autocollimator angles (calibration, verification).
class Goniometer {
 public:
  virtual ~Goniometer() = default;
  virtual void MoveTo(double yaw_rad, double tilt_rad) = 0;
};

/// What a hand does between set-ups. Real benches ask the operator and wait.
class Fixture {
 public:
  virtual ~Fixture() = default;
  /// Turns the grating back on the reference rotor by `clamp_rad` and the reference's body on the target by
  /// `reseat_rad`; both are absolute. Every call is a new mounting, also with unchanged angles.
  virtual void Mount(int setup, double clamp_rad, double reseat_rad) = 0;
};

/// The devices of a rotary bench. Does not own them.
struct RotaryBench {
  Clock& clock;
  RotaryTable& target;
  RotaryTable& reference;
  AdConverter& adc;
  Autocollimator& autocollimator;
  Thermometer& thermometer;
  Goniometer& goniometer;
  Fixture& fixture;
};

/// An angle device under test and the reference that it is compared with, on one shaft.
class AngleComparator {
 public:
  virtual ~AngleComparator() = default;
  /// Brings the shaft to the angle, speed and time that `reading` states (a stop is approached in its direction) and
  /// enters what both devices show at that instant.
  virtual void Take(Reading& reading) = 0;
};

/// Takes readings as they are made. `Append` returns only when the reading is as safe as the sink can make it.
class ReadingSink {
 public:
  virtual ~ReadingSink() = default;
  virtual void Append(const Reading& reading, const std::vector<std::int16_t>& raw) = 0;
};

}  // namespace twinbench
