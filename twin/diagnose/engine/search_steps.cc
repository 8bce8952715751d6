#include "twin/diagnose/engine/search_steps.h"

#include <algorithm>
#include <cmath>

#include "twin/core/rounding.h"
#include "twin/diagnose/engine/refine.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

/// Selects term k again with all others accepted. @param beside  Their columns. @return true if another family took its place.
bool SelectAgain(const SearchProblem& problem, std::vector<Term>& terms, int k, const Eigen::MatrixXd& beside) {
  Term& old = terms[static_cast<std::size_t>(k)];
  const Deflation others(problem.projector, beside);
  Evidence evidence;
  const Term term = TakeBest(problem, others, evidence);
  const bool changed = term.family != old.family;
  old = term;
  return changed;
}

/// Rounding to steps leaves an error that repeats with what is rounded, and looks like a cause.
bool IsRounding(const SearchProblem& problem, const Deflation& others, const Term& term) {
  const double step = problem.run.rounding;
  if (!(step > 0.0)) return false;
  constexpr double kMargin = 1.1;
  // Of the readings that count: where noise moves few of them to the next step, the others show all of the sawtooth.
  const double sigma = 1.0 / std::sqrt(problem.noise.sigma.cwiseAbs2().cwiseInverse().mean());
  const Projected data = Project(problem.projector, others, problem.white);
  const double power =
      Explain(problem.noise.Whiten(problem.run, term.columns), problem.projector, others, data.rows.col(0)).power;
  return sigma * std::sqrt(power / problem.run.Rows()) < kMargin * LargestByRounding(step, sigma);
}

bool HasRoom(const SearchProblem& problem, const std::vector<Term>& terms, const Term& more) {
  const auto count = std::ssize(terms);
  const auto is_order = [&](const Term& term) {
    return problem.scanner.Families()[static_cast<std::size_t>(term.family)].IsWholeOrder();
  };
  return count < problem.extent.most_causes ||
         (count < problem.extent.most_orders && is_order(more) && std::ranges::all_of(terms, is_order));
}

/// Swaps until every term is the best in its place, at most twice round. Beside others that are the same as when it was last
/// selected a term is the same again.
void Swap(const SearchProblem& problem, std::vector<Term>& terms) {
  std::vector<Eigen::MatrixXd> beside(terms.size());
  for (int round = 0; round < 2; ++round) {
    bool changed = false;
    for (int k = 0; k < std::ssize(terms); ++k) {
      Eigen::MatrixXd others = ColumnsWithout(problem, terms, k);
      Eigen::MatrixXd& last = beside[static_cast<std::size_t>(k)];
      if (round > 0 && others.cols() == last.cols() && others == last) continue;
      changed = SelectAgain(problem, terms, k, others) || changed;
      last = std::move(others);
    }
    if (!changed) break;
  }
}

}  // namespace

void Forward(const SearchProblem& problem, SearchResult& result) {
  while (true) {
    const Deflation others(problem.projector, ColumnsWithout(problem, result.terms, -1));
    Evidence evidence;
    Term term = TakeBest(problem, others, evidence);
    if (term.statistic >= problem.threshold && IsRounding(problem, others, term)) term.statistic = kNever;
    result.last_statistic = term.statistic;
    if (result.terms.empty()) {
      result.first_statistic = term.statistic;
      result.alone = evidence;
    }
    if (term.statistic < problem.threshold || !HasRoom(problem, result.terms, term)) return;
    result.joint_evidence += term.statistic;
    result.terms.push_back(term);
    if (problem.extent.largest_only && problem.IsNamed(term.family)) return;
  }
}

void Revise(const SearchProblem& problem, SearchResult& result) {
  std::vector<Term>& terms = result.terms;
  while (std::ssize(terms) >= 2) {
    Swap(problem, terms);
    const auto weakest = std::min_element(terms.begin(), terms.end(),
                                          [](const Term& a, const Term& b) { return a.statistic < b.statistic; });
    if (weakest->statistic >= problem.threshold) return;
    terms.erase(weakest);
  }
  if (terms.size() == 1) SelectAgain(problem, terms, 0, ColumnsWithout(problem, terms, 0));
}

bool IsUnknown(const Family& family) {
  return family.kind == Kind::kUnknown;
}

bool HasAny(const SearchProblem& problem, const std::vector<Term>& terms, const IsOneOf& is_one) {
  return std::ranges::any_of(terms, [&](const Term& term) {
    return is_one(problem.scanner.Families()[static_cast<std::size_t>(term.family)]);
  });
}

SearchProblem Without(SearchProblem problem, const IsOneOf& is_one) {
  const auto& families = problem.scanner.Families();
  for (int k = 0; k < std::ssize(families); ++k) {
    if (is_one(families[static_cast<std::size_t>(k)])) problem.log_priors[k] = kNever;
  }
  return problem;
}

}  // namespace twinbench::diagnose
