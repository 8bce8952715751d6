#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinbench::diagnose::encoder {

/// Readings in a mean whose steps are looked at: in fewer the noise hides the steps, over more the shaft turns.
inline constexpr Eigen::Index kInMean = 16;

/// Means of so many readings each, which noise hardly moves; no mean goes over a new mounting.
struct Means {
  std::vector<double> value;
  std::vector<int> setup;

  bool IsNext(std::size_t k) const { return setup[k] == setup[k - 1]; }
  std::vector<double> Steps() const;
};

/// @param setup  By row.
Means MeansOf(const Eigen::VectorXd& rows, const std::vector<int>& setup, Eigen::Index each);

/// Whether steps from mean to mean go with those of a signal, in its sense: beside a walk, whose steps know nothing of each
/// other, that is what tells a cause from a piece of the walk, however large the walk becomes.
/// @return log Bayes factor of "walk and signal" against "walk" by Schwarz's criterion; 0 where they go against each other.
double EvidenceOfSteps(const std::vector<double>& steps, const std::vector<double>& of_signal);

}  // namespace twinbench::diagnose::encoder
