#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinbench::plan {

/// What one run would tell of unknowns that all runs share: Fisher's information (p x p), and what it costs
/// (minutes, readings; positive).
struct RunInformation {
  double cost = 1.0;
  Eigen::MatrixXd information;
};

/// D: largest determinant of the information, the smallest ellipsoid of all unknowns together, and half its log2 the
/// information gained [bit]. A: least trace of its inverse, the sum of all variances.
enum class Optimality { kD, kA };

/// A mixture of runs, each as often as its weight says, whole or not.
struct RelaxedProgramme {
  Eigen::VectorXd weights;   // one a run; costs times weights add up to the budget
  double criterion = 0.0;    // D: log det, A: trace of the inverse
  double bound = 0.0;        // of any mixture within the budget: none has a larger log det, a lesser trace
  double efficiency = 0.0;   // at least: D (det / det of the best)^(1/p), A trace of the best / trace
};

/// Runs that are made whole.
struct Programme {
  std::vector<int> times;  // one a run
  double cost = 0.0;
  double criterion = 0.0;
  double bound = 0.0;       // by the relaxed programme
  double efficiency = 0.0;  // at least, as above
  bool exhaustive = false;  // every programme was looked at; else the best that exchanging runs found
};

double CriterionOf(const Eigen::MatrixXd& information, Optimality optimality);

/// Derivative of the criterion (D: of log det, A: of minus the trace) by each run's weight: tr(M^-1 M_j), tr(M^-2 M_j).
Eigen::VectorXd Derivatives(const Eigen::MatrixXd& information, const std::vector<RunInformation>& runs,
                            Optimality optimality);

/// Goes from the mixture that it has towards the run that helps most per cost, until the general equivalence theorem
/// says that none helps more than those it has (Kiefer & Wolfowitz, Canad. J. Math. 12 (1960) 363; Whittle, J. R.
/// Statist. Soc. B 35 (1973) 123): both criteria are concave (A: its negative), so that with slopes g_j, costs c_j
/// and the budget C no mixture within it is better than
///     criterion + C max_j g_j / c_j - sum_j w_j g_j.
/// @param known   Information before any run; positive definite (prior knowledge, or a run that is made anyway).
/// @param budget  Positive.
RelaxedProgramme BestMixture(const Eigen::MatrixXd& known, const std::vector<RunInformation>& runs, double budget,
                             Optimality optimality);

/// Whole runs within the budget: every programme where there are no more than some ten thousand. Else, from nothing and
/// from the whole runs of the best mixture, the run that helps most per cost is added as long as one fits, then runs are
/// exchanged until that helps no more. How far it may be from the best is told by its efficiency.
Programme BestProgramme(const Eigen::MatrixXd& known, const std::vector<RunInformation>& runs, double budget,
                        Optimality optimality);

}  // namespace twinbench::plan
