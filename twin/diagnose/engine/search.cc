#include "twin/diagnose/engine/search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "twin/core/linear_algebra.h"
#include "twin/core/units.h"
#include "twin/diagnose/engine/estimate.h"
#include "twin/diagnose/engine/holding.h"
#include "twin/diagnose/engine/overtones.h"
#include "twin/diagnose/engine/refine.h"
#include "twin/diagnose/engine/take_best.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

/// Selects term k again with all others accepted. @return true if another family took its place.
bool SelectAgain(const SearchProblem& problem, std::vector<Term>& terms, int k) {
  Term& old = terms[static_cast<std::size_t>(k)];
  const Deflation others(problem.projector, ColumnsWithout(problem, terms, k));
  Evidence evidence;
  const Term term = TakeBest(problem, others, evidence);
  const bool changed = term.family != old.family;
  old = term;
  return changed;
}

/// Rounding to steps leaves an error that repeats with what is rounded, and looks like a cause. Its rms is
/// step / sqrt(12) without noise, and falls with noise as the fundamental of a sawtooth that is smoothed does.
bool IsRounding(const SearchProblem& problem, const Deflation& others, const Term& term) {
  const double step = problem.run.rounding;
  if (!(step > 0.0)) return false;
  constexpr double kMargin = 1.1;
  // Of the readings that count: where noise moves few of them to the next step, the others show all of the sawtooth.
  const double sigma = 1.0 / std::sqrt(problem.noise.sigma.cwiseAbs2().cwiseInverse().mean());
  const double noise2 = std::max(0.0, sigma * sigma - step * step / 12.0) / (step * step);
  const double largest = kMargin * step / std::sqrt(12.0) * std::exp(-2.0 * units::kPi * units::kPi * noise2);
  const Projected data = Project(problem.projector, others, problem.white);
  const double power =
      Explain(problem.noise.Whiten(problem.run, term.columns), problem.projector, others, data.rows.col(0)).power;
  return sigma * std::sqrt(power / problem.run.Rows()) < largest;
}

bool HasRoom(const SearchProblem& problem, const std::vector<Term>& terms, const Term& more) {
  const auto count = std::ssize(terms);
  const auto is_order = [&](const Term& term) {
    return problem.scanner.Families()[static_cast<std::size_t>(term.family)].IsWholeOrder();
  };
  return count < problem.extent.most_causes ||
         (count < problem.extent.most_orders && is_order(more) && std::ranges::all_of(terms, is_order));
}

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

/// Swaps until every term is the best in its place, at most twice round.
void Swap(const SearchProblem& problem, std::vector<Term>& terms) {
  for (int round = 0; round < 2; ++round) {
    bool changed = false;
    for (int k = 0; k < std::ssize(terms); ++k) changed = SelectAgain(problem, terms, k) || changed;
    if (!changed) break;
  }
}

/// Drops what the others have made needless, one at a time: two that stand for the same thing need not both go.
void Revise(const SearchProblem& problem, SearchResult& result) {
  std::vector<Term>& terms = result.terms;
  while (std::ssize(terms) >= 2) {
    Swap(problem, terms);
    const auto weakest = std::min_element(terms.begin(), terms.end(),
                                          [](const Term& a, const Term& b) { return a.statistic < b.statistic; });
    if (weakest->statistic >= problem.threshold) return;
    terms.erase(weakest);
  }
  if (terms.size() == 1) SelectAgain(problem, terms, 0);
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

using IsOneOf = std::function<bool(const Family&)>;

bool HasAny(const SearchProblem& problem, const std::vector<Term>& terms, const IsOneOf& is_one) {
  return std::ranges::any_of(terms, [&](const Term& term) {
    return is_one(problem.scanner.Families()[static_cast<std::size_t>(term.family)]);
  });
}

bool AreInPieces(const SearchProblem& problem, const std::vector<Term>& terms) {
  constexpr int kPieces = 3;
  return std::ranges::count_if(terms, [&](const Term& term) {
           const Family& family = problem.scanner.Families()[static_cast<std::size_t>(term.family)];
           return family.goes_by_time || IsEvent(family);
         }) >= kPieces;
}

SearchProblem Without(SearchProblem problem, const IsOneOf& is_one) {
  const auto& families = problem.scanner.Families();
  for (int k = 0; k < std::ssize(families); ++k) {
    if (is_one(families[static_cast<std::size_t>(k)])) problem.log_priors[k] = kNever;
  }
  return problem;
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
  first.rest_of_bend = result.rest_of_bend;
  result = std::move(first);
}

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

bool IsUnknown(const Family& family) {
  return family.kind == Kind::kUnknown;
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

}  // namespace

SearchResult Search(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                    const Scanner& scanner, const Eigen::VectorXd& log_priors, double threshold,
                    const SearchExtent& extent) {
  const SearchProblem problem{run,        noise,     projector, scanner,
                              log_priors, threshold, extent,    noise.Whiten(run, run.residual)};
  SearchResult result;
  result.rest_of_bend = extent.bent.rest;
  Forward(problem, result);
  if (!extent.largest_only) {
    Settle(problem, result);
    TryFirst(problem, [](const Family& f) { return f.takes_any_course; }, tuning::kMostBeforeCourses, result);
    TryFirst(problem, IsUnknown, extent.most_causes, result);
    TryTogether(problem, result);
  }
  MeasureShares(problem, result.terms);
  EstimateTerms(run, noise, projector, scanner, problem.white, result.terms);
  if (!extent.largest_only && HasNamedWave(scanner.Families(), result.terms))
    result.overtones = ProbabilityOfOvertones(run, noise, projector, scanner.Families(), problem.white, result.terms,
                                              ColumnsWithout(problem, result.terms, -1));
  return result;
}

}  // namespace twinbench::diagnose
