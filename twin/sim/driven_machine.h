#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "twin/core/machine.h"

namespace twinbench::sim {

/// A machine on its way, at the instant of a sample.
struct DrivenInstant {
  int sample = 0;  // running number of this sample
  Time time{};
  int setup = 0;
  int direction = 1;              // of the path: -1 clockwise on an arc
  double feed_m_s = 0.0;          // 0: at rest
  std::vector<double> commanded;  // one coordinate an axis
  double turning_rad_s = 0.0;     // of an axis that turns on and on
};

/// What stands on a driven machine: a bench's physics.
class DrivenPhysics {
 public:
  virtual ~DrivenPhysics() = default;
  virtual const std::vector<MachineAxis>& Axes() const = 0;
  virtual std::vector<AxisLimits> Travel() const = 0;
  /// How many ways there are to mount what stands on it.
  virtual int Setups() const = 0;
  /// Where the machine stands at Time 0.
  virtual std::vector<double> Start() const = 0;
  /// Of its rotary axes.
  virtual double Traverse_rad_s() const { return 0.5; }
  /// Whether it has one axis that turns on and on, also beyond its travel.
  virtual bool TurnsOn() const { return false; }
  /// When the plan of the bench's scenario takes just this sample, whatever time the instant says; nothing if it
  /// takes another one or none.
  virtual std::optional<Time> Planned(const DrivenInstant& at) const = 0;
  /// What the instruments show. Asked once for each sample, in order.
  virtual Reading Show(const DrivenInstant& at) = 0;
  virtual void Restart() = 0;
  /// Which run of its bench it is, as NumberedRuns.
  virtual void BeRun(int repeat) = 0;
};

/// A machine whose axes go exactly where they are told at a constant feed, and what stands on it, in virtual time.
///
/// A path of its scenario's plan comes when it is planned: the lead-in then takes what is left, whatever its feed,
/// and triggers come to the nanosecond of the plan. Any other path takes its length over its feed. Commands beyond
/// the travel are refused (DeviceFault kLimit).
class DrivenMachine : public MachineDevices {
 public:
  explicit DrivenMachine(std::unique_ptr<DrivenPhysics> physics);
  ~DrivenMachine() override;
  MachineBench Devices() override;

  /// Events that each device has scheduled since the machine was started or restarted.
  const std::map<std::string, std::uint64_t>& Scheduled() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace twinbench::sim
