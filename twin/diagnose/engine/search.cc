#include "twin/diagnose/engine/search.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "twin/core/linear_algebra.h"
#include "twin/diagnose/engine/estimate.h"
#include "twin/diagnose/engine/holding.h"
#include "twin/diagnose/engine/overtones.h"
#include "twin/diagnose/engine/search_steps.h"
#include "twin/diagnose/engine/take_best.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

/// Causes without a shape: nothing is sought of them but their sizes.
std::vector<Term> WithoutShapes(const SearchProblem& problem) {
  std::vector<Term> terms;
  const auto& families = problem.scanner.Families();
  for (int k = 0; k < std::ssize(families); ++k) {
    const Family& family = families[static_cast<std::size_t>(k)];
    if (family.kind != Kind::kNamed || family.at || family.grid != 1 || !(problem.log_priors[k] > kNever)) continue;
    Term& term = terms.emplace_back();
    term.family = k;
    term.shape.resize(0);
    term.columns = family.ColumnsAt(0);
  }
  return terms;
}

/// What some columns explain, by their products with each other and with the data. Directions that they hardly have are none: what two of
/// them nearly have in common would explain anything by sizes that nothing has.
double ExplainedBy(const Eigen::MatrixXd& gram, const Eigen::VectorXd& products, const std::vector<Eigen::Index>& columns) {
  constexpr double kDependent = 1e-4;  // as Deflation has it
  const SymmetricEigen eigen = EigenOfSymmetric(gram(columns, columns));
  const Eigen::ArrayXd along = (eigen.vectors.transpose() * products(columns)).array().square();
  return (eigen.values.array() > kDependent).select(along / eigen.values.array().max(kDependent), 0.0).sum();
}

/// Drops of all terms together the one that is missed least, until each is plainly missed.
void DropTheNeedless(const SearchProblem& problem, std::vector<Term>& terms) {
  const Eigen::MatrixXd white = ColumnsWithout(problem, terms, -1);
  const Projected data = Project(problem.projector, {}, problem.white);
  const Eigen::VectorXd unit = white.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  const Eigen::MatrixXd gram = unit.asDiagonal() * (white.transpose() * problem.projector.Apply(white)) * unit.asDiagonal();
  const Eigen::VectorXd products = unit.asDiagonal() * (white.transpose() * data.rows.col(0));
  std::vector<std::vector<Eigen::Index>> own;
  for (Eigen::Index at = 0; const Term& term : terms) {
    own.emplace_back();
    for (Eigen::Index k = 0; k < term.columns.cols(); ++k) own.back().push_back(at++);
  }
  const auto with = [&](std::size_t but) {
    std::vector<Eigen::Index> columns;
    for (std::size_t k = 0; k < own.size(); ++k)
      if (k != but) columns.insert(columns.end(), own[k].begin(), own[k].end());
    return columns.empty() ? 0.0 : ExplainedBy(gram, products, columns);
  };
  while (!terms.empty()) {
    const double all = with(own.size());
    const double noise = std::max(0.0, data.power[0] - all) / problem.projector.DegreesOfFreedom();
    std::vector<double> missed(own.size());
    for (std::size_t k = 0; k < own.size(); ++k) missed[k] = all - with(k);
    const auto least = std::ranges::min_element(missed);
    if (*least > tuning::kHeadline * tuning::kHeadline * noise) return;
    terms.erase(terms.begin() + (least - missed.begin()));
    own.erase(own.begin() + (least - missed.begin()));
  }
}

/// Of the families of these terms alone, each given those before it: terms that were selected again are no longer those whose evidence was
/// added up on the way.
double EvidenceOf(SearchProblem problem, const std::vector<Term>& terms) {
  std::set<std::pair<std::string, std::string>> names;
  for (const Term& term : terms) {
    const Family& family = problem.scanner.Families()[static_cast<std::size_t>(term.family)];
    names.emplace(family.effect, family.where);
  }
  problem.extent.most_causes = std::max(problem.extent.most_causes, static_cast<int>(std::ssize(terms)));
  SearchResult alone;
  Forward(Without(problem, [&](const Family& f) { return !names.contains({f.effect, f.where}); }), alone);
  return alone.joint_evidence;
}

double LeftBy(const SearchProblem& problem, const std::vector<Term>& terms) {
  return Project(problem.projector, Deflation(problem.projector, ColumnsWithout(problem, terms, -1)), problem.white).power[0];
}

/// Causes leave no more than what has shapes without a name in their place: these are then not asked for, however well their sizes suit what
/// is thought of them beforehand.
bool NeedsNoUnknown(const SearchProblem& problem, const std::vector<Term>& causes, const std::vector<Term>& other) {
  if (HasAny(problem, causes, IsUnknown) || !HasAny(problem, other, IsUnknown)) return false;
  const double left = LeftBy(problem, causes), noise = left / problem.projector.DegreesOfFreedom();
  return left < LeftBy(problem, other) + tuning::kHeadline * tuning::kHeadline * noise;
}

/// Where several causes are there at once, what explains most of all of them at the first step may be none of them, and what is taken next
/// stands beside that. Causes without a shape need no steps: all are fitted together, those are dropped that are not needed, and what is the
/// more probable of all of it stays. Of several channels: a cause shows on them together, what has no name on each by itself; on one channel
/// nothing but its size would speak for the cause.
void TryTogether(SearchProblem problem, SearchResult& result) {
  if (problem.run.Channels() < 2) return;
  const int most = problem.extent.most_causes;
  const bool is_full = most > 1 && std::ssize(result.terms) >= most;  // where one is wanted, one is all there is
  if (!is_full && !HasAny(problem, result.terms, IsUnknown)) return;
  SearchResult together;
  together.terms = WithoutShapes(problem);
  DropTheNeedless(problem, together.terms);
  if (together.terms.size() < 2) return;
  problem.extent.most_causes = std::max(most, static_cast<int>(std::ssize(together.terms)) + 1);
  Revise(Without(problem, IsUnknown), together);
  Forward(problem, together);  // not settled again: what lies off a cause's tangent, as a shape without a name, would take its place
  together.joint_evidence = EvidenceOf(problem, together.terms);
  if (together.joint_evidence <= EvidenceOf(problem, result.terms) && !NeedsNoUnknown(problem, together.terms, result.terms)) return;
  together.first_statistic = result.first_statistic;
  together.alone = result.alone;
  result = std::move(together);
}

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
