#include "twin/diagnose/engine/answer.h"

#include <algorithm>
#include <cmath>

#include "twin/diagnose/engine/posterior.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

CauseKey KeyOf(const Family& family) {
  return {family.effect, family.where};
}

double ListedShareOf(const std::vector<Family>& families, const CauseKey& key) {
  const auto family = std::ranges::find(families, key, KeyOf);
  return family == families.end() ? tuning::kListed : family->listed;
}

/// @return with parameters only if it is what the search took: the rivals were not fitted.
Cause CauseOf(const Term& term, const std::vector<Family>& families, const Share& share) {
  const Family& family = families[static_cast<std::size_t>(term.family)];
  const auto& [key, probability] = share;
  Cause cause;
  cause.effect = key.first;
  cause.where = key.second;
  cause.probability = std::min(probability, 1.0) * ListedShareOf(families, key);  // sums of many shares round
  cause.log_evidence = term.statistic;
  if (KeyOf(family) != key) return cause;
  cause.parameters = ParametersOf(family, term.shape, term.amplitudes, term.cov);
  cause.rho = std::sqrt(std::max(0.0, term.explained));
  return cause;
}

/// Places where the same shape explains the data nearly as well: the fit cannot tell which body or channel it is.
std::string OtherPlaces(const Term& term, const std::vector<Family>& families) {
  const Family& chosen = families[static_cast<std::size_t>(term.family)];
  std::string places;
  for (int k = 0; k < std::ssize(families); ++k) {
    const Family& f = families[static_cast<std::size_t>(k)];
    if (k == term.family || f.kind != Kind::kUnknown || f.effect != chosen.effect || f.where == chosen.where)
      continue;
    if (term.log_posterior[k] < term.log_posterior[term.family] - tuning::kNearlyAsLikely) continue;
    places += (places.empty() ? "" : ", ") + f.where;
  }
  return places.empty() ? "" : "; or the same on " + places;
}

/// Without those that are like nothing of it.
std::vector<Share> Alike(const std::vector<Share>& set, const Term& term) {
  std::vector<Share> alike;
  double all = 0.0, kept = 0.0;
  for (const Share& share : set) {
    all += share.second;
    if (std::ranges::count(term.unlike, share.first) > 0) continue;
    alike.push_back(share);
    kept += share.second;
  }
  if (alike.empty()) return set;
  for (auto& [key, probability] : alike) probability *= all / kept;
  return alike;
}

/// In full if the search took a shape without a name, else the name of the nearest one.
std::string SignatureOf(const Term& term, const std::vector<Family>& families, const Posterior& posterior) {
  if (posterior.best_unknown < 0) return "";
  const Family& family = families[static_cast<std::size_t>(term.family)];
  if (family.kind == Kind::kUnknown && family.describe)
    return family.describe(term.grid_point, term.amplitudes, term.shape) + OtherPlaces(term, families);
  const Family& rival = families[static_cast<std::size_t>(posterior.best_unknown)];
  return rival.effect + " on " + rival.where;
}

/// The most that a cause explains of the whole run alone.
double ExplainedAlone(const Cause& cause, const SearchResult& found, const std::vector<Family>& families) {
  double most = 0.0;
  for (int k = 0; k < std::ssize(families); ++k) {
    const Family& f = families[static_cast<std::size_t>(k)];
    if (f.effect == cause.effect && f.where == cause.where) most = std::max(most, found.alone.explained(k, 0));
  }
  return most;
}

/// Within its bounds, if the family had to explain the signal.
bool CanExplain(const Family& family, int grid_point, const Eigen::VectorXd& signal) {
  if (family.amplitudes.size() != 1) return true;
  const Eigen::VectorXd column = family.ColumnsAt(grid_point).col(0);
  const double size = column.dot(signal) / column.squaredNorm();
  return size >= family.amplitudes[0].lower && size <= family.amplitudes[0].upper;
}

/// Causes that explain the same of the whole run as one that won: their signatures are one on this design, and what
/// was thought of them before is no reason to choose, unless it was that they cannot be so. Bent waves were levelled: what
/// keeps one of them back is that it may have any order.
std::vector<CauseKey> DoublesOf(const Cause& cause, const Term& term, const SearchResult& found,
                                const std::vector<Family>& families) {
  constexpr double kSame = 1e-6;  // of what it explains: rounding; likeness alone is for the evidence to judge
  std::vector<CauseKey> doubles;
  const double explained = ExplainedAlone(cause, found, families);
  for (int k = 0; k < std::ssize(families); ++k) {
    const Family& f = families[static_cast<std::size_t>(k)];
    const CauseKey key = KeyOf(f);
    if (f.kind != Kind::kNamed || key == CauseKey{cause.effect, cause.where}) continue;
    if (found.rest_of_bend > 0.0 && f.IsWholeOrder()) continue;
    const bool same = std::abs(found.alone.explained(k, 0) - explained) <= kSame * explained;
    if (!same || std::ranges::count(doubles, key) > 0) continue;
    if (CanExplain(f, found.alone.grid_point(k, 0), term.columns * term.amplitudes)) doubles.push_back(key);
  }
  return doubles;
}

/// The doubles of a cause share its probability with it.
void AddDoubles(const Term& term, const SearchResult& found, const std::vector<Family>& families,
                std::vector<Cause>& causes) {
  const auto listed = [&causes](const CauseKey& key) {
    return std::ranges::any_of(causes, [&key](const Cause& c) { return CauseKey{c.effect, c.where} == key; });
  };
  std::vector<CauseKey> doubles = DoublesOf(causes.front(), term, found, families);
  std::erase_if(doubles, listed);
  const double share = causes.front().probability / static_cast<double>(1 + std::ssize(doubles));
  causes.front().probability = share;
  for (const CauseKey& key : doubles) {
    causes.push_back(CauseOf(term, families, {key, 1.0}));
    causes.back().probability = share;
  }
}

/// Of waves that were levelled rounding says which is the most probable: the one that was taken has the sizes.
void PutTakenFirst(const CauseKey& taken, std::vector<Cause>& causes) {
  constexpr double kAsProbable = 0.999;
  const auto found = std::ranges::find_if(causes, [&](const Cause& c) { return CauseKey{c.effect, c.where} == taken; });
  if (found == causes.end() || found->probability < kAsProbable * causes.front().probability) return;
  std::rotate(causes.begin(), found, found + 1);
}

/// How much of what each cause explains the others explain alone.
void AddRivals(const SearchResult& found, const std::vector<Family>& families, std::vector<Cause>& causes) {
  constexpr double kNothing = 1e-12;
  for (Cause& cause : causes) {
    const double explained = std::max(ExplainedAlone(cause, found, families), kNothing);
    for (const Cause& other : causes) {
      if (&other == &cause) continue;
      const double overlap = std::min(1.0, ExplainedAlone(other, found, families) / explained);
      cause.indistinguishable_from.push_back({other.effect, other.where, overlap});
    }
  }
}

}  // namespace

double Likeness(const Eigen::VectorXd& one, const Eigen::VectorXd& other) {
  const double both = one.squaredNorm() * other.squaredNorm();
  return both > 0.0 ? std::pow(one.dot(other), 2) / both : 0.0;
}

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
    const double u = ShapeDeviation(family, k, cov);
    parameters.push_back({s.name, s.unit, s.to_SI, shape[static_cast<Eigen::Index>(k)], u, s.lower, s.upper});
  }
  return parameters;
}

Answer AnswerOf(const SearchResult& found, std::size_t k, const std::vector<Family>& families) {
  const Term& term = found.terms[k];
  const Posterior posterior = PosteriorOf(term, families);
  Answer answer;
  answer.unknown = posterior.unknown;
  answer.weight = term.explained;
  answer.signature = SignatureOf(term, families, posterior);
  if (posterior.unknown > 0.5) return answer;
  answer.unknown = 1.0;
  for (const auto& [key, probability] : posterior.named)
    answer.unknown -= probability * ListedShareOf(families, key);
  for (const Share& share : Alike(CredibleSet(posterior), term)) answer.causes.push_back(CauseOf(term, families, share));
  if (!answer.causes.empty() && found.terms.size() == 1) AddDoubles(term, found, families, answer.causes);
  if (found.rest_of_bend > 0.0) PutTakenFirst(KeyOf(families[static_cast<std::size_t>(term.family)]), answer.causes);
  AddRivals(found, families, answer.causes);
  return answer;
}

}  // namespace twinbench::diagnose
