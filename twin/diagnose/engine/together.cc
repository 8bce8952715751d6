#include "twin/diagnose/engine/together.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "twin/core/linear_algebra.h"
#include "twin/diagnose/engine/search_steps.h"
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

}  // namespace

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

}  // namespace twinbench::diagnose
