#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "twin/benches/freeform_five_axis/estimators/unknowns.h"
#include "twin/core/reading.h"

/// What the probe should read, for the estimators: the same machine and optics as the twin's, written down a second
/// time. A point and three directions of the tool are carried back through the bodies one by one; the beam meets
/// the surface by Newton's steps.
namespace twinbench::benches::freeform::estimators {

struct PoseRead {
  std::array<double, kMachineAxes> at{};  // commanded, SI
  std::array<double, kMachineAxes> t{};   // as the cubics count it
  int i = 0, j = 0, setup = 0;            // cell and set-up
  int reading = 0;                        // its number in the run
  Eigen::Vector3d shown;                  // qpd_x [V], qpd_y [V], ccd [px]
};

/// What of a pose's errors its reading sees: 30 errors of bodies, squareness, mounting [SI].
using Inputs = Eigen::Matrix<double, kInputs, 1>;

std::vector<PoseRead> PosesOf(const std::vector<Reading>& readings, const FreeformSettings& bench);

Inputs InputsAt(const PoseRead& pose, const Eigen::VectorXd& unknowns);

/// qpd_x [V], qpd_y [V], ccd [px].
Eigen::Vector3d Predicted(const FreeformSettings& bench, const PoseRead& pose, const Inputs& inputs);

/// Where the spot lies along one axis of the quadrant detector so that its halves differ by this share of the light
/// that they get [m]; at most three of its radii from the middle.
double SpotAt_m(double share, const QuadrantSettings& qpd);

/// The tip in the X slide's frame [m].
Eigen::Vector3d Tip_m(const FreeformSettings& bench, const PoseRead& pose, const Inputs& inputs);

/// d tip / d unknown of the machine by central differences over a um and an arcsec [um]: 3 poses x kOfMachine.
Eigen::MatrixXd TipSlopes_um(const FreeformSettings& bench, const std::vector<PoseRead>& poses,
                             const Eigen::VectorXd& unknowns);

/// d reading / d unknown by central differences over a um and an arcsec: 3 readings each x unknowns.
Eigen::MatrixXd Jacobian(const FreeformSettings& bench, const std::vector<PoseRead>& poses,
                         const Eigen::VectorXd& unknowns);

}  // namespace twinbench::benches::freeform::estimators
