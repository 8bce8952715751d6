#pragma once

#include "hw_bridge/control/controlled_table.h"

namespace twinbench::hw {

/// A table that speaks SCPI (docs/protocols.md): ROTation<axis>.
class ScpiTable : public ControlledTable {
 public:
  ScpiTable(DeviceLine line, int axis, const TableLimits& limits, CommandNumbers numbers = {});

 private:
  void SendMove(const std::string& angle_deg) override;
  bool AwaitSettled(Duration within) override;
  TableState ReadState() override;
  std::string StopWord() const override { return rotation_ + "STOP"; }
  void SendStop() override;
  void SendHome() override;
  AllowedMotion ReadAllowed() override;

  std::string rotation_;  // "ROT1:"
};

/// The answer to STATe?; nothing if it is none.
std::optional<TableState> ParseScpiState(const std::string& answer);

}  // namespace twinbench::hw
