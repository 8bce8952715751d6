#pragma once

#include "hw_bridge/control/controlled_table.h"
#include "hw_bridge/control/esp_words.h"

namespace twinbench::hw {

/// What a query of MD? lets pass of a clock that is held (docs/protocols.md).
inline constexpr Duration kEspHeldPoll = std::chrono::milliseconds(50);

/// One axis of a Newport ESP controller, in degrees.
///
/// While a served twin's clock is held, asking MD? passes time; so there State does not ask it: in position is what
/// the last one said. A controller without MS? (the ESP301 has none) tells a restart by its motor, which is off
/// after it. Reference: Newport, ESP301 user's manual, section 3 (commands) and appendix A (errors).
class EspTable : public ControlledTable {
 public:
  /// @param polls_pass_time  The bench is a served twin with its clock held.
  EspTable(DeviceLine line, int axis, const TableLimits& limits, CommandNumbers numbers, bool polls_pass_time);

 private:
  void SendMove(const std::string& angle_deg) override;
  bool AwaitSettled(Duration within) override;
  TableState ReadState() override;
  std::string StopWord() const override { return Axis("ST"); }
  void SendStop() override;
  void SendHome() override;
  AllowedMotion ReadAllowed() override;

  std::string Axis(const std::string& command) const;
  void Tell(const std::string& command);
  bool AskDone();
  bool PollHeld(Duration within);
  bool PollRunning(Duration within);
  void Prepare();
  bool AskMoving();
  void ReadStatus(TableState& state);

  int axis_;
  bool polls_pass_time_;
  int prepared_opening_ = 0;
  bool knows_status_ = true, knows_speed_ = false;  // MS?, VU?
  bool lost_origin_ = false;  // so far as the motor tells
  bool done_ = true;          // the last answer to MD?
};

}  // namespace twinbench::hw
