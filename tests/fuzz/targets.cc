#include <vector>

#include "tests/fuzz/target.h"

namespace twinbench::fuzz {

std::span<const Target> Targets() {
  static const std::vector<Target> all = [] {
    std::vector<Target> targets;
    for (const auto family : {TextTargets(), FileTargets(), ConversationTargets(), JsonTargets()})
      targets.insert(targets.end(), family.begin(), family.end());
    return targets;
  }();
  return all;
}

const Target* TargetOf(std::string_view name) {
  for (const Target& target : Targets()) {
    if (target.name == name) return &target;
  }
  return nullptr;
}

}  // namespace twinbench::fuzz
