#include "twin/investigate/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "twin/core/errors.h"
#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/investigate/expected_information.h"
#include "twin/investigate/free_sizes.h"

namespace twinbench::investigate {
namespace {

constexpr double kWorthAsking = 0.005;  // of probability: less decides nothing
constexpr double kAsGoodAsGone = 1e-9;  // of the largest direction

/// Columns of all signatures side by side, as coordinates in which W is 1.
Eigen::MatrixXd Coordinates(const TakenRun& run, const Eigen::MatrixXd& columns) {
  const Eigen::MatrixXd gram = Product(run, columns, columns);
  const auto [values, vectors] = EigenOfSymmetric(0.5 * (gram + gram.transpose()));
  const double largest = std::max(values.maxCoeff(), 0.0);
  Eigen::Index kept = 0;
  for (const double value : values) kept += value > kAsGoodAsGone * largest ? 1 : 0;
  if (largest == 0.0) return Eigen::MatrixXd::Zero(1, columns.cols());
  return values.tail(kept).cwiseSqrt().asDiagonal() * vectors.rightCols(kept).transpose();
}

/// What one hypothesis takes from the run's readings, and one standard uncertainty of its sizes each way.
Eigen::MatrixXd Signature(const JointFit& fit, const TakenRun& run, const Means& means) {
  const Eigen::VectorXd left = LeftBy(fit.hypothesis, run, means);
  const Eigen::MatrixXd slopes = SlopesOf(fit.hypothesis, left, run, means);
  Eigen::MatrixXd signature(left.size(), 1 + slopes.cols());
  signature.col(0) = run.left - left;
  if (slopes.cols() > 0) {
    signature.rightCols(slopes.cols()) = slopes * CholeskyFactorOf(fit.cov);
  }
  return signature;
}

/// The mean becomes a direction of its own as well.
Eigen::MatrixXd OfAnySize(const Eigen::MatrixXd& signature) {
  Eigen::MatrixXd wider(signature.rows(), signature.cols() + 1);
  wider << signature, signature.col(0);
  return wider;
}

/// In the few directions that any of the signatures has.
std::vector<Expectation> Expectations(const std::vector<Eigen::MatrixXd>& signatures,
                                      const std::vector<double>& probabilities, const TakenRun& run) {
  Eigen::Index width = 0;
  for (const Eigen::MatrixXd& signature : signatures) width += signature.cols();
  Eigen::MatrixXd all(run.left.size(), width);
  Eigen::Index column = 0;
  for (const Eigen::MatrixXd& signature : signatures) {
    all.middleCols(column, signature.cols()) = signature;
    column += signature.cols();
  }
  const Eigen::MatrixXd at = Coordinates(run, all);
  const double sum = std::accumulate(probabilities.begin(), probabilities.end(), 0.0);
  std::vector<Expectation> expectations;
  column = 0;
  for (std::size_t k = 0; k < signatures.size(); ++k) {
    const Eigen::Index columns = signatures[k].cols();
    expectations.push_back({probabilities[k] / sum, at.col(column), at.middleCols(column + 1, columns - 1)});
    column += columns;
  }
  return expectations;
}

bool IsFirst(const Advice& a, const Advice& b) {
  return a.PerMinute() > b.PerMinute();
}

}  // namespace

double OfCauses_bit(const Belief& belief, const TakenRun& run, bool is_of_another_kind, const Means& means) {
  std::vector<Eigen::MatrixXd> signatures;
  std::vector<double> probabilities;
  for (const Open& open : belief.open) {
    if (open.probability < kWorthAsking) continue;
    signatures.push_back(Signature(open.fit, run, means));
    probabilities.push_back(open.probability);
  }
  if (belief.unlisted >= kWorthAsking && !signatures.empty()) {
    signatures.push_back(is_of_another_kind ? OfAnySize(signatures.front()) : signatures.front());
    probabilities.push_back(belief.unlisted);
  }
  return signatures.size() < 2 ? 0.0 : ExpectedInformation_bit(Expectations(signatures, probabilities, run));
}

Plans::Plans(const Scenario& scenario, const Means& means) : means_(means) {
  std::vector<plan::NextRun> runs = {{"again", "the same run once more", {}, plan::kSameKind}};
  if (means.next_runs) {
    for (plan::NextRun& run : means.next_runs(scenario)) runs.push_back(std::move(run));
  }
  for (const plan::NextRun& run : runs) {
    try {
      const Scenario other = Altered(scenario, run.sets);
      TakenRun taken = TakenOf(run, other, means.twin(other), means);
      nlohmann::json results;
      try {
        results = means.evaluate(taken.readings, other);
      } catch (const InputError&) {  // tells of causes only
      }
      planned_.push_back({std::move(taken), std::move(results)});
    } catch (const InputError& refusal) {
      refused_.push_back(fmt::format("{}: {}", run.name, refusal.what()));
    }
  }
}

bool Plans::CanBeDiagnosed(const plan::NextRun& run) const {
  const auto planned = std::ranges::find_if(planned_, [&run](const Planned& p) { return p.run.asked.sets == run.sets; });
  if (planned == planned_.end()) return false;
  try {
    means_.diagnose(planned->run.readings, planned->run.scenario, {});
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::vector<Advice> Plans::For(const Belief& belief, const Certainty* goal, const std::vector<TakenRun>& taken,
                               double minutes_left) const {
  std::vector<Advice> advice;
  for (const Planned& planned : planned_) {
    if (planned.run.minutes > minutes_left) continue;
    const bool is_another =
        planned.run.asked.is_of_another_kind && std::ranges::none_of(taken, [&planned](const TakenRun& run) {
          return run.asked.sets == planned.run.asked.sets;
        });
    Advice one{planned.run.asked, planned.run.minutes, OfCauses_bit(belief, planned.run, is_another, means_), 0.0,
               kNaN};
    one.worth = WorthOf(planned.run, taken.front());
    if (goal && !goal->IsMet()) {
      one.u_goal = goal->With(planned.results);
      if (std::isfinite(goal->u())) one.of_goal_bit = std::max(0.0, std::log2(goal->u() / one.u_goal));
    }
    advice.push_back(std::move(one));
  }
  std::ranges::stable_sort(advice, IsFirst);
  return advice;
}

}  // namespace twinbench::investigate
