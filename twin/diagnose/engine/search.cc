#include "twin/diagnose/engine/search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/diagnose/engine/estimate.h"
#include "twin/diagnose/engine/holding.h"
#include "twin/diagnose/engine/overtones.h"
#include "twin/diagnose/engine/search_steps.h"
#include "twin/diagnose/engine/together.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

/// What each term explains that the others cannot.
void MeasureShares(const SearchProblem& problem, std::vector<Term>& terms) {
  const auto power_with = [&problem](const Eigen::MatrixXd& columns) {
    return Project(problem.projector, Deflation(problem.projector, columns), problem.white).power[0];
  };
  const double left = power_with(ColumnsWithout(problem, terms, -1));
  for (int k = 0; k < std::ssize(terms); ++k) {
    terms[static_cast<std::size_t>(k)].explained = power_with(ColumnsWithout(problem, terms, k)) - left;
  }
}

/// Until nothing changes.
void Settle(const SearchProblem& problem, SearchResult& result) {
  const std::size_t before = result.terms.size();
  Revise(problem, result);
  if (result.terms.size() == before) return;
  Forward(problem, result);  // room for one that was hidden
  Revise(problem, result);
}

bool AreInPieces(const SearchProblem& problem, const std::vector<Term>& terms) {
  constexpr int kPieces = 3;
  return std::ranges::count_if(terms, [&](const Term& term) {
           const Family& family = problem.scanner.Families()[static_cast<std::size_t>(term.family)];
           return family.goes_by_time || IsEvent(family);
         }) >= kPieces;
}

/// What has many columns may explain at one step what several that have a form explain together, and is taken before
/// any of them: then these are tried first, and what is the more probable of all of it stays.
/// @param most  Of these.
void TryFirst(SearchProblem problem, const IsOneOf& is_last, int most, SearchResult& result) {
  if (!HasAny(problem, result.terms, is_last)) return;
  SearchResult first;
  SearchProblem plain = Without(problem, is_last);
  plain.extent.most_causes = std::max(most, problem.extent.most_causes);
  Forward(plain, first);
  if (first.terms.size() < 2 || first.joint_evidence <= result.joint_evidence) return;
  if (AreInPieces(problem, first.terms)) return;
  problem.extent.most_causes = std::max(plain.extent.most_causes, static_cast<int>(std::ssize(first.terms)) + 1);
  Forward(problem, first);
  Settle(problem, first);
  first.first_statistic = result.first_statistic;
  first.alone = result.alone;
  result = std::move(first);
}

}  // namespace

SearchResult Search(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                    const Scanner& scanner, const Eigen::VectorXd& log_priors, double threshold,
                    const SearchExtent& extent) {
  const SearchProblem problem{run,        noise,     projector, scanner,
                              log_priors, threshold, extent,    noise.Whiten(run, run.residual)};
  SearchResult result;
  Forward(problem, result);
  if (!extent.largest_only) {
    Settle(problem, result);
    TryFirst(problem, [](const Family& f) { return f.takes_any_course; }, tuning::kMostBeforeCourses, result);
    TryFirst(problem, IsUnknown, extent.most_causes, result);
    if (extent.together) TryTogether(problem, result);
  }
  result.rest_of_bend = extent.bent.rest;
  MeasureShares(problem, result.terms);
  EstimateTerms(run, noise, projector, scanner, problem.white, result.terms);
  if (!extent.largest_only && HasNamedWave(scanner.Families(), result.terms))
    result.overtones = ProbabilityOfOvertones(run, noise, projector, scanner.Families(), problem.white, result.terms,
                                              ColumnsWithout(problem, result.terms, -1));
  return result;
}

}  // namespace twinbench::diagnose
