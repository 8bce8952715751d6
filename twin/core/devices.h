#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/time.h"

/// What a procedure may ask of a bench. Calls block, as a bench engineer would write them: the twin's devices run
/// the event queue until the condition holds, the hardware's wait in real time, the replayed ones look it up.
/// Every call may throw BenchError; a DeviceFault where the device failed in a way that can be told.
namespace twinbench {

class Clock {
 public:
  virtual ~Clock() = default;
  virtual Time Now() const = 0;
  virtual void Wait(Duration duration) = 0;
};

/// What the controller of a table says about it.
struct TableState {
  double commanded_rad = kNaN;  // as the controller understood it
  double encoder_rad = kNaN;
  bool moving = false;
  bool in_position = false;
  bool referenced = true;  // false: it has lost its origin (switched on, restarted); angles mean nothing
  int limit = 0;           // -1, +1: stands on the lower, upper limit switch
  std::string fault;       // in the controller's words; empty: none
};

class RotaryTable {
 public:
  virtual ~RotaryTable() = default;
  /// Starts a move to an unwrapped angle, counter-clockwise positive seen from above; returns at once.
  virtual void StartMove(double angle_rad) = 0;
  /// Lets at most `within` pass.
  /// @return true as soon as the profile has ended and the controller reports in-position, false if it did not.
  virtual bool Settles(Duration within) = 0;
  virtual TableState State() = 0;
  /// Brings the table to rest where it is; returns at once.
  virtual void Stop() = 0;
  /// Finds the origin again; returns when it has.
  virtual void Home() = 0;

  /// Returns when the table has settled.
  /// @throws BenchError if it has not within a minute.
  void WaitSettled();
  double EncoderAngle_rad() { return State().encoder_rad; }
};

/// What one block of samples of one channel came to.
struct ChannelBlock {
  double mean_V = kNaN;
  double std_V = kNaN;  // sample standard deviation, n - 1
  double min_V = kNaN;
  double max_V = kNaN;
};

/// Where a block stands in the converter's own count, and what the computer's clocks showed when it came.
struct BlockStamp {
  std::int64_t first_scan = -1;  // number of its first scan since the first block; -1: not counted
  std::int64_t device_ns = -1;   // the converter's time stamp of that scan
  std::int64_t host_ns = -1;     // steady clock of the computer
  std::int64_t utc_ns = -1;      // label only: it may jump
};

struct Acquisition {
  Time start{};
  ReadingStatus status = ReadingStatus::kOk;
  int n_samples = 0;
  std::array<ChannelBlock, kChannels> channel{};
  std::vector<std::int16_t> raw;  // scans x channels, two's complement; if asked for, or if the device always has them
  BlockStamp stamp;
  int saturated_mask = 0;  // bit k: some sample of channel k was an end code
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
  ReadingStatus status = ReadingStatus::kOk;  // else both are NaN
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

/// What only a simulated bench can do: begin again as it was, and pass its time without taking any.
class Simulation {
 public:
  virtual ~Simulation() = default;
  /// Puts every device back to how the bench was set up, at Time 0.
  virtual void Restart() = 0;
  /// false: waits and moves cost no real time from now on; true: as the bench was told.
  virtual void SetPaced(bool paced) = 0;
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
  Simulation* simulation = nullptr;  // none on a real bench
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
  /// @param block  What the converter delivered for it; without raw counts where it has none.
  virtual void Append(const Reading& reading, const Acquisition& block) = 0;
  /// Readings without raw counts that came together, as from one look into a FIFO: all are safe or none.
  virtual void AppendAll(const std::vector<Reading>& readings) {
    for (const Reading& reading : readings) Append(reading, {});
  }
};

}  // namespace twinbench
