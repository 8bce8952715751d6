#include "twin/diagnose/engine/one_wave.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "twin/diagnose/engine/answer.h"
#include "twin/diagnose/engine/refine.h"

namespace twinbench::diagnose {
namespace {

/// Of whole orders that have a name; -1: there is none.
int WaveThatExplainsMost(const std::vector<Family>& families, const Evidence& evidence) {
  int best = -1;
  for (int k = 0; k < std::ssize(families); ++k) {
    if (!families[static_cast<std::size_t>(k)].IsWholeOrder() || !(evidence.log_bayes(k, 0) > kNever)) continue;
    if (best < 0 || evidence.explained(k, 0) > evidence.explained(best, 0)) best = k;
  }
  return best;
}

/// A wave by its columns: what has no name may be anything.
bool MayBeWave(const Family& family) {
  return family.IsWholeOrder() || (family.kind == Kind::kUnknown && family.amplitudes.size() == 2);
}

/// Families of waves that show the same as the first does at its best, with it.
std::vector<int> SameAs(int first, const SearchProblem& problem, const Deflation& others, const Projected& data,
                        const std::map<int, Eigen::VectorXd>& shapes, const Evidence& evidence) {
  constexpr double kWorthAsking = 0.5;  // of what the first explains: much less is not the same
  const std::vector<Family>& families = problem.scanner.Families();
  const auto shown_by = [&](int k) -> Eigen::VectorXd {
    const Family& family = families[static_cast<std::size_t>(k)];
    const auto refined = shapes.find(k);
    const Eigen::MatrixXd columns =
        refined == shapes.end() ? family.ColumnsAt(evidence.grid_point(k, 0)) : family.at(refined->second);
    const Explained e = Explain(problem.noise.Whiten(problem.run, columns), problem.projector, others, data.rows.col(0));
    return e.projected * e.amplitudes;
  };
  const Eigen::VectorXd shown = shown_by(first);
  std::vector<int> same = {first};
  for (int k = 0; k < std::ssize(families); ++k) {
    const bool is_worth = evidence.explained(k, 0) >= kWorthAsking * evidence.explained(first, 0);
    if (k == first || !is_worth || !MayBeWave(families[static_cast<std::size_t>(k)])) continue;
    if (Likeness(shown_by(k), shown) > problem.extent.bent.one) same.push_back(k);
  }
  return same;
}

}  // namespace

void LevelOneWave(const SearchProblem& problem, const Deflation& others, const Projected& data,
                  const std::map<int, Eigen::VectorXd>& shapes, Evidence& evidence) {
  const int first = problem.extent.bent.one < 1.0 ? WaveThatExplainsMost(problem.scanner.Families(), evidence) : -1;
  if (first < 0) return;
  const std::vector<int> same = SameAs(first, problem, others, data, shapes, evidence);
  const auto explained = [&evidence](int k) { return evidence.explained(k, 0); };
  const double most = explained(std::ranges::max(same, {}, explained));
  const double pseudo = PseudoDegrees(problem.run), power = pseudo + data.power[0];  // as in the evidence
  const double half = 0.5 * (pseudo + problem.projector.DegreesOfFreedom() - others.Rank());
  const auto points = [&](int k) { return problem.scanner.Families()[static_cast<std::size_t>(k)].grid; };
  double named = kNever, of_one_order = kNever;  // log odds; the most that speaks for one that has no orders to choose from
  for (const int k : same) {
    if (!problem.IsNamed(k)) continue;
    evidence.log_bayes(k, 0) += half * std::log((power - explained(k)) / (power - most));
    if (points(k) == 1) of_one_order = std::max(of_one_order, evidence.log_bayes(k, 0));
  }
  for (const int k : same) {
    if (!problem.IsNamed(k)) continue;
    if (of_one_order > kNever) evidence.log_bayes(k, 0) = of_one_order - std::log(points(k));
    named = std::max(named, evidence.log_bayes(k, 0) + problem.log_priors[k]);
  }
  for (const int k : same) {
    if (problem.IsNamed(k)) continue;
    double& log_bayes = evidence.log_bayes(k, 0);
    log_bayes = std::min(log_bayes, named + kBehindTheSame - problem.log_priors[k]);
  }
}

}  // namespace twinbench::diagnose
