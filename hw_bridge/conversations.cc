#include "hw_bridge/conversations.h"

#include "hw_bridge/control/esp_words.h"
#include "hw_bridge/control/scpi.h"

namespace twinbench::hw {

DeviceLine Conversations::LineOf(const std::string& device, const ControlSettings& settings) {
  const std::string query = settings.kind == "esp" ? kEspIdentity : kScpiIdentity;
  const auto found =
      by_address_.try_emplace(settings.address, ParseAddress(settings.address).value(), query, settings.identity);
  Dialogue& dialogue = found.first->second;
  const auto introductions = settings.kind == "esp" ? EspIntroductions : ScpiIntroductions;
  dialogue.IntroduceBy(introductions(settings.token, settings.watchdog));
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
