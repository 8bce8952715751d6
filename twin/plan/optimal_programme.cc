#include "twin/plan/optimal_programme.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"

namespace twinbench::plan {
namespace {

constexpr double kFull = 1e-9;  // of the budget: what still fits

Eigen::MatrixXd InverseOf(const Eigen::MatrixXd& information) {
  const auto inverse = InverseOfPositive(information, 0.0);
  Require(inverse.has_value(), "the information before any run is positive definite");
  return *inverse;
}

/// What is to be made large.
double Merit(const Eigen::MatrixXd& information, Optimality optimality) {
  const double criterion = CriterionOf(information, optimality);
  return optimality == Optimality::kD ? criterion : -criterion;
}

/// @param merit, bound  As of Merit.
double EfficiencyOf(double merit, double bound, Eigen::Index unknowns, Optimality optimality) {
  if (optimality == Optimality::kD) return std::exp(std::min(0.0, merit - bound) / static_cast<double>(unknowns));
  return std::clamp(bound / merit, 0.0, 1.0);  // both negative
}

Eigen::MatrixXd InformationOf(const Eigen::MatrixXd& known, const std::vector<RunInformation>& runs,
                              const Eigen::VectorXd& weights) {
  Eigen::MatrixXd sum = known;
  for (std::size_t j = 0; j < runs.size(); ++j) sum += weights[static_cast<Eigen::Index>(j)] * runs[j].information;
  return sum;
}

Eigen::VectorXd CostsOf(const std::vector<RunInformation>& runs) {
  Eigen::VectorXd costs(std::ssize(runs));
  std::ranges::transform(runs, costs.begin(), &RunInformation::cost);
  return costs;
}

/// How far to go from one mixture towards another: the merit is concave on the way.
double BestShare(const Eigen::MatrixXd& from, const Eigen::MatrixXd& to, Optimality optimality) {
  constexpr int kRounds = 40;
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  const auto merit = [&](double share) { return Merit((1.0 - share) * from + share * to, optimality); };
  double low = 0.0, high = 1.0;
  double a = high - golden, b = low + golden;
  double at_a = merit(a), at_b = merit(b);
  for (int round = 0; round < kRounds; ++round) {
    if (at_a < at_b) {
      low = a;
      a = b;
      at_a = at_b;
      b = low + golden * (high - low);
      at_b = merit(b);
    } else {
      high = b;
      b = a;
      at_b = at_a;
      a = high - golden * (high - low);
      at_a = merit(a);
    }
  }
  return 0.5 * (low + high);
}

/// Takes from the run that helps least per cost, of those that it has, for the one that helps most: Frank and
/// Wolfe's step with Wolfe's way back, so that it does not creep.
Eigen::VectorXd Step(const Eigen::MatrixXd& known, const std::vector<RunInformation>& runs,
                     const Eigen::VectorXd& weights, const Eigen::VectorXd& per_cost, double budget,
                     Optimality optimality) {
  const Eigen::VectorXd costs = CostsOf(runs);
  Eigen::Index best = 0, least = -1;
  per_cost.maxCoeff(&best);
  for (Eigen::Index j = 0; j < weights.size(); ++j) {
    const bool has = weights[j] * costs[j] > kFull * budget;
    if (has && (least < 0 || per_cost[j] < per_cost[least])) least = j;
  }
  if (least < 0 || least == best) return weights;
  Eigen::VectorXd exchanged = weights;
  exchanged[best] += weights[least] * costs[least] / costs[best];
  exchanged[least] = 0.0;
  const double share = BestShare(InformationOf(known, runs, weights), InformationOf(known, runs, exchanged), optimality);
  return (1.0 - share) * weights + share * exchanged;
}

double CostOf(const std::vector<RunInformation>& runs, const std::vector<int>& times) {
  double cost = 0.0;
  for (std::size_t j = 0; j < runs.size(); ++j) cost += times[j] * runs[j].cost;
  return cost;
}

double MeritOf(const Eigen::MatrixXd& known, const std::vector<RunInformation>& runs, const std::vector<int>& times,
               Optimality optimality) {
  const Eigen::VectorXd weights = Eigen::Map<const Eigen::VectorXi>(times.data(), std::ssize(times)).cast<double>();
  return Merit(InformationOf(known, runs, weights), optimality);
}

struct Best {
  std::vector<int> times;
  double merit = -std::numeric_limits<double>::infinity();
};

/// All programmes that have `times` of the runs before `next`.
void LookAtAll(const Eigen::MatrixXd& known, const std::vector<RunInformation>& runs, double left, std::size_t next,
               Optimality optimality, std::vector<int>& times, Best& best) {
  if (next == runs.size()) {
    const double merit = MeritOf(known, runs, times, optimality);
    if (merit > best.merit) best = {times, merit};
    return;
  }
  const int most = static_cast<int>(left / runs[next].cost + kFull);
  for (int count = 0; count <= most; ++count) {
    times[next] = count;
    LookAtAll(known, runs, left - count * runs[next].cost, next + 1, optimality, times, best);
  }
  times[next] = 0;
}

/// An upper estimate of how many there are: the volume that so many whole numbers fill.
double ProgrammesWithin(const std::vector<RunInformation>& runs, double budget) {
  double count = 1.0;
  double k = 1.0;
  for (const RunInformation& run : runs) {
    count *= (budget / run.cost + k) / k;
    k += 1.0;
  }
  return count;
}

/// Adds what helps most per cost as long as one fits.
void Fill(const Eigen::MatrixXd& known, const std::vector<RunInformation>& runs, double budget, Optimality optimality,
          std::vector<int>& times) {
  for (;;) {
    const double now = MeritOf(known, runs, times, optimality), left = budget - CostOf(runs, times);
    std::ptrdiff_t best = -1;
    double most = 0.0;
    for (std::size_t j = 0; j < runs.size(); ++j) {
      if (runs[j].cost > left + kFull * budget) continue;
      ++times[j];
      const double gained = (MeritOf(known, runs, times, optimality) - now) / runs[j].cost;
      --times[j];
      if (!(gained > most)) continue;
      most = gained;
      best = static_cast<std::ptrdiff_t>(j);
    }
    if (best < 0) return;
    ++times[static_cast<std::size_t>(best)];
  }
}

/// From `start` on: one run less of each kind in turn, the room filled with another and what helps most.
Best Exchange(const Eigen::MatrixXd& known, const std::vector<RunInformation>& runs, double budget,
              Optimality optimality, std::vector<int> start) {
  Best best{std::move(start)};
  Fill(known, runs, budget, optimality, best.times);
  best.merit = MeritOf(known, runs, best.times, optimality);
  for (bool better = true; better;) {
    better = false;
    for (std::size_t out = 0; out < runs.size() && !better; ++out) {
      if (best.times[out] == 0) continue;
      for (std::size_t in = 0; in < runs.size() && !better; ++in) {
        std::vector<int> times = best.times;
        --times[out];
        ++times[in];
        if (in == out || CostOf(runs, times) > budget * (1.0 + kFull)) continue;
        Fill(known, runs, budget, optimality, times);
        const double merit = MeritOf(known, runs, times, optimality);
        better = merit > best.merit + kFull * std::abs(best.merit);
        if (better) best = {times, merit};
      }
    }
  }
  return best;
}

}  // namespace

double CriterionOf(const Eigen::MatrixXd& information, Optimality optimality) {
  const Eigen::VectorXd values = EigenvaluesOfSymmetric(information);
  return optimality == Optimality::kD ? values.array().log().sum() : values.cwiseInverse().sum();
}

Eigen::VectorXd Derivatives(const Eigen::MatrixXd& information, const std::vector<RunInformation>& runs,
                            Optimality optimality) {
  const Eigen::MatrixXd inverse = InverseOf(information);
  const Eigen::MatrixXd by = optimality == Optimality::kD ? inverse : Eigen::MatrixXd(inverse * inverse);
  Eigen::VectorXd slopes(std::ssize(runs));
  for (std::size_t j = 0; j < runs.size(); ++j)
    slopes[static_cast<Eigen::Index>(j)] = by.cwiseProduct(runs[j].information).sum();
  return slopes;
}

RelaxedProgramme BestMixture(const Eigen::MatrixXd& known, const std::vector<RunInformation>& runs, double budget,
                             Optimality optimality) {
  constexpr int kMostSteps = 2000;
  constexpr double kGoodEnough = 1e-5;  // of efficiency
  Require(!runs.empty() && budget > 0.0, "a programme needs runs and a budget");
  const Eigen::VectorXd costs = CostsOf(runs);
  Eigen::VectorXd weights = (budget / static_cast<double>(runs.size())) * costs.cwiseInverse();
  double bound = std::numeric_limits<double>::infinity();
  RelaxedProgramme best;
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::MatrixXd information = InformationOf(known, runs, weights);
    const double merit = Merit(information, optimality);
    const Eigen::VectorXd slopes = Derivatives(information, runs, optimality);
    const Eigen::VectorXd per_cost = slopes.cwiseQuotient(costs);
    bound = std::min(bound, merit + budget * per_cost.maxCoeff() - weights.dot(slopes));
    const double sign = optimality == Optimality::kD ? 1.0 : -1.0;
    best = {weights, sign * merit, sign * bound, EfficiencyOf(merit, bound, known.rows(), optimality)};
    if (best.efficiency > 1.0 - kGoodEnough) break;
    weights = Step(known, runs, weights, per_cost, budget, optimality);
  }
  return best;
}

Programme BestProgramme(const Eigen::MatrixXd& known, const std::vector<RunInformation>& runs, double budget,
                        Optimality optimality) {
  constexpr double kMostProgrammes = 2e4;
  const RelaxedProgramme relaxed = BestMixture(known, runs, budget, optimality);
  Programme programme;
  programme.exhaustive = ProgrammesWithin(runs, budget) <= kMostProgrammes;
  Best best;
  if (programme.exhaustive) {
    std::vector<int> times(runs.size(), 0);
    LookAtAll(known, runs, budget, 0, optimality, times, best);
  } else {
    std::vector<int> whole;  // of the best mixture
    for (const double weight : relaxed.weights) whole.push_back(static_cast<int>(weight + kFull));
    for (const std::vector<int>& start : {std::vector<int>(runs.size(), 0), whole}) {
      Best found = Exchange(known, runs, budget, optimality, start);
      if (found.merit > best.merit) best = std::move(found);
    }
  }
  const double sign = optimality == Optimality::kD ? 1.0 : -1.0;
  programme.times = best.times;
  programme.cost = CostOf(runs, best.times);
  programme.criterion = sign * best.merit;
  programme.bound = relaxed.bound;
  programme.efficiency = EfficiencyOf(best.merit, sign * relaxed.bound, known.rows(), optimality);
  return programme;
}

}  // namespace twinbench::plan
