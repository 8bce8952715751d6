#pragma once

#include "hw_bridge/serve/command_conversation.h"
#include "hw_bridge/serve/scpi_text.h"

namespace twinbench::hw {

/// SCPI-99: the native protocol of the served bench. Its commands are a table in scpi_commands.cc.
class ScpiConversation : public CommandConversation {
 public:
  using CommandConversation::Asks;
  using CommandConversation::BeMissed;
  using CommandConversation::CommandConversation;
  using CommandConversation::MayChange;
  using CommandConversation::Patience_s;
  using CommandConversation::served;
  using CommandConversation::Show;

  ScpiErrorQueue& errors() { return errors_; }
  /// Standard event status register and its masks, as in IEEE 488.2.
  struct Status {
    int events = 128;  // power on
    int event_mask = 0, service_mask = 0;
  };
  Status& status() { return status_; }
  /// Adds to the queue and to the event register.
  void Report(const ScpiError& error);

 protected:
  Outcome Execute(const std::string& command) override;
  void Failed(const std::string& what) override;
  std::string Join(const std::vector<std::string>& answers) const override;
  std::string LineTooLong() override;

 private:
  Outcome Run(const ScpiUnit& unit);

  ScpiErrorQueue errors_;
  Status status_;
  std::vector<std::string> path_;  // header of the command before, without its last keyword
};

}  // namespace twinbench::hw
