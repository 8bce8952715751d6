#pragma once

namespace twinbench::optics {

/// How light is carried: by Embree from surface to surface, or by the formula of its one way.
enum class Fidelity { kTraced, kClosed };

}  // namespace twinbench::optics
