#include "twin/diagnose/diagnosis.h"

namespace twinbench::diagnose {

const char* VerdictName(Verdict verdict) {
  constexpr std::array<const char*, 4> kNames = {"none", "named", "tie", "unknown"};
  return kNames[static_cast<std::size_t>(verdict)];
}

bool HasUnmodelled(const Diagnosis& diagnosis) {
  if (diagnosis.verdict == Verdict::kUnknown) return true;
  return diagnosis.unknown.probability > 0.5 && !diagnosis.unknown.signature.empty();
}

}  // namespace twinbench::diagnose
