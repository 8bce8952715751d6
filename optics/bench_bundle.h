#pragma once

#include <Eigen/Dense>

#include "optics/bench.h"

namespace twinbench::optics {

/// Rays of a measured beam along one axis.
int ProfilePositions(const RotaryOpticsParameters& parameters);

/// What is kept of the rays of a beam on one detector.
struct RotaryOptics::Bundle {
  double share = 0.0;                                  // of the power that arrives
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();    // in the plane
  double transmission = 1.0;                           // of the window
  Eigen::Vector2d offset_m = Eigen::Vector2d::Zero();  // from the chief ray; closed only
  Eigen::Matrix2d cov_m2 = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d slopes_per_m = Eigen::Matrix2d::Zero();  // of the direction, by regression on position
};

struct RotaryOptics::Moments {
  double share = 0.0, transmission = 0.0;
  Eigen::Vector2d on_silicon = Eigen::Vector2d::Zero();
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();  // of (u, v, direction u, direction v) in air

  void Add(double weight, const Landing& hit, const Eigen::Matrix3d& R_LP) {
    const Eigen::Vector4d state(hit.in_air_m.x(), hit.in_air_m.y(), R_LP.col(0).dot(hit.direction),
                                R_LP.col(1).dot(hit.direction));
    share += weight;
    transmission += weight * hit.transmission;
    on_silicon += weight * Eigen::Vector2d(hit.u_m, hit.v_m);
    sum += weight * state;
    squares += weight * state * state.transpose();
  }

  Bundle Summary(bool is_chief_ray) const {
    Bundle bundle{.share = share};
    if (!(share > 0.0)) return bundle;
    const Eigen::Vector4d mean = sum / share;
    const Eigen::Matrix4d cov = squares / share - mean * mean.transpose();
    bundle.mean_m = on_silicon / share;
    bundle.transmission = transmission / share;
    if (is_chief_ray) return bundle;
    bundle.cov_m2 = cov.topLeftCorner<2, 2>();
    bundle.slopes_per_m = cov.bottomLeftCorner<2, 2>() * bundle.cov_m2.inverse();
    return bundle;
  }
};

}  // namespace twinbench::optics
