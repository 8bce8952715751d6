#pragma once

#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/estimators/geometry.h"
#include "twin/benches/rotary_4dof/estimators/motion.h"
#include "twin/model/follow.h"

/// What the rotary bench's twin says of a record, by rows of the run: channels referred to the PSDs' surfaces [m].
namespace twinbench::diagnose::rotary {

using measure::Vector4;

/// One parameter of one effect: a constant of the bench that may be wrong.
struct BenchConstant {
  std::string effect, where, parameter;
};

/// The twin that follows a record, asked with the free motions on top of the scenario: [ez, ex, ey (rad), dy (m)]
/// of the grating at the spot in full circles, of its mounting in the calibration, where the twin itself puts the
/// grating where the autocollimator saw it.
class RotaryTwin {
 public:
  /// @throws InputError from the maker.
  RotaryTwin(const model::FollowMaker& maker, const Scenario& scenario, const std::vector<Reading>& used,
             const measure::BenchGeometry& geometry);

  /// What every reading should have shown, by row.
  /// @throws InputError if the twin would show nothing where a reading has a value.
  Eigen::VectorXd Shown_m(const std::vector<Vector4>& free) const;

  /// d shown / d point there, by row [m per SI of the point].
  Eigen::VectorXd Slope_m(const std::string& point, const std::vector<Vector4>& free) const;

  /// d shown / d parameter there, differenced over `step` either way, or one way if it cannot be negative.
  Eigen::VectorXd Slope_m(const BenchConstant& constant, double step, const std::vector<Vector4>& free) const;

 private:
  Eigen::VectorXd Rows_m(const Eigen::MatrixXd& shown_V) const;

  model::FollowMaker maker_;
  Scenario scenario_;
  std::vector<Reading> used_;
  measure::BenchGeometry geometry_;
  std::unique_ptr<model::Follow> follow_;
};

}  // namespace twinbench::diagnose::rotary
