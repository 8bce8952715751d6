#include "twin/diagnose/engine/search.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/diagnose/engine/estimate.h"
#include "twin/diagnose/engine/prior.h"
#include "twin/diagnose/engine/refine.h"

namespace twinbench::diagnose {
namespace {

/// What every step of the search needs.
struct Problem {
  const LinearRun& run;
  const NoiseModel& noise;
  const Projector& projector;
  const Scanner& scanner;
  const Eigen::VectorXd& log_priors;
  double threshold;
  int most_causes;
  Eigen::MatrixXd white;  // the residual, rows x 1
};

Eigen::MatrixXd Beside(const Eigen::MatrixXd& left, const Eigen::MatrixXd& right) {
  Eigen::MatrixXd both(right.rows(), left.cols() + right.cols());
  if (left.cols() > 0) both.leftCols(left.cols()) = left;
  both.rightCols(right.cols()) = right;
  return both;
}

/// Signatures of all picks but one, whitened, with the shapes' slopes: a shape that is a little off must not look
/// like a second cause.
Eigen::MatrixXd ColumnsWithout(const Problem& problem, const std::vector<Pick>& picks, int left_out) {
  Eigen::MatrixXd columns(problem.run.Rows(), 0);
  for (int k = 0; k < std::ssize(picks); ++k) {
    if (k == left_out) continue;
    const Pick& pick = picks[static_cast<std::size_t>(k)];
    const Family& family = problem.scanner.Families()[static_cast<std::size_t>(pick.family)];
    const Remainder alone(problem.projector, problem.noise.Whiten(problem.run, pick.columns));
    const Eigen::VectorXd amplitudes = alone.Amplitudes(problem.projector.Apply(problem.white));
    columns = Beside(columns, WithShapeSlopes(family, pick.shape, pick.columns, amplitudes));
  }
  return columns.cols() > 0 ? problem.noise.Whiten(problem.run, columns) : columns;
}

/// A grid may be too coarse for a strong effect. Families that explain nearly as much as the best are therefore
/// moved to their best shape before they are compared; what the fit gains is paid for by the narrower shape it
/// needs.
void RefineLeaders(const Problem& problem, const Remainder& others, const Projected& data, Evidence& evidence,
                   std::map<int, Eigen::VectorXd>& shapes) {
  constexpr double kNearlyAsMuch = 0.6;
  constexpr int kMostLeaders = 8;
  const auto& families = problem.scanner.Families();
  std::vector<int> leaders;
  const double least = kNearlyAsMuch * evidence.explained.col(0).maxCoeff();
  for (int k = 0; k < std::ssize(families); ++k) {
    const Family& family = families[static_cast<std::size_t>(k)];
    if (family.at && !family.shapes.empty() && evidence.explained(k, 0) >= least) leaders.push_back(k);
  }
  std::ranges::sort(leaders, [&](int a, int b) { return evidence.log_bayes(a, 0) > evidence.log_bayes(b, 0); });
  leaders.resize(std::min<std::size_t>(leaders.size(), kMostLeaders));
  const double half = 0.5 * problem.projector.DegreesOfFreedom(), power = data.power[0];
  for (const int k : leaders) {
    const Refined refined = RefineShape(families[static_cast<std::size_t>(k)], evidence.grid_point(k, 0),
                                        problem.run, problem.noise, problem.projector, others, data);
    shapes[k] = refined.shape;
    const double gained = half * std::log((power - evidence.explained(k, 0)) / (power - refined.explained));
    const auto count = static_cast<double>(refined.shape.size());
    evidence.log_bayes(k, 0) += std::max(0.0, gained - 0.5 * count * std::log1p(2.0 * std::max(0.0, gained)));
  }
}

/// The most probable family in a place of its own.
Pick TakeBest(const Problem& problem, const Remainder& others, Evidence& evidence) {
  const Projected data = Project(problem.projector, others, problem.white);
  evidence = problem.scanner.Scan(data, others);
  const Eigen::VectorXd as_scanned = evidence.log_bayes.col(0) + problem.log_priors;
  std::map<int, Eigen::VectorXd> shapes;
  Pick pick;
  pick.statistic = LogSum(as_scanned) - std::log(kPriorNone);  // as calibrated: without refinement
  if (pick.statistic >= problem.threshold) RefineLeaders(problem, others, data, evidence, shapes);
  const Eigen::VectorXd joint = evidence.log_bayes.col(0) + problem.log_priors;
  pick.log_posterior.resize(joint.size() + 1);
  pick.log_posterior << joint, std::log(kPriorNone);
  pick.log_posterior.array() -= LogSum(pick.log_posterior);
  Eigen::Index best = 0;
  joint.maxCoeff(&best);
  pick.family = static_cast<int>(best);
  pick.grid_point = evidence.grid_point(best, 0);
  const Family& family = problem.scanner.Families()[static_cast<std::size_t>(pick.family)];
  const auto refined = shapes.find(pick.family);
  pick.shape = refined == shapes.end() ? family.ShapeAt(pick.grid_point) : refined->second;
  pick.columns = refined == shapes.end() ? family.ColumnsAt(pick.grid_point) : family.at(pick.shape);
  return pick;
}

/// Votes on pick k again with all others accepted. @return true if another family took its place.
bool VoteAgain(const Problem& problem, std::vector<Pick>& picks, int k) {
  Pick& old = picks[static_cast<std::size_t>(k)];
  const Remainder others(problem.projector, ColumnsWithout(problem, picks, k));
  Evidence evidence;
  const Pick pick = TakeBest(problem, others, evidence);
  const bool changed = pick.family != old.family;
  old = pick;
  return changed;
}

void Forward(const Problem& problem, SearchResult& result) {
  while (true) {
    const Remainder others(problem.projector, ColumnsWithout(problem, result.picks, -1));
    Evidence evidence;
    const Pick pick = TakeBest(problem, others, evidence);
    result.last_statistic = pick.statistic;
    if (result.picks.empty()) {
      result.first_statistic = pick.statistic;
      result.alone = evidence;
    }
    if (pick.statistic < problem.threshold || std::ssize(result.picks) == problem.most_causes) return;
    result.joint_evidence += pick.statistic;
    result.picks.push_back(pick);
  }
}

/// Swaps until every pick is the best in its place, at most twice round.
void Swap(const Problem& problem, std::vector<Pick>& picks) {
  for (int round = 0; round < 2; ++round) {
    bool changed = false;
    for (int k = 0; k < std::ssize(picks); ++k) changed = VoteAgain(problem, picks, k) || changed;
    if (!changed) break;
  }
}

/// Drops what the others have made needless, one at a time: two that stand for the same thing need not both go.
void Revise(const Problem& problem, SearchResult& result) {
  std::vector<Pick>& picks = result.picks;
  while (std::ssize(picks) >= 2) {
    Swap(problem, picks);
    const auto weakest = std::min_element(picks.begin(), picks.end(),
                                          [](const Pick& a, const Pick& b) { return a.statistic < b.statistic; });
    if (weakest->statistic >= problem.threshold) return;
    picks.erase(weakest);
  }
  if (picks.size() == 1) VoteAgain(problem, picks, 0);
}

/// What each pick explains that the others cannot.
void MeasureShares(const Problem& problem, std::vector<Pick>& picks) {
  const auto power_with = [&problem](const Eigen::MatrixXd& columns) {
    return Project(problem.projector, Remainder(problem.projector, columns), problem.white).power[0];
  };
  const double left = power_with(ColumnsWithout(problem, picks, -1));
  for (int k = 0; k < std::ssize(picks); ++k) {
    picks[static_cast<std::size_t>(k)].explained = power_with(ColumnsWithout(problem, picks, k)) - left;
  }
}

}  // namespace

SearchResult Search(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                    const Scanner& scanner, const Eigen::VectorXd& log_priors, double threshold, int most_causes) {
  const Problem problem{run,        noise,     projector,   scanner,
                        log_priors, threshold, most_causes, noise.Whiten(run, run.residual)};
  SearchResult result;
  Forward(problem, result);
  const std::size_t before = result.picks.size();
  Revise(problem, result);
  if (result.picks.size() != before) {  // room for one that was hidden
    Forward(problem, result);
    Revise(problem, result);
  }
  MeasureShares(problem, result.picks);
  EstimatePicks(run, noise, projector, scanner.Families(), problem.white, result.picks);
  return result;
}

}  // namespace twinbench::diagnose
