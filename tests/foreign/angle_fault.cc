#include "tests/foreign/angle_fault.h"

namespace twinbench::foreign {

AngleFault Linear(Truth truth, std::function<double(const Instant&)> shape) {
  AngleFault fault{std::move(truth), {}};
  fault.shown_deg = [shape = std::move(shape)](const Track& track, double size) {
    Eigen::VectorXd shown(std::ssize(track));
    for (std::size_t i = 0; i < track.size(); ++i) shown[static_cast<Eigen::Index>(i)] = size * shape(track[i]);
    return shown;
  };
  return fault;
}

Truth Unlisted(Names honest) {
  Truth truth;
  truth.unlisted = 1;
  truth.honest = std::move(honest);
  return truth;
}

Truth Listed(Names names) {
  Truth truth;
  truth.listed = {std::move(names)};
  return truth;
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
