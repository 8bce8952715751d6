#include "twin/diagnose/engine/naming.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "twin/diagnose/engine/prior.h"

namespace twinbench::diagnose {
namespace {

using Key = std::pair<std::string, std::string>;  // effect, where

constexpr double kWorthListing = 0.02;

/// One place of the search: what each cause and each unknown shape is worth there.
struct Ballot {
  std::map<Key, double> named;     // posterior by effect and place
  std::map<Key, int> best_family;  // the variant that stands for it
  double unknown = 0.0;
  int best_unknown = -1;
};

Ballot Count(const Pick& pick, const std::vector<Family>& families) {
  Ballot ballot;
  for (int k = 0; k < std::ssize(families); ++k) {
    const Family& family = families[static_cast<std::size_t>(k)];
    const double p = std::exp(pick.log_posterior[k]);
    if (family.kind == Kind::kUnknown) {
      ballot.unknown += p;
      if (ballot.best_unknown < 0 || pick.log_posterior[k] > pick.log_posterior[ballot.best_unknown])
        ballot.best_unknown = k;
      continue;
    }
    const Key key{family.effect, family.where};
    ballot.named[key] += p;
    const auto best = ballot.best_family.try_emplace(key, k).first;
    if (pick.log_posterior[k] > pick.log_posterior[best->second]) best->second = k;
  }
  return ballot;
}

std::vector<std::pair<Key, double>> Ranked(const Ballot& ballot) {
  std::vector<std::pair<Key, double>> ranked(ballot.named.begin(), ballot.named.end());
  std::ranges::stable_sort(ranked, [](const auto& a, const auto& b) { return a.second > b.second; });
  return ranked;
}

/// Amplitudes of pick k among those of all picks.
struct Slice {
  Eigen::Index at = 0, count = 0;
};
Slice SliceOf(const SearchResult& found, std::size_t k) {
  Slice slice;
  for (std::size_t j = 0; j < k; ++j) slice.at += found.picks[j].columns.cols();
  slice.count = found.picks[k].columns.cols();
  return slice;
}

bool IsPlausible(const Cause& cause) {
  return std::ranges::all_of(cause.parameters, [](const ParameterEstimate& p) {
    const double slack = std::isfinite(p.u) ? 2.0 * p.u : 0.0;
    return !(p.value < p.lower - slack) && !(p.value > p.upper + slack);
  });
}

double CapOf(const std::vector<Family>& families, const Key& key) {
  for (const Family& f : families) {
    if (Key{f.effect, f.where} == key) return f.most_probable;
  }
  return kMostProbable;
}

Cause CauseOf(const SearchResult& found, std::size_t k, const std::vector<Family>& families, const Key& key,
              double probability) {
  const Pick& pick = found.picks[k];
  const Family& family = families[static_cast<std::size_t>(pick.family)];
  Cause cause;
  cause.effect = key.first;
  cause.where = key.second;
  cause.probability = std::min(probability, CapOf(families, key));
  cause.log_evidence = pick.statistic;
  if (Key{family.effect, family.where} != key) return cause;
  const Slice s = SliceOf(found, k);
  const Eigen::VectorXd x = found.amplitudes.segment(s.at, s.count);
  const Eigen::MatrixXd cov = found.cov.block(s.at, s.at, s.count, s.count);
  cause.parameters = ParametersOf(family, pick.shape, x, cov);
  cause.rho = std::sqrt(std::max(0.0, x.dot(cov.completeOrthogonalDecomposition().solve(x))));
  return cause;
}

/// The smallest set of named causes that holds nearly all of what is not unknown.
std::vector<std::pair<Key, double>> SmallestSet(const std::vector<std::pair<Key, double>>& ranked, double unknown) {
  std::vector<std::pair<Key, double>> set;
  double sum = 0.0;
  for (const auto& entry : ranked) {
    if (!set.empty() && sum >= kTieFrom * (1.0 - unknown)) break;
    if (!set.empty() && entry.second < kWorthListing) break;
    set.push_back(entry);
    sum += entry.second;
  }
  return set;
}

/// What the search holds responsible in one place, in words and numbers.
struct Answer {
  std::vector<Cause> causes;  // empty: structure without a name
  double unknown = 0.0;
  std::string signature;
  double weight = 0.0;  // power that nothing else explains
};

/// Places where the same shape explains the data nearly as well: the fit cannot tell which body or channel it is.
std::string OtherPlaces(const Pick& pick, const std::vector<Family>& families, int best) {
  constexpr double kNearlyAsLikely = 1.6;  // in log
  const Family& chosen = families[static_cast<std::size_t>(best)];
  std::string places;
  for (int k = 0; k < std::ssize(families); ++k) {
    const Family& f = families[static_cast<std::size_t>(k)];
    if (k == best || f.kind != Kind::kUnknown || f.effect != chosen.effect || f.where == chosen.where) continue;
    if (pick.log_posterior[k] < pick.log_posterior[best] - kNearlyAsLikely) continue;
    places += (places.empty() ? "" : ", ") + f.where;
  }
  return places.empty() ? "" : "; or the same on " + places;
}

std::string SignatureOf(const SearchResult& found, std::size_t k, const std::vector<Family>& families,
                        const Ballot& ballot) {
  const Pick& pick = found.picks[k];
  const Family& family = families[static_cast<std::size_t>(pick.family)];
  if (family.kind != Kind::kUnknown || !family.describe) {
    const Family& rival = families[static_cast<std::size_t>(ballot.best_unknown)];
    return rival.effect + " on " + rival.where;
  }
  const Slice s = SliceOf(found, k);
  return family.describe(pick.grid_point, found.amplitudes.segment(s.at, s.count)) +
         OtherPlaces(pick, families, pick.family);
}

/// How much of what this cause explains each member of the set explains alone.
void AddRivals(const SearchResult& found, const std::vector<Family>& families, std::vector<Cause>& causes) {
  const auto explained = [&](const Cause& cause) {
    double most = 0.0;
    for (int k = 0; k < std::ssize(families); ++k) {
      const Family& f = families[static_cast<std::size_t>(k)];
      if (f.effect == cause.effect && f.where == cause.where) most = std::max(most, found.alone.explained(k, 0));
    }
    return most;
  };
  for (Cause& cause : causes) {
    for (const Cause& other : causes) {
      if (&other == &cause) continue;
      const double overlap = std::min(1.0, explained(other) / std::max(explained(cause), 1e-12));
      cause.indistinguishable_from.push_back({other.effect, other.where, overlap});
    }
  }
}

Answer AnswerOf(const SearchResult& found, std::size_t k, const std::vector<Family>& families) {
  const Ballot ballot = Count(found.picks[k], families);
  Answer answer;
  answer.unknown = ballot.unknown;
  answer.weight = found.picks[k].explained;
  if (ballot.best_unknown >= 0) answer.signature = SignatureOf(found, k, families, ballot);
  if (ballot.unknown > 0.5) return answer;
  const auto ranked = Ranked(ballot);
  const bool clear = !ranked.empty() && ranked.front().second >= kNamedFrom;
  const auto set = clear ? std::vector(ranked.begin(), ranked.begin() + 1) : SmallestSet(ranked, ballot.unknown);
  for (const auto& [key, probability] : set) answer.causes.push_back(CauseOf(found, k, families, key, probability));
  AddRivals(found, families, answer.causes);
  return answer;
}

/// Several named causes together against one generic shape alone, which needs no coincidence.
double ChanceOfOneUnknown(const SearchResult& found, const std::vector<Family>& families,
                          const Eigen::VectorXd& log_priors) {
  if (found.picks.size() < 2) return 0.0;
  double best = -1e300;
  for (int k = 0; k < std::ssize(families); ++k) {
    if (families[static_cast<std::size_t>(k)].kind != Kind::kUnknown) continue;
    best = std::max(best, found.alone.log_bayes(k, 0) + log_priors[k] - std::log(kPriorNone));
  }
  return 1.0 / (1.0 + std::exp(found.joint_evidence - best));
}

bool AlreadyThere(const std::vector<Cause>& causes, const Cause& cause) {
  return std::ranges::any_of(causes,
                             [&](const Cause& c) { return c.effect == cause.effect && c.where == cause.where; });
}

}  // namespace

std::vector<ParameterEstimate> ParametersOf(const Family& family, const Eigen::VectorXd& shape,
                                            const Eigen::VectorXd& amplitudes, const Eigen::MatrixXd& cov) {
  if (family.parameters) return family.parameters(shape, amplitudes, cov);
  std::vector<ParameterEstimate> parameters;
  for (std::size_t k = 0; k < family.amplitudes.size(); ++k) {
    const Amplitude& a = family.amplitudes[k];
    const auto at = static_cast<Eigen::Index>(k);
    parameters.push_back({a.name, a.unit, a.to_SI, amplitudes[at], std::sqrt(cov(at, at)), a.lower, a.upper});
  }
  for (std::size_t k = 0; k < family.shapes.size(); ++k) {
    const Shape& s = family.shapes[k];
    parameters.push_back({s.name, s.unit, s.to_SI, shape[static_cast<Eigen::Index>(k)], kNaN, s.lower, s.upper});
  }
  return parameters;
}

Naming Name(const SearchResult& found, const std::vector<Family>& families, double threshold, bool noise_free) {
  // A shape that no formula hits exactly leaves a rest; up to this share of the explained power it is no news.
  constexpr double kSmallRest = 0.015;
  Naming naming;
  if (found.picks.empty()) return naming;
  std::vector<Answer> answers;
  double weight = 0.0;
  for (std::size_t k = 0; k < found.picks.size(); ++k) {
    answers.push_back(AnswerOf(found, k, families));
    weight += std::max(0.0, answers.back().weight);
  }
  bool tie = false, unexplained = found.last_statistic > std::max(threshold, 0.5 * kSmallRest * weight);
  for (const Answer& answer : answers) {
    const bool small = answer.weight < kSmallRest * weight;
    if (noise_free && small) continue;
    if (answer.causes.empty()) {
      unexplained = unexplained || !small;
      naming.unknown.signature += (naming.unknown.signature.empty() ? "" : " | ") + answer.signature;
      naming.unknown.probability = std::max(naming.unknown.probability, small ? 0.0 : answer.unknown);
      continue;
    }
    naming.unknown.probability = std::max(naming.unknown.probability, small ? 0.0 : answer.unknown);
    tie = tie || answer.causes.size() > 1;
    for (const Cause& cause : answer.causes) {
      if (!AlreadyThere(naming.causes, cause)) naming.causes.push_back(cause);
    }
  }
  const double one_unknown = ChanceOfOneUnknown(found, families, LogPriors(families));
  naming.unknown.probability = std::max(naming.unknown.probability, one_unknown);
  for (Cause& cause : naming.causes) cause.probability = std::min(cause.probability, 1.0 - one_unknown);
  unexplained = unexplained || one_unknown > 0.5;
  const bool possible = std::ranges::all_of(naming.causes, IsPlausible);
  if (unexplained || !possible) {
    naming.verdict = Verdict::kUnknown;
    naming.unknown.probability = std::clamp(naming.unknown.probability, 0.5, 1.0);
    if (naming.unknown.signature.empty()) {
      naming.unknown.signature = possible ? "structure that the causes named here do not explain"
                                          : "as the cause named here, in a size that is not possible for it";
    }
    for (Cause& cause : naming.causes) {
      cause.probability = std::clamp(1.0 - naming.unknown.probability, 0.0, cause.probability);
    }
    return naming;
  }
  naming.verdict = naming.causes.empty() ? Verdict::kUnknown : tie ? Verdict::kTie : Verdict::kNamed;
  return naming;
}

}  // namespace twinbench::diagnose
