#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "twin/core/devices.h"
#include "twin/core/reading_column.h"
#include "twin/core/units.h"

/// What a procedure may ask of a machine tool and of the instruments on it. Calls block as those of devices.h do
/// and throw what those throw. Coordinates are SI: metres of a linear axis, radians of a rotary one.
namespace twinbench {

struct MachineAxis {
  std::string name;  // "x"
  bool is_rotary = false;

  double to_SI() const { return is_rotary ? units::deg : units::mm; }  // of files and wires
  const char* unit() const { return is_rotary ? "deg" : "mm"; }
};

/// What the controller says about one axis.
struct AxisState {
  double commanded = kNaN;  // where it was sent, as the controller understood it
  double encoder = kNaN;
  bool moving = false;
  bool in_position = false;
  bool referenced = true;  // false: it has lost its origin; coordinates mean nothing
  int limit = 0;           // -1, +1: stands on the lower, upper limit switch
  std::string fault;       // in the controller's words; empty: none
};

/// What an axis may be asked to do, and what counts as wrong. SI of the axis.
struct AxisLimits {
  double lower = -std::numeric_limits<double>::infinity();  // soft limits
  double upper = std::numeric_limits<double>::infinity();
  double in_position = std::numeric_limits<double>::infinity();  // encoder against command once settled
  double stall_s = 5.0;           // the machine may stand still so long while it moves
  double move_timeout_s = 120.0;  // beyond what a path takes at its feed
};

/// Circular interpolation of two linear axes about a centre, from where they stand. At `triggers` places of the
/// commanded path the controller gives a pulse that latches the instruments.
struct Arc {
  std::array<std::size_t, 2> axes = {0, 1};
  std::array<double, 2> centre_m{};
  double sweep_rad = 0.0;  // counter-clockwise positive, from the first axis to the second
  double feed_m_s = 0.0;   // 0: as fast as the machine goes
  int triggers = 0;
  double first_trigger_rad = 0.0;  // behind the start, along the way: never negative
  double trigger_step_rad = 0.0;
};

/// A controller with some axes that move together.
class MachineController {
 public:
  virtual ~MachineController() = default;
  virtual const std::vector<MachineAxis>& Axes() const = 0;
  /// The travel that the controller allows, one entry an axis.
  virtual std::vector<AxisLimits> Travel() = 0;
  /// Starts a coordinated move of all axes; returns at once.
  /// @param feed_m_s  0: as fast as the machine goes.
  virtual void StartMove(const std::vector<double>& to, double feed_m_s) = 0;
  virtual void StartArc(const Arc& arc) = 0;
  /// Lets a rotary axis turn on and on: it goes over to a speed within `ramp`; returns at once. 0 brings it to rest.
  /// @throws DeviceFault kRefused of a controller that cannot.
  virtual void StartTurning(std::size_t axis, double speed_rad_s, Duration ramp);
  /// Lets at most `within` pass.
  /// @return true as soon as the path has ended and every axis is in position, false if they are not.
  virtual bool Settles(Duration within) = 0;
  /// One entry an axis.
  virtual std::vector<AxisState> State() = 0;
  /// Brings all axes to rest where they are; returns at once.
  virtual void Stop() = 0;
  /// Finds the origins again; returns when it has.
  virtual void Home() = 0;
};

/// What a look at latched instruments gave.
struct LatchedSamples {
  std::vector<Reading> samples;  // in order of their triggers
  bool overrun = false;          // some were lost
};

inline constexpr const char* kTemperatureColumn = "temperature_degC";
inline constexpr const char* kReferenceColumn = "reference_deg";  // of a comparison

/// Whether an instrument may fill a column of a bench with a machine: what is shown, what a device is compared with, and
/// the temperature.
bool IsOfInstruments(const ReadingColumn& column);
/// Of a bench's columns those.
std::vector<ReadingColumn> InstrumentColumns(const std::vector<ReadingColumn>& columns);

/// The instruments of a bench as one set of named channels: InstrumentColumns of its readings. A sample is
/// a reading of which only the time, the status and these columns say anything.
class InstrumentSet {
 public:
  virtual ~InstrumentSet() = default;
  /// What they show now.
  virtual Reading Read() = 0;
  /// Shows what Read would, on the way to a reading: where something is brought to zero by what it shows. A simulated
  /// set takes it for none of its readings.
  virtual Reading Look() { return Read(); }
  /// Empties the memory; the next `samples` are latched.
  /// @param lines  One at every so many lines of the encoder that the instruments count; 0: one at each of the
  ///               machine's triggers.
  virtual void Arm(int samples, int lines) = 0;
  /// Those latched since the last look.
  virtual LatchedSamples Latched() = 0;
};

/// What a hand does between set-ups.
class MachineFixture {
 public:
  virtual ~MachineFixture() = default;
  /// Takes off what is mounted, so that the machine may go anywhere.
  virtual void Clear() = 0;
  /// @param what  In words, for whoever does it: "grid plate, radius 110.23 mm".
  virtual void Mount(int setup, const std::string& what) = 0;
};

/// A table whose rings of face teeth mesh, turned by an indexer or by hand.
class Indexer {
 public:
  virtual ~Indexer() = default;
  /// Lifts it, turns it and seats it at a tooth, also at the one where it is; counter-clockwise positive seen from above,
  /// unwrapped. Returns when it is seated.
  /// @param angle_rad  Of the same tooth.
  virtual void IndexTo(int tooth, double angle_rad) = 0;
  /// Somebody has his hands on it: nothing else may move meanwhile.
  virtual bool IsByHand() const { return false; }
};

/// The devices of a bench whose machine is driven along a plan. Does not own them.
struct MachineBench {
  Clock& clock;
  MachineController& machine;
  InstrumentSet& instruments;
  MachineFixture& fixture;
  Simulation* simulation = nullptr;  // none on a real bench
  Indexer* indexer = nullptr;        // none: the bench has no multi-tooth table
};

/// What owns the devices of a MachineBench.
class MachineDevices {
 public:
  virtual ~MachineDevices() = default;
  virtual MachineBench Devices() = 0;
};

}  // namespace twinbench
