#pragma once

#include <Eigen/Core>
#include <vector>

/// What the tilt of the axis that carries the mirrors does to the autocollimator's x in second order.
namespace twinbench::separate::turntable {

/// A mirror as the autocollimator saw it.
struct TiltReading {
  int setup = 0;          // one tilt of the axis against the turntable's
  int face = 0;           // of the mirrors on that axis
  double angle_rad = 0.0; // of the turntable
  double y_rad = 0.0;     // the mirror's tilt, against any zero
};

/// How much x shows too much: an axis that leans by a towards the azimuth b of the turntable turns a mirror with the
/// pitch p by a^2 / 4 sin 2(th + b) - p a cos(th + b) about the vertical, th the turntable's angle. a and b are those of
/// the y that goes once round in each set-up, p is what y of a face has beside that in all of them. Whatever the sign
/// and the zero of y.
///
/// A set-up whose angles do not tell a once-per-turn wave gets zeros.
///
/// Uncertainty: a part 2 u(scale of y) of it. Not included: wobble of the turntable times that tilt.
/// Reference: docs/theory.md 5.5 (0.44 arcsec at 600 arcsec).
Eigen::VectorXd TiltSquared_rad(const std::vector<TiltReading>& readings);

}  // namespace twinbench::separate::turntable
