#include "twin/diagnose/engine/search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "twin/core/units.h"
#include "twin/diagnose/engine/base.h"
#include "twin/diagnose/engine/estimate.h"
#include "twin/diagnose/engine/holding.h"
#include "twin/diagnose/engine/overtones.h"
#include "twin/diagnose/engine/prior.h"
#include "twin/diagnose/engine/refine.h"
#include "twin/diagnose/engine/repeats.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

constexpr double kNever = -1e300;  // log prior

/// What every step of the search needs.
struct Problem {
  const LinearRun& run;
  const NoiseModel& noise;
  const Projector& projector;
  const Scanner& scanner;
  Eigen::VectorXd log_priors;
  double threshold;
  int most_causes;
  bool largest_only;
  Eigen::MatrixXd white;  // the residual, rows x 1

  bool IsNamed(int family) const {
    return scanner.Families()[static_cast<std::size_t>(family)].kind == Kind::kNamed;
  }

  /// The shape without a name is exactly that of the cause, on the same channel.
  bool IsTheSame(const Family& unnamed, const Family& named) const {
    return named.kind == Kind::kNamed && !unnamed.same_as.empty() && named.effect == unnamed.same_as &&
           (named.where == unnamed.where || run.Channels() == 1);
  }
};

/// Signatures of all terms but one, whitened, with the shapes' slopes: a shape that is a little off must not look
/// like a second cause.
Eigen::MatrixXd ColumnsWithout(const Problem& problem, const std::vector<Term>& terms, int left_out) {
  Eigen::MatrixXd columns(problem.run.Rows(), 0);
  for (int k = 0; k < std::ssize(terms); ++k) {
    if (k == left_out) continue;
    const Term& term = terms[static_cast<std::size_t>(k)];
    const Family& family = problem.scanner.Families()[static_cast<std::size_t>(term.family)];
    const Deflation alone(problem.projector, problem.noise.Whiten(problem.run, term.columns));
    const Eigen::VectorXd amplitudes = alone.Amplitudes(problem.projector.Apply(problem.white));
    columns = HStack(columns, WithShapeSlopes(family, term.shape, term.columns, amplitudes));
  }
  return columns.cols() > 0 ? problem.noise.Whiten(problem.run, columns) : columns;
}

/// A grid may be too coarse for a strong effect. Families that explain nearly as much as the best are therefore
/// moved to their best shape before they are compared; what the fit gains is paid for by the narrower shape it
/// needs.
void RefineLeaders(const Problem& problem, const Deflation& others, const Projected& data, Evidence& evidence,
                   std::map<int, Eigen::VectorXd>& shapes) {
  const auto& families = problem.scanner.Families();
  std::vector<int> leaders;
  const Eigen::VectorXd log_odds = evidence.log_bayes.col(0) + problem.log_priors;
  const double least = tuning::kNearlyAsMuch * evidence.explained.col(0).maxCoeff(), best = log_odds.maxCoeff();
  for (int k = 0; k < std::ssize(families); ++k) {
    const Family& family = families[static_cast<std::size_t>(k)];
    // What takes up noise as well explains far more than a wave that it follows.
    const double may_gain = 0.5 * tuning::kLostBetween * evidence.explained(k, 0);
    const bool leads = evidence.explained(k, 0) >= least || log_odds[k] + may_gain >= best;
    if (family.at && !family.shapes.empty() && leads) leaders.push_back(k);
  }
  std::ranges::sort(leaders, [&](int a, int b) { return evidence.log_bayes(a, 0) > evidence.log_bayes(b, 0); });
  leaders.resize(std::min<std::size_t>(leaders.size(), tuning::kMostLeaders));
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

/// A shape without a name that a cause of the catalogue has exactly is no better than that cause but by chance: by the
/// grids that the two are sought on. It is as much less likely than the cause as what looks so and is not listed.
void HoldBehindTheSame(const Problem& problem, Eigen::VectorXd& logs) {
  const double behind = std::log((1.0 - tuning::kListed) / tuning::kListed);
  const auto& families = problem.scanner.Families();
  for (int k = 0; k < std::ssize(families); ++k) {
    const Family& unnamed = families[static_cast<std::size_t>(k)];
    if (unnamed.same_as.empty()) continue;
    double most = kNever;
    for (int other = 0; other < std::ssize(families); ++other) {
      const Family& family = families[static_cast<std::size_t>(other)];
      if (problem.IsTheSame(unnamed, family)) most = std::max(most, logs[other]);
    }
    if (most > kNever) logs[k] = std::min(logs[k], most + behind);
  }
}

/// log of the posterior of each family and, last, of nothing.
Eigen::VectorXd LogPosterior(const Problem& problem, const Evidence& evidence) {
  Eigen::VectorXd logs(evidence.log_bayes.rows() + 1);
  logs << evidence.log_bayes.col(0) + problem.log_priors, std::log(tuning::kPriorNone);
  HoldBehindTheSame(problem, logs);
  logs.array() -= LogSum(logs);
  return logs;
}

/// Of those that explain the same, the one that the bench lists first: which of them is no matter of chance.
int FirstOfTheBest(const Eigen::VectorXd& log_posterior) {
  constexpr double kSame = 0.1;  // log
  const double best = log_posterior.maxCoeff();
  int first = 0;
  while (!(log_posterior[first] >= best - kSame)) ++first;
  return first;
}

/// Leaves the place to what has a name and explains nearly as much as the shape without one that is more probable there.
void LeaveToNamed(const Problem& problem, const Evidence& evidence, int unnamed, Eigen::VectorXd& log_posterior) {
  const auto& families = problem.scanner.Families();
  const bool is_course = families[static_cast<std::size_t>(unnamed)].takes_any_course;
  const double least = problem.threshold + std::log(tuning::kPriorNone);
  Eigen::VectorXd named = Eigen::VectorXd::Constant(log_posterior.size(), kNever);
  for (int k = 0; k < std::ssize(families); ++k) {
    const bool is_near = evidence.explained(k, 0) >= tuning::kNearlyAsMuch * evidence.explained(unnamed, 0);
    const bool is_there = evidence.log_bayes(k, 0) + problem.log_priors[k] > least;
    const bool is_piece = is_course && IsEvent(families[static_cast<std::size_t>(k)]);
    if (problem.IsNamed(k) && is_near && is_there && !is_piece) named[k] = log_posterior[k];
  }
  if (named.maxCoeff() > kNever) log_posterior = named.array() - LogSum(named);
}

/// The most probable of what is left.
void TakeAmong(const Problem& problem, const std::map<int, Eigen::VectorXd>& shapes, const Evidence& evidence,
               Term& term) {
  term.log_posterior = LogPosterior(problem, evidence);
  term.family = FirstOfTheBest(term.log_posterior.head(evidence.log_bayes.rows()));
  if (problem.largest_only && !problem.IsNamed(term.family)) {
    LeaveToNamed(problem, evidence, term.family, term.log_posterior);
    term.family = FirstOfTheBest(term.log_posterior.head(evidence.log_bayes.rows()));
  }
  term.grid_point = evidence.grid_point(term.family, 0);
  const Family& family = problem.scanner.Families()[static_cast<std::size_t>(term.family)];
  const auto refined = shapes.find(term.family);
  term.shape = refined == shapes.end() ? family.ShapeAt(term.grid_point) : refined->second;
  term.columns = refined == shapes.end() ? family.ColumnsAt(term.grid_point) : family.at(term.shape);
}

/// A function of the place is the same at every visit. What is left may follow any course in time only as far as it is
/// not: there and back, cosine modes of the time contain every curve of the angle.
void LeaveToPlaces(const Problem& problem, const Projected& data, Evidence& evidence) {
  if (problem.run.place.empty()) return;
  const double most = tuning::kMostOfNotRepeating * PowerNotRepeating(problem.run.place, data.rows.col(0));
  for (Eigen::Index k = 0; k < evidence.log_bayes.rows(); ++k) {
    const Family& family = problem.scanner.Families()[static_cast<std::size_t>(k)];
    if (family.goes_by_time && evidence.explained(k, 0) > most) evidence.log_bayes(k, 0) = kNever;
  }
}

/// An event that is none is one by no other name either.
void Refuse(const Problem& problem, int refused, Evidence& evidence, Eigen::VectorXd& as_scanned) {
  const auto& families = problem.scanner.Families();
  const Family& family = families[static_cast<std::size_t>(refused)];
  for (int k = 0; k < std::ssize(families); ++k) {
    const bool is_same = IsEvent(family) && problem.IsTheSame(families[static_cast<std::size_t>(k)], family);
    if (k == refused || is_same) evidence.log_bayes(k, 0) = as_scanned[k] = kNever;
  }
}

/// The most probable family in a place of its own.
Term TakeBest(const Problem& problem, const Deflation& others, Evidence& evidence) {
  const Projected data = Project(problem.projector, others, problem.white);
  evidence = problem.scanner.Scan(data, others);
  LeaveToPlaces(problem, data, evidence);
  const Beside beside{problem.run, problem.noise, problem.projector, others, data};
  Eigen::VectorXd as_scanned = evidence.log_bayes.col(0) + problem.log_priors;
  const auto statistic = [&] { return LogSum(as_scanned) - std::log(tuning::kPriorNone); };
  std::map<int, Eigen::VectorXd> shapes;
  Term term;
  term.statistic = statistic();  // as calibrated: without refinement
  if (term.statistic >= problem.threshold) RefineLeaders(problem, others, data, evidence, shapes);
  // A name that does not hold leaves its probability to the others.
  std::map<int, double> of_unknown_size;
  for (;;) {
    TakeAmong(problem, shapes, evidence, term);
    const Family& family = problem.scanner.Families()[static_cast<std::size_t>(term.family)];
    const double log_bayes = evidence.log_bayes(term.family, 0);
    const bool all_refused = !(log_bayes > kNever);
    if (term.statistic < problem.threshold || all_refused) break;
    if (IsInside(family, term.shape) && IsSudden(family, term, beside)) {
      if (IsThere(family, term, beside)) break;
      of_unknown_size[term.family] = log_bayes;
    }
    Refuse(problem, term.family, evidence, as_scanned);
    term.statistic = statistic();
  }
  if (of_unknown_size.empty()) return term;
  // Beside another name it is a rival: that its size and its shape stand for each other does not tell the two apart.
  const bool is_named = problem.scanner.Families()[static_cast<std::size_t>(term.family)].kind == Kind::kNamed;
  for (const auto& [family, log_bayes] : of_unknown_size) evidence.log_bayes(family, 0) = log_bayes;
  (is_named ? term.log_posterior : term.log_with_unsized) = LogPosterior(problem, evidence);
  return term;
}

/// Selects term k again with all others accepted. @return true if another family took its place.
bool SelectAgain(const Problem& problem, std::vector<Term>& terms, int k) {
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
bool IsRounding(const Problem& problem, const Deflation& others, const Term& term) {
  const double step = problem.run.rounding;
  if (!(step > 0.0)) return false;
  constexpr double kMargin = 1.1;
  const double sigma = problem.run.sigma.mean();
  const double noise2 = std::max(0.0, sigma * sigma - step * step / 12.0) / (step * step);
  const double largest = kMargin * step / std::sqrt(12.0) * std::exp(-2.0 * units::kPi * units::kPi * noise2);
  const Projected data = Project(problem.projector, others, problem.white);
  const double power =
      Explain(problem.noise.Whiten(problem.run, term.columns), problem.projector, others, data.rows.col(0)).power;
  return sigma * std::sqrt(power / problem.run.Rows()) < largest;
}

void Forward(const Problem& problem, SearchResult& result) {
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
    if (term.statistic < problem.threshold || std::ssize(result.terms) == problem.most_causes) return;
    result.joint_evidence += term.statistic;
    result.terms.push_back(term);
    if (problem.largest_only && problem.IsNamed(term.family)) return;
  }
}

/// Swaps until every term is the best in its place, at most twice round.
void Swap(const Problem& problem, std::vector<Term>& terms) {
  for (int round = 0; round < 2; ++round) {
    bool changed = false;
    for (int k = 0; k < std::ssize(terms); ++k) changed = SelectAgain(problem, terms, k) || changed;
    if (!changed) break;
  }
}

/// Drops what the others have made needless, one at a time: two that stand for the same thing need not both go.
void Revise(const Problem& problem, SearchResult& result) {
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
void MeasureShares(const Problem& problem, std::vector<Term>& terms) {
  const auto power_with = [&problem](const Eigen::MatrixXd& columns) {
    return Project(problem.projector, Deflation(problem.projector, columns), problem.white).power[0];
  };
  const double left = power_with(ColumnsWithout(problem, terms, -1));
  for (int k = 0; k < std::ssize(terms); ++k) {
    terms[static_cast<std::size_t>(k)].explained = power_with(ColumnsWithout(problem, terms, k)) - left;
  }
}

/// Until nothing changes.
void Settle(const Problem& problem, SearchResult& result) {
  const std::size_t before = result.terms.size();
  Revise(problem, result);
  if (result.terms.size() == before) return;
  Forward(problem, result);  // room for one that was hidden
  Revise(problem, result);
}

using IsOneOf = std::function<bool(const Family&)>;

bool HasAny(const Problem& problem, const std::vector<Term>& terms, const IsOneOf& is_one) {
  return std::ranges::any_of(terms, [&](const Term& term) {
    return is_one(problem.scanner.Families()[static_cast<std::size_t>(term.family)]);
  });
}

bool AreInPieces(const Problem& problem, const std::vector<Term>& terms) {
  constexpr int kPieces = 3;
  return std::ranges::count_if(terms, [&](const Term& term) {
           const Family& family = problem.scanner.Families()[static_cast<std::size_t>(term.family)];
           return family.goes_by_time || IsEvent(family);
         }) >= kPieces;
}

Problem Without(Problem problem, const IsOneOf& is_one) {
  const auto& families = problem.scanner.Families();
  for (int k = 0; k < std::ssize(families); ++k) {
    if (is_one(families[static_cast<std::size_t>(k)])) problem.log_priors[k] = kNever;
  }
  return problem;
}

/// What has many columns may explain at one step what several that have a form explain together, and is taken before
/// any of them: then these are tried first, and what is the more probable of all of it stays.
/// @param most  Of these.
void TryFirst(Problem problem, const IsOneOf& is_last, int most, SearchResult& result) {
  if (!HasAny(problem, result.terms, is_last)) return;
  SearchResult first;
  Problem plain = Without(problem, is_last);
  plain.most_causes = std::max(most, problem.most_causes);
  Forward(plain, first);
  if (first.terms.size() < 2 || first.joint_evidence <= result.joint_evidence) return;
  if (AreInPieces(problem, first.terms)) return;
  problem.most_causes = std::max(plain.most_causes, static_cast<int>(std::ssize(first.terms)) + 1);
  Forward(problem, first);
  Settle(problem, first);
  first.first_statistic = result.first_statistic;
  first.alone = result.alone;
  result = std::move(first);
}

}  // namespace

SearchResult Search(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                    const Scanner& scanner, const Eigen::VectorXd& log_priors, double threshold, int most_causes,
                    bool largest_only) {
  const Problem problem{run,       noise,       projector,    scanner,
                        log_priors, threshold,  most_causes,  largest_only, noise.Whiten(run, run.residual)};
  SearchResult result;
  Forward(problem, result);
  if (!largest_only) {
    Settle(problem, result);
    TryFirst(problem, [](const Family& f) { return f.takes_any_course; }, tuning::kMostBeforeCourses, result);
    TryFirst(problem, [](const Family& f) { return f.kind == Kind::kUnknown; }, most_causes, result);
  }
  MeasureShares(problem, result.terms);
  EstimateTerms(run, noise, projector, scanner, problem.white, result.terms);
  if (!largest_only && HasNamedWave(scanner.Families(), result.terms))
    result.overtones = ProbabilityOfOvertones(run, noise, projector, scanner.Families(), problem.white, result.terms,
                                              ColumnsWithout(problem, result.terms, -1));
  return result;
}

}  // namespace twinbench::diagnose
