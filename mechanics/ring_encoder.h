#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "mechanics/angle_harmonic.h"

/// A graduated ring on a shaft and one reading head beside it: the angle the head sees, from their geometry.
///
/// Frames: F stands still, z along the shaft's axis, x towards the origin of angles; R is the rotor, F turned by
/// the shaft's angle th and shifted by the shaft's radial motion. The ring is a drum whose lines run along its own
/// axis. The head looks at it along a horizontal line towards the axis; what it reads is the line of the drum where
/// that line meets the drum's surface. Nothing is expanded for small errors.
///
/// The scale counts from the ring's reference mark and upwards with th:
///
///   Scale(th) = th - alpha + psi(th - alpha),   alpha = head azimuth - mounting angle of the ring
///
/// so alpha is the angle of the shaft at which the mark passes the head, and psi is the ring's error in its own
/// angle (equations 5 to 9 of Tan et al., where the head is at alpha and the mark passes it when the table has
/// turned by alpha). Three ways to another alpha:
///
///   the head goes round by alpha and the ring stays on the shaft: psi(th - alpha);
///   the ring goes round by -alpha on the shaft and the head stays: the same;
///   both go round by the same angle: nothing changes, as only their difference counts. A re-mounting that turns
///   ring and head together is therefore one of the first two for what the turn leaves behind on the shaft
///   (eccentricity of the seat) and none for what it takes along (graduation).
namespace twinbench::mechanics {

struct Ring {
  double radius_m = std::numeric_limits<double>::quiet_NaN();
  int lines = 0;                                             // a turn
  Eigen::Vector2d eccentricity_m = Eigen::Vector2d::Zero();  // of the ring's centre, in R
  Eigen::Vector2d tilt_rad = Eigen::Vector2d::Zero();        // about x, then y, in R
  double mounting_rad = 0.0;                                 // azimuth of the mark on the shaft, in R
  double ellipticity_m = 0.0;                                // radius + this cos 2(angle on the ring - azimuth)
  double ellipticity_azimuth_rad = 0.0;                      // of the long axis from the mark, counter-clockwise
  std::vector<AngleHarmonic> graduation = {};                // what the lines show too much, in the scale's angle
};

struct ReadingHead {
  double azimuth_rad = 0.0;   // in F
  double height_m = 0.0;      // above the ring's centre plane
  double tangential_m = 0.0;  // sideways, counter-clockwise
};

/// Immutable: one instance may serve many threads.
class RingEncoder {
 public:
  /// @throws std::invalid_argument unless radius and lines are positive, all is finite, the ring's axis passes the
  ///         shaft's within a tenth of the radius at its centre plane and again at the head's height, the
  ///         ellipticity is below a hundredth of the radius, the tilt below 0.1 rad, the head looks at the drum
  ///         (tangential offset below half its radius), and the lines stay in their order.
  RingEncoder(const Ring& ring, const ReadingHead& head);

  /// Angle of the scale under the head [rad], continuous in the unwrapped angle of the shaft.
  ///
  /// @param radial_m  Where the shaft's axis is, in F: error of its bearing.
  ///
  /// The ellipse is the bending of a thin ring that keeps its length: its lines go sideways by half of what the
  /// radius gains. The drum's surface is the same at every height. Not included: yaw and pitch of the head, and
  /// that a head averages over many lines.
  double Scale_rad(double shaft_rad, const Eigen::Vector2d& radial_m = Eigen::Vector2d::Zero()) const;

  /// The inverse: angle of the shaft at which the head sees `scale_rad`, to rounding.
  double Shaft_rad(double scale_rad, const Eigen::Vector2d& radial_m = Eigen::Vector2d::Zero()) const;

  /// Angle of an ideal shaft at which the mark of an ideal ring passes the head: alpha above.
  double MarkAtShaft_rad() const { return head_.azimuth_rad - ring_.mounting_rad; }

  const Ring& ring() const { return ring_; }

 private:
  double AngleOnRing_rad(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction) const;

  Ring ring_;
  ReadingHead head_;
  Eigen::Matrix3d to_ring_;  // from R to the ring's axes
};

}  // namespace twinbench::mechanics
