#include "twin/benches/circular_motion/twin/twin.h"

#include <cmath>

#include "twin/model/signals.h"
#include "twin/sim/pointwise_follow.h"

namespace twinbench::sim {
namespace {

constexpr double kStep_m = 1.0 * units::um;

const std::vector<BenchPoint<CircleExtra>>& CirclePoints() {
  using units::um, units::arcsec;
  static const std::vector<BenchPoint<CircleExtra>> points = {
      {{"offset_x", "um", um, kStep_m}, [](CircleExtra& e) -> double& { return e.offset_x_m; }},
      {{"offset_y", "um", um, kStep_m}, [](CircleExtra& e) -> double& { return e.offset_y_m; }},
      {{"rotation", "arcsec", arcsec, arcsec}, [](CircleExtra& e) -> double& { return e.rotation_rad; }},
      {{"length", "um", um, kStep_m}, [](CircleExtra& e) -> double& { return e.length_m; }},
      {{"x", "um", um, kStep_m}, [](CircleExtra& e) -> double& { return e.x_m; }},
      {{"y", "um", um, kStep_m}, [](CircleExtra& e) -> double& { return e.y_m; }},
      {{"radial", "um", um, kStep_m}, [](CircleExtra& e) -> double& { return e.radial_m; }},
      {{"tangential", "um", um, kStep_m}, [](CircleExtra& e) -> double& { return e.tangential_m; }}};
  return points;  // constant
}

/// A record with angles.
class CircleFollow : public PointwiseFollow<CircleExtra> {
 public:
  CircleFollow(const Scenario& stated, const std::vector<Reading>& record, std::shared_ptr<BodiesOnce> bodies)
      : PointwiseFollow(Foreseeable(stated, record), record, CirclePoints()),
        bodies_(std::move(bodies)),
        twin_(scenario(), record, model::Above_K(model::CourseOf(record), stated.environment.reference_degC),
              *bodies_) {}

  std::vector<std::string> Unfixed() const override {
    return {"centre, zero of the encoder, length of the bar and rotation of the grid: free in every mounting"};
  }

 protected:
  Eigen::MatrixXd Shown(const std::vector<CircleExtra>& extra) const override {
    Eigen::MatrixXd shown_m(std::ssize(extra), 2);
    for (std::size_t i = 0; i < extra.size(); ++i) {
      const benches::circular::Deviation at = twin_.At(i, extra[i]);
      shown_m.row(static_cast<Eigen::Index>(i)) << at.radial_m, at.tangential_m;
    }
    return shown_m;
  }

  std::unique_ptr<model::Follow> On(const Scenario& changed) const override {
    return std::make_unique<CircleFollow>(changed, record(), bodies_);
  }

 private:
  std::shared_ptr<BodiesOnce> bodies_;
  CircleTwin twin_;
};

}  // namespace

std::unique_ptr<model::Follow> FollowCircles(const Scenario& scenario, const std::vector<Reading>& record,
                                             const std::shared_ptr<BodiesOnce>& bodies) {
  return std::make_unique<CircleFollow>(scenario, benches::circular::WithAngles(record), bodies);
}

}  // namespace twinbench::sim
