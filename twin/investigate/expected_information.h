#pragma once

#include <Eigen/Core>
#include <vector>

namespace twinbench::investigate {

/// What a run would show if one hypothesis were true, with unit noise: mean and the directions in which its own
/// uncertainty moves it.
struct Expectation {
  double probability = 0.0;
  Eigen::VectorXd mean;
  Eigen::MatrixXd spread;  // rows x any: covariance is 1 + spread spread'
};

/// How much a run is expected to tell of which of them is true: mutual information of the hypothesis and the
/// readings [bit], from 0 to the entropy of the probabilities. Each hypothesis keeps its sizes as uncertain as they
/// are, so that rivals that can be fitted to the same readings are not told apart (Box & Hill, Technometrics 9
/// (1967) 57; Lindley, Ann. Math. Statist. 27 (1956) 986).
///
/// By draws from each (the same ones for the same input); standard uncertainty about 0.02 bit.
/// @param expectations  Probabilities add up to 1; all of one number of rows.
double ExpectedInformation_bit(const std::vector<Expectation>& expectations);

/// sum -p log2 p.
double Entropy_bit(const std::vector<double>& probabilities);

}  // namespace twinbench::investigate
