#pragma once

namespace twinbench::diagnose {

/// Errors of an angle bend the waves that go by it.
struct BentWaves {
  double one = 1.0;   // likeness of what two waves show from which on they are one; 1: only where they are exactly that
  double rest = 0.0;  // of the power of a wave, the most that its bend leaves
};

}  // namespace twinbench::diagnose
