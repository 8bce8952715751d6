#include "twin/diagnose/engine/take_best.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "twin/core/errors.h"
#include "twin/diagnose/engine/estimate.h"
#include "twin/diagnose/engine/holding.h"
#include "twin/diagnose/engine/one_wave.h"
#include "twin/diagnose/engine/prior.h"
#include "twin/diagnose/engine/refine.h"
#include "twin/diagnose/engine/repeats.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

/// A grid may be too coarse for a strong effect. Families that explain nearly as much as the best are therefore
/// moved to their best shape before they are compared; what the fit gains is paid for by the narrower shape it
/// needs.
void RefineLeaders(const SearchProblem& problem, const Deflation& others, const Projected& data, Evidence& evidence,
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

/// A shape without a name that a cause of the catalogue has exactly is no better than that cause but by chance: by
/// the grids that the two are sought on.
void HoldBehindTheSame(const SearchProblem& problem, Eigen::VectorXd& logs) {
  const auto& families = problem.scanner.Families();
  for (int k = 0; k < std::ssize(families); ++k) {
    const Family& unnamed = families[static_cast<std::size_t>(k)];
    if (unnamed.same_as.empty()) continue;
    double most = kNever;
    for (int other = 0; other < std::ssize(families); ++other) {
      const Family& family = families[static_cast<std::size_t>(other)];
      if (problem.IsTheSame(unnamed, family)) most = std::max(most, logs[other]);
    }
    if (most > kNever) logs[k] = std::min(logs[k], most + kBehindTheSame);
  }
}

/// log of the posterior of each family and, last, of nothing.
Eigen::VectorXd LogPosterior(const SearchProblem& problem, const Evidence& evidence) {
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
  const auto found = std::ranges::find_if(log_posterior, [&](double log) { return log >= best - kSame; });
  Require(found != log_posterior.end(), "evidence is a number");
  return static_cast<int>(found - log_posterior.begin());
}

/// Leaves the place to what has a name and explains nearly as much as the shape without one that is more probable
/// there.
void LeaveToNamed(const SearchProblem& problem, const Evidence& evidence, int unnamed,
                  Eigen::VectorXd& log_posterior) {
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
void TakeAmong(const SearchProblem& problem, const std::map<int, Eigen::VectorXd>& shapes, const Evidence& evidence,
               Term& term) {
  term.log_posterior = LogPosterior(problem, evidence);
  term.family = FirstOfTheBest(term.log_posterior.head(evidence.log_bayes.rows()));
  if (problem.extent.largest_only && !problem.IsNamed(term.family)) {
    LeaveToNamed(problem, evidence, term.family, term.log_posterior);
    term.family = FirstOfTheBest(term.log_posterior.head(evidence.log_bayes.rows()));
  }
  term.grid_point = evidence.grid_point(term.family, 0);
  const Family& family = problem.scanner.Families()[static_cast<std::size_t>(term.family)];
  const auto refined = shapes.find(term.family);
  term.shape = refined == shapes.end() ? family.ShapeAt(term.grid_point) : refined->second;
  term.columns = refined == shapes.end() ? family.ColumnsAt(term.grid_point) : family.at(term.shape);
}

/// A function of the place is the same at every visit. What is left may follow any course in time only as far as it
/// is not: there and back, cosine modes of the time contain every curve of the angle.
void LeaveToPlaces(const SearchProblem& problem, const Projected& data, Evidence& evidence) {
  if (problem.run.place.empty()) return;
  const double most = tuning::kMostOfNotRepeating * PowerNotRepeating(problem.run.place, data.rows.col(0));
  for (Eigen::Index k = 0; k < evidence.log_bayes.rows(); ++k) {
    const Family& family = problem.scanner.Families()[static_cast<std::size_t>(k)];
    if (family.goes_by_time && evidence.explained(k, 0) > most) evidence.log_bayes(k, 0) = kNever;
  }
}

/// An event that is none is one by no other name either.
void Refuse(const SearchProblem& problem, int refused, Evidence& evidence, Eigen::VectorXd& as_scanned) {
  const auto& families = problem.scanner.Families();
  const Family& family = families[static_cast<std::size_t>(refused)];
  for (int k = 0; k < std::ssize(families); ++k) {
    const bool is_same = IsEvent(family) && problem.IsTheSame(families[static_cast<std::size_t>(k)], family);
    if (k == refused || is_same) evidence.log_bayes(k, 0) = as_scanned[k] = kNever;
  }
}

}  // namespace

Eigen::MatrixXd ColumnsWithout(const SearchProblem& problem, const std::vector<Term>& terms, int left_out) {
  Eigen::MatrixXd columns(problem.run.Rows(), 0);
  for (int k = 0; k < std::ssize(terms); ++k) {
    if (k == left_out) continue;
    const Term& term = terms[static_cast<std::size_t>(k)];
    const Family& family = problem.scanner.Families()[static_cast<std::size_t>(term.family)];
    if (!HasSlopes(family, term.shape)) {
      columns = HStack(columns, term.columns);
      continue;
    }
    const Deflation alone(problem.projector, problem.noise.Whiten(problem.run, term.columns));
    const Eigen::VectorXd amplitudes = alone.Amplitudes(problem.projector.Apply(problem.white));
    columns = HStack(columns, WithShapeSlopes(family, term.shape, term.columns, amplitudes));
  }
  return columns.cols() > 0 ? problem.noise.Whiten(problem.run, columns) : columns;
}

Term TakeBest(const SearchProblem& problem, const Deflation& others, Evidence& evidence) {
  const Projected data = Project(problem.projector, others, problem.white);
  evidence = problem.scanner.Scan(data, others);
  LeaveToPlaces(problem, data, evidence);
  const Beside beside{problem.run, problem.noise, problem.projector, others, data};
  Eigen::VectorXd as_scanned = evidence.log_bayes.col(0) + problem.log_priors;
  const auto statistic = [&] { return LogSum(as_scanned) - std::log(tuning::kPriorNone); };
  std::map<int, Eigen::VectorXd> shapes;
  Term term;
  term.statistic = statistic();  // as calibrated: without refinement
  if (term.statistic >= problem.threshold) {
    RefineLeaders(problem, others, data, evidence, shapes);
    LevelOneWave(problem, others, data, shapes, evidence);
  }
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
  // Beside another name it is a rival: that its size and its shape stand for each other does not tell the two
  // apart. More than a rival it is not: the answer would have no size.
  const bool is_named = problem.scanner.Families()[static_cast<std::size_t>(term.family)].kind == Kind::kNamed;
  const double of_taken = evidence.log_bayes(term.family, 0) + problem.log_priors[term.family];
  for (const auto& [family, log_bayes] : of_unknown_size)
    evidence.log_bayes(family, 0) =
        is_named ? std::min(log_bayes, of_taken - problem.log_priors[family]) : log_bayes;
  (is_named ? term.log_posterior : term.log_with_unsized) = LogPosterior(problem, evidence);
  return term;
}

}  // namespace twinbench::diagnose
