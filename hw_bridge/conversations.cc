#include "hw_bridge/conversations.h"

#include "hw_bridge/control/esp_words.h"
#include "hw_bridge/control/linuxcnc_machine.h"
#include "hw_bridge/control/scpi.h"

namespace twinbench::hw {
namespace {

/// How somebody is made to say who he is, and what is said to him then.
struct Introduction {
  std::string query, identity;
  std::vector<std::string> commands;
};

Introduction IntroductionOf(const ControlSettings& s) {
  if (s.kind == "dialogue") return {s.words.identify, s.words.identify.empty() ? s.words.title : s.identity, {}};
  if (s.kind == "linuxcnc")
    return {LinuxCncHello(s.connect_password), s.identity.empty() ? kLinuxCncIdentity : s.identity, {}};
  if (s.kind == "esp") return {kEspIdentity, s.identity, EspIntroductions(s.token, s.watchdog)};
  return {kScpiIdentity, s.identity, ScpiIntroductions(s.token, s.watchdog)};
}

LineWords LinesOf(const ControlSettings& s) {
  if (s.kind == "linuxcnc") return WithAnyLineEnd();
  return s.kind == "dialogue" ? s.words.line : LineWords{};
}

}  // namespace

DeviceLine Conversations::LineOf(const std::string& device, const ControlSettings& settings) {
  const Introduction introduction = IntroductionOf(settings);
  const auto found = by_address_.try_emplace(settings.address, ParseAddress(settings.address).value(),
                                             introduction.query, introduction.identity);
  Dialogue& dialogue = found.first->second;
  dialogue.Speak(LinesOf(settings));
  dialogue.IntroduceBy(introduction.commands);
  if (settings.kind == "linuxcnc") dialogue.HearsGreetedOnly();
  DeviceLine line(dialogue, device, FromSeconds(settings.timeout_s));
  line.HearStop(stop_asked_);
  line.Openings();
  return line;
}

std::set<std::string> Conversations::Identities() const {
  std::set<std::string> identities;
  for (const auto& [address, dialogue] : by_address_) identities.insert(dialogue.identity());
  return identities;
}

}  // namespace twinbench::hw
