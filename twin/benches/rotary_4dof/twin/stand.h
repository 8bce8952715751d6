#pragma once

#include "mechanics/chain.h"
#include "twin/benches/rotary_4dof/twin/effect.h"
#include "twin/sim/table_motion.h"

namespace twinbench::sim {

/// Both tables, the mounting between them and the goniometer: from angles to the pose of the grating.
class Stand {
 public:
  explicit Stand(const Scenario& actual);

  /// @return the geometry of this mounting, with what it scattered.
  const mechanics::ChainGeometry& Mount(const Mounting& mounting);
  void SetGoniometer(double yaw_rad, double tilt_rad) { yaw_rad_ = yaw_rad, tilt_rad_ = tilt_rad; }
  void BeginTargetStop() { target_.BeginStop(); }
  void BeginReferenceStop() { reference_.BeginStop(); }

  /// X_LG at these rotor angles.
  ///
  /// @param labels_rad  Angles at which the two error motions are looked up; the rotor angles on an honest bench.
  /// @param bearings    Deflections of the bearings of target and reference.
  Pose GratingPose(const Moment& moment, const PoseState& extra, const std::array<double, 2>& labels_rad,
                   const std::array<mechanics::BearingPose, 2>& bearings) const;

  const TableMotion& target() const { return target_; }
  const TableMotion& reference() const { return reference_; }

 private:
  mechanics::ChainGeometry geometry_;  // without what a mounting changes
  mechanics::Chain chain_;
  TableMotion target_, reference_;
  mechanics::PoseError target_seat_;   // in L
  mechanics::PoseError grating_seat_;  // in the reference's rotor frame
  double yaw_rad_ = 0.0, tilt_rad_ = 0.0;
};

}  // namespace twinbench::sim
