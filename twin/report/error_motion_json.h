#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "twin/separate/error_motion.h"

/// Error motions after ISO 230-7 as results.json, summary and certificate have them, of any bench.
namespace twinbench::report {

/// One sensitive direction with what it is told in.
struct DirectedMotion {
  std::string name;       // "tilt_fixed_x"
  bool is_angle = false;  // arcsec, else um
  separate::ErrorMotion motion;
  /// Parts of the contour's covariance by name, which sum up to it; empty where it is not known.
  std::vector<std::pair<std::string, Eigen::MatrixXd>> parts = {};
  separate::PlotCentre centre = separate::PlotCentre::kLeastSquares;
  double dof = std::numeric_limits<double>::infinity();  // behind the uncertainties
};

/// iso230_7 of results.json, and the same for a person.
struct ErrorMotionTexts {
  /// [{"table", "motion", "values": {"total": {"value_um", "u_um", "bias_um", "u_parts"}, "synchronous", "asynchronous", "fundamental",
  /// "residual"}, "turns", "dof", "missing"}]; what is not known is left out. "u_parts": those of the contour, and "repeatability" of the turns.
  nlohmann::json json = nlohmann::json::array();
  std::string text;  // empty if there is nothing to say
};

/// Evaluates directions of one table and appends them.
/// @param missing  What keeps the values from being those of the standard in full.
void AppendErrorMotions(const std::string& table, const std::vector<DirectedMotion>& directions, const std::vector<std::string>& missing,
                        separate::ErrorMotionDraws& draws, ErrorMotionTexts& to);

}  // namespace twinbench::report
