#include "tests/foreign/angle_fault.h"

namespace twinbench::foreign {

AngleFault Linear(Truth truth, std::function<double(const Instant&)> shape) {
  return {std::move(truth), [shape = std::move(shape)](const Track& track, double size) {
            return Along(track, [&](const Instant& at) { return size * shape(at); });
          }};
}

const std::vector<AngleKind>& UnlistedAngleKinds() {
  static const std::vector<AngleKind> all = [] {
    std::vector<AngleKind> kinds;
    for (const auto& part : {TimeKinds(), AngleLockedKinds(), MotionKinds(), NoiseKinds()})
      kinds.insert(kinds.end(), part.begin(), part.end());
    return kinds;
  }();
  return all;
}

}  // namespace twinbench::foreign
