#include "twin/benches/rotary_4dof/twin/stand.h"

#include "twin/benches/rotary_4dof/settings.h"

namespace twinbench::sim {
namespace {

mechanics::ChainGeometry GeometryOf(const Scenario& actual) {
  mechanics::ChainGeometry geometry;
  geometry.p_RG_m = RotaryOf(actual).grating.point_m;
  geometry.reference_height_m = RotaryOf(actual).reference_height_m;
  geometry.centring_m = RotaryOf(actual).centring_m;
  geometry.mount_tilt_rad = RotaryOf(actual).mount_tilt_rad;
  return geometry;
}

}  // namespace

Stand::Stand(const Scenario& actual)
    : geometry_(GeometryOf(actual)),
      chain_(geometry_),
      target_(RotaryOf(actual).target, actual, "target"),
      reference_(RotaryOf(actual).reference, actual, "reference") {}

const mechanics::ChainGeometry& Stand::Mount(const Mounting& mounting) {
  target_seat_ = target_.DrawSeating();
  const mechanics::PoseError seat = reference_.DrawSeating();
  mechanics::ChainGeometry mounted = geometry_;
  mounted.clamp_rad = mounting.clamp_rad;
  mounted.reseat_rad = mounting.reseat_rad;
  grating_seat_ = {};
  if (mounting.body_reseated) {
    mounted.centring_m += Eigen::Vector2d(seat.dx_m, seat.dy_m);
    mounted.mount_tilt_rad += Eigen::Vector2d(seat.ex_rad, seat.ey_rad);
    mounted.reseat_rad += seat.ez_rad;
  } else {
    grating_seat_ = seat;
  }
  chain_ = mechanics::Chain(mounted);
  return chain_.geometry();
}

Pose Stand::GratingPose(const Moment& moment, const PoseState& extra, const std::array<double, 2>& labels_rad,
                        const std::array<mechanics::BearingPose, 2>& bearings) const {
  mechanics::ChainState state;
  state.target_rad = moment.target_rad + extra.target_yaw_rad;
  state.reference_rad = moment.reference_rad + extra.reference_yaw_rad;
  state.target_error = target_.At(labels_rad[0]) + target_seat_ + extra.target_error;
  state.reference_error = reference_.At(labels_rad[1]) + grating_seat_ + extra.reference_error;
  state.target_bearing = bearings[0];
  state.reference_bearing = bearings[1];
  state.goniometer_yaw_rad = yaw_rad_ + extra.grating_yaw_rad;
  state.goniometer_tilt_rad = tilt_rad_ + extra.grating_tilt_rad;
  Pose X_LG = chain_.GratingPose(state);
  if (extra.grating_roll_rad != 0.0) X_LG = Pose(mechanics::RotationY(extra.grating_roll_rad)) * X_LG;
  X_LG.translation().y() += extra.grating_shift_m;
  return X_LG;
}

}  // namespace twinbench::sim
