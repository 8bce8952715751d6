#pragma once

#include "hw_bridge/control/device_line.h"
#include "twin/core/machine.h"

/// A hand that speaks SCPI (docs/protocols.md): a served twin's. Calls throw DeviceFault.
namespace twinbench::hw {

class ScpiFixture : public Fixture {
 public:
  explicit ScpiFixture(DeviceLine line) : line_(std::move(line)) {}
  void Mount(int setup, double clamp_rad, double reseat_rad) override;

 private:
  DeviceLine line_;
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
