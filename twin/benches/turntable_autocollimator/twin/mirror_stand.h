#pragma once

#include <vector>

#include "mechanics/chain.h"
#include "twin/sim/table_motion.h"

namespace twinbench::sim {

/// Errors on top of those of the settings.
struct MirrorExtra {
  mechanics::PoseError turntable;   // in L
  mechanics::PoseError axis;        // of the multi-tooth table on the turntable's rotor
  mechanics::PoseError multitooth;  // in its rotor frame
  mechanics::PoseError mount;       // of the mirror, facing along y, on its seat
};

/// Turntable, multi-tooth table and mirror on top of each other: from angles to the pose of the mirror. A polygon
/// is a multi-tooth table with one seat a face that is never lifted: face f is what tooth -f would turn the mirror
/// to.
///
/// L: z = turntable's axis, up; the autocollimator looks along -y; origin at the height of the beam. The mirror's
/// body M has its normal along z_M and y_M up.
class MirrorStand {
 public:
  explicit MirrorStand(const Scenario& actual);

  /// A new mounting, with what it scatters: the mirror faces the autocollimator with the turntable at 0 and the
  /// multi-tooth table at `shift_rad`.
  /// A polygon shows its face 0 with the turntable at `shift_rad`.
  void Mount(double tilt_rad, double azimuth_rad, double eccentricity_m, double shift_rad);
  void BeginTurntableStop() { turntable_.BeginStop(); }
  /// Lifts the multi-tooth table and seats it at a tooth.
  void Seat(int tooth);
  /// Brings the polygon's face into play that looks at the autocollimator.
  void SeatFace(double turntable_rad);

  /// @param yaw_rad  Of the turntable, beyond its errors.
  Pose MirrorPose(double turntable_rad, double yaw_rad, const mechanics::BearingPose& bearing,
                  const MirrorExtra& extra = {}) const;

  /// Where the multi-tooth table is seated.
  double Seated_rad() const { return tooth_ * pitch_rad_; }

  const TableMotion& turntable() const { return turntable_; }
  /// Errors of the multi-tooth table that repeat, at each of its teeth.
  TableErrors MultitoothErrors() const;
  /// Distance of neighbouring teeth, or faces.
  double Pitch_rad() const { return pitch_rad_; }

 private:
  int Wrapped(int tooth) const;

  TableMotion turntable_, multitooth_;
  std::vector<double> tooth_rad_;    // errors that differ from tooth to tooth
  std::vector<double> pyramid_rad_;  // of a polygon's faces by tooth: normal upwards; empty without
  double pitch_rad_, mirror_radius_m_;
  double shift_rad_ = 0.0;
  Pose X_TB_ = Pose::Identity();  // base of the multi-tooth table on the turntable's rotor
  Pose X_RS_ = Pose::Identity();  // seat of the mirror on the multi-tooth table's rotor
  mechanics::PoseError turntable_seat_;
  int tooth_ = 0;
};

}  // namespace twinbench::sim
