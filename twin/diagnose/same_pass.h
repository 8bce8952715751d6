#pragma once

#include "twin/diagnose/at.h"
#include "twin/diagnose/engine/linear_run.h"

namespace twinbench::diagnose {

inline bool SamePass(const Schedule& s, int a, int b) {
  return s.setup[At(a)] == s.setup[At(b)] && s.pass[At(a)] == s.pass[At(b)] && s.phase[At(a)] == s.phase[At(b)];
}

/// Whether the next reading follows in the same pass.
inline bool HasNext(const Schedule& s, int i) {
  return i + 1 < s.Readings() && SamePass(s, i, i + 1);
}

}  // namespace twinbench::diagnose
