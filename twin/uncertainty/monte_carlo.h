#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "twin/uncertainty/budget.h"
#include "twin/uncertainty/joint.h"

namespace twinbench::uncertainty {

struct MonteCarloOptions {
  std::uint64_t seed = 1;
  int most_trials = 20000;
  int digits = 2;  // of each standard uncertainty that shall be right
  int threads = 1;
  std::vector<Joint> joints = {};  // what the readings leave of quantities together, as their estimator states it
};

/// Where a quantity may lie, from trials.
struct Spread {
  Quantity quantity;  // as the readings say, with the scenario's own values
  double mean = 0.0, sd = 0.0;
  std::array<double, 2> symmetric = {};  // probabilistically: 2.5 % on either side
  std::array<double, 2> shortest = {};   // 95 %
};

struct MonteCarlo {
  std::vector<Spread> spreads;
  std::vector<JointSpread> together;  // one for each of the joints, of what was determined in every trial
  int trials = 0;
  bool settled = false;  // to the digits asked for, before `most_trials`
};

/// The scenario with every u_<key> of it drawn from its distribution: what the constants of one bench may be.
/// Trials have their own stretches of every stream.
Scenario DrawnScenario(Scenario scenario, std::uint64_t seed, std::int64_t trial);

/// Propagation of distributions (JCGM 101, adaptive as in its 7.9): every u_<key> of the scenario is drawn from its
/// distribution (a normal one of few degrees of freedom from Student's), the readings are evaluated with what was
/// drawn, and what the estimator says of the readings' own scatter is drawn on top, from Student's distribution of
/// its degrees of freedom: together for the quantities of a joint, by its covariance (JCGM 102, one chi-squared for
/// all, the multivariate t distribution), each by itself for the others.
///
/// Trial n has its own stretch of every stream: the same bits on any number of threads.
MonteCarlo Propagate(const Scenario& scenario, const Evaluate& evaluate, const MonteCarloOptions& options);

}  // namespace twinbench::uncertainty
