#include "twin/diagnose/diagnosis.h"

namespace twinbench::diagnose {

const char* VerdictName(Verdict verdict) {
  constexpr std::array<const char*, 4> kNames = {"none", "named", "tie", "unknown"};
  return kNames[static_cast<std::size_t>(verdict)];
}

}  // namespace twinbench::diagnose
