#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "twin/investigate/taken_run.h"

/// Sizes of a hypothesis that runs move, and what runs say of them.
namespace twinbench::investigate {

/// A size that is free: of which cause, and which of its parameters.
struct Size {
  std::size_t cause;
  std::string name;
  double u;             // SI: the unit that it is counted in
  double lower, upper;  // SI
  double plausible;     // SI
};

/// Those for which a diagnosis stated an uncertainty.
std::vector<Size> SizesOf(const Hypothesis& hypothesis, const std::string& bench);

/// [SI].
double ValueOf(const Hypothesis& hypothesis, const Size& size);

/// @param by  In units of u. What leaves its bounds stays on them.
Hypothesis Moved(Hypothesis hypothesis, const std::vector<Size>& sizes, const Eigen::VectorXd& by);

/// The nearer of its bounds [SI].
double BoundOf(const Hypothesis& hypothesis, const Size& size);

/// Change of what is left of one run for one u of a size. What happens at one reading jumps there: it has none.
Eigen::VectorXd SlopeOf(const Hypothesis& hypothesis, const Size& size, const Eigen::VectorXd& left,
                        const TakenRun& run, const Means& means);

/// One run's change of `LeftBy` for one u of each size: rows x sizes.
Eigen::MatrixXd SlopesOf(const Hypothesis& hypothesis, const Eigen::VectorXd& left, const TakenRun& run,
                         const Means& means);

/// What the hypothesis leaves of every run.
struct Left {
  std::vector<Eigen::VectorXd> of;
  double chi2 = 0.0;
};

Left LeftOf(const Hypothesis& hypothesis, std::span<const TakenRun> runs, const Means& means);

/// Normal equations of the sizes, over all runs.
struct Normal {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;
  std::vector<Eigen::MatrixXd> slopes;  // of each run
};

Normal NormalOf(const Hypothesis& hypothesis, const Left& left, std::span<const TakenRun> runs, const Means& means,
                Eigen::Index sizes);

/// Of what was thought of the sizes before, in units of u.
Eigen::VectorXd Breadth(const Hypothesis& hypothesis, const std::vector<Size>& sizes);

/// Directions that no run shows keep the uncertainty that was thought of before.
Eigen::MatrixXd CovarianceOf(const Eigen::MatrixXd& normal, const Eigen::VectorXd& breadth);

}  // namespace twinbench::investigate
