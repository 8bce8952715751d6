#pragma once

#include "hw_bridge/control/device_line.h"
#include "twin/core/machine.h"

/// The instruments beside the tables that speak SCPI (docs/protocols.md). Calls throw DeviceFault.
namespace twinbench::hw {

class ScpiAutocollimator : public Autocollimator {
 public:
  explicit ScpiAutocollimator(DeviceLine line) : line_(std::move(line)) {}
  /// NaN where the mirror is out of range.
  AutocollimatorReading Read() override;

 private:
  DeviceLine line_;
};

class ScpiThermometer : public Thermometer {
 public:
  explicit ScpiThermometer(DeviceLine line) : line_(std::move(line)) {}
  double Read_degC() override;

 private:
  DeviceLine line_;
};

class ScpiGoniometer : public Goniometer {
 public:
  explicit ScpiGoniometer(DeviceLine line) : line_(std::move(line)) {}
  void MoveTo(double yaw_rad, double tilt_rad) override;

 private:
  DeviceLine line_;
};

class ScpiFixture : public Fixture {
 public:
  explicit ScpiFixture(DeviceLine line) : line_(std::move(line)) {}
  void Mount(int setup, double clamp_rad, double reseat_rad) override;

 private:
  DeviceLine line_;
};

/// What is said to an indexer, as a bench file describes it.
struct IndexerWords {
  std::string move = "IND:MOVE {tooth},{deg}";  // lifts, turns and seats it
  std::string done;                       // query that is answered by 1 once it is seated; empty: it answers when it is
  double move_timeout_s = 60.0;
};

/// A line of SCPI in one thing: the command is followed by SYST:ERR?.
class ScpiIndexer : public Indexer {
 public:
  ScpiIndexer(DeviceLine line, IndexerWords words) : line_(std::move(line)), words_(std::move(words)) {}
  /// @throws DeviceFault kNotInPosition too, if it does not say within its time that it is seated.
  void IndexTo(int tooth, double angle_rad) override;

 private:
  DeviceLine line_;
  IndexerWords words_;
};

class ScpiMachineFixture : public MachineFixture {
 public:
  explicit ScpiMachineFixture(DeviceLine line) : line_(std::move(line)) {}
  void Clear() override;
  void Mount(int setup, const std::string& what) override;

 private:
  DeviceLine line_;
};

}  // namespace twinbench::hw
