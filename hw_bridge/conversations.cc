#include "hw_bridge/conversations.h"

#include "hw_bridge/control/esp_words.h"
#include "hw_bridge/control/scpi.h"

namespace twinbench::hw {

DeviceLine Conversations::LineOf(const std::string& device, const ControlSettings& settings) {
  const bool is_described = settings.kind == "dialogue";
  const std::string query = is_described ? settings.words.identify : settings.kind == "esp" ? kEspIdentity : kScpiIdentity;
  const std::string identity = query.empty() ? settings.words.title : settings.identity;
  const auto found = by_address_.try_emplace(settings.address, ParseAddress(settings.address).value(), query, identity);
  Dialogue& dialogue = found.first->second;
  const auto introductions = settings.kind == "esp" ? EspIntroductions : ScpiIntroductions;
  is_described ? dialogue.Speak(settings.words.line) : dialogue.IntroduceBy(introductions(settings.token, settings.watchdog));
  DeviceLine line(dialogue, device, FromSeconds(settings.timeout_s));
  line.Openings();
  return line;
}

std::set<std::string> Conversations::Identities() const {
  std::set<std::string> identities;
  for (const auto& [address, dialogue] : by_address_) identities.insert(dialogue.identity());
  return identities;
}

}  // namespace twinbench::hw
