#include "twin/diagnose/engine/naming.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "twin/diagnose/engine/answer.h"
#include "twin/diagnose/engine/prior.h"
#include "twin/diagnose/tuning.h"

namespace twinbench::diagnose {
namespace {

constexpr const char* kStructureUnexplained = "structure that the causes identified here do not explain";

/// The answers of all places, and the power that they explain.
struct Answered {
  std::vector<Answer> answers;
  double power = 0.0;

  bool IsSmall(const Answer& answer) const { return answer.weight < tuning::kSmallRest * power; }
};

Answered AnswerAll(const SearchResult& found, const std::vector<Family>& families) {
  Answered answered;
  for (std::size_t k = 0; k < found.terms.size(); ++k) {
    answered.answers.push_back(AnswerOf(found, k, families));
    answered.power += std::max(0.0, answered.answers.back().weight);
  }
  return answered;
}

/// Of a parameter; NaN where a cause has none of that name or was not fitted.
double Value(const Cause& cause, const std::string& name) {
  const auto found = std::ranges::find(cause.parameters, name, &ParameterEstimate::name);
  return found == cause.parameters.end() ? kNaN : found->value;
}

/// Two orders, tones or steps of one effect are two causes.
bool IsSame(const Cause& a, const Cause& b) {
  constexpr std::array kTellApart = {"order", "frequency", "at_reading"};
  const bool apart = std::ranges::any_of(
      kTellApart, [&](const char* name) { return std::abs(Value(a, name) - Value(b, name)) > 0.0; });
  return a.effect == b.effect && a.where == b.where && !apart;
}

/// Every cause once, in the order of the places.
std::vector<Cause> CausesOf(const Answered& answered) {
  std::vector<Cause> causes;
  const auto listed = [&causes](const Cause& cause) {
    return std::ranges::any_of(causes, [&](const Cause& c) { return IsSame(c, cause); });
  };
  for (const Answer& answer : answered.answers) {
    for (const Cause& cause : answer.causes) {
      if (!listed(cause)) causes.push_back(cause);
    }
  }
  return causes;
}

/// The signatures of the places without a name, and the largest probability of such a shape.
UnknownPart UnknownOf(const Answered& answered) {
  UnknownPart unknown;
  for (const Answer& answer : answered.answers) {
    if (!answered.IsSmall(answer)) unknown.probability = std::max(unknown.probability, answer.unknown);
    if (!answer.causes.empty()) continue;
    unknown.signature += (unknown.signature.empty() ? "" : " | ") + answer.signature;
  }
  return unknown;
}

double UnnamedPower(const Answered& answered) {
  double power = 0.0;
  for (const Answer& answer : answered.answers) {
    if (answer.causes.empty()) power += std::max(0.0, answer.weight);
  }
  return power;
}

/// Something significant is left.
bool LeavesStructure(const Answered& answered, double last_statistic, double threshold) {
  return last_statistic > std::max(threshold, 0.5 * tuning::kSmallRest * answered.power);
}

Eigen::VectorXd SignalOf(const Term& term) {
  return term.columns * term.amplitudes;
}

/// What has a name and is like what has none may be no more than a piece of that, a constant beside the same that
/// follows the temperature; and so may what is as small as the rest that a shape without a formula leaves.
void MarkPieces(const SearchResult& found, Answered& answered) {
  Eigen::VectorXd unnamed = Eigen::VectorXd::Zero(found.terms.front().columns.rows());
  for (std::size_t k = 0; k < answered.answers.size(); ++k) {
    if (answered.answers[k].causes.empty()) unnamed += SignalOf(found.terms[k]);
  }
  const double rest = tuning::kSmallRest * UnnamedPower(answered);
  for (std::size_t k = 0; k < answered.answers.size(); ++k) {
    Answer& answer = answered.answers[k];
    answer.may_be_piece = answer.weight < rest || Likeness(SignalOf(found.terms[k]), unnamed) > kAlike;
  }
}

/// A wave beside a larger one that its bend may leave is no cause.
void LeaveOutBends(const SearchResult& found, const std::vector<Family>& families, Answered& answered) {
  if (!(found.rest_of_bend > 0.0)) return;
  double most = 0.0;
  const auto is_wave = [&](std::size_t k) {
    return families[static_cast<std::size_t>(found.terms[k].family)].IsWholeOrder();
  };
  for (std::size_t k = 0; k < found.terms.size(); ++k)
    if (is_wave(k)) most = std::max(most, answered.answers[k].weight);
  std::vector<Answer> kept;
  for (std::size_t k = 0; k < found.terms.size(); ++k)
    if (!is_wave(k) || answered.answers[k].weight >= found.rest_of_bend * most) kept.push_back(answered.answers[k]);
  answered.answers = std::move(kept);
}

/// Power of what has a name and is not like what has none.
double OwnPower(const Answered& answered) {
  double power = 0.0;
  for (const Answer& answer : answered.answers) {
    if (!answer.causes.empty() && !answer.may_be_piece) power += std::max(0.0, answer.weight);
  }
  return power;
}

bool StandsAlone(const Cause& cause, const Answered& answered) {
  return std::ranges::any_of(answered.answers, [&](const Answer& answer) {
    return !answer.may_be_piece && std::ranges::any_of(answer.causes, [&](const Cause& c) { return IsSame(c, cause); });
  });
}

/// What has no name explains more than what has one, or something larger is left.
bool IsMostlyUnnamed(const SearchResult& found, const Answered& answered, double threshold) {
  const double left = found.last_statistic > threshold ? 2.0 * found.last_statistic : 0.0;
  return UnnamedPower(answered) + left > OwnPower(answered);
}

/// Several named causes together against one generic shape alone, which needs no coincidence.
double ChanceOfOneUnknown(const SearchResult& found, const std::vector<Family>& families) {
  if (found.terms.size() < 2) return 0.0;
  const Eigen::VectorXd log_priors = LogPriors(families);
  double best = -1e300;
  for (int k = 0; k < std::ssize(families); ++k) {
    if (families[static_cast<std::size_t>(k)].kind != Kind::kUnknown) continue;
    best = std::max(best, found.alone.log_bayes(k, 0) + log_priors[k] - std::log(tuning::kPriorNone));
  }
  return 1.0 / (1.0 + std::exp(found.joint_evidence - best));
}

void Doubt(double one_unknown, Naming& naming) {
  naming.unknown.probability = std::max(naming.unknown.probability, one_unknown);
  for (Cause& cause : naming.causes) cause.probability = std::min(cause.probability, 1.0 - one_unknown);
}

/// All parameters within what is physically possible, by two standard deviations.
bool IsPossible(const Cause& cause) {
  return std::ranges::all_of(cause.parameters, [](const ParameterEstimate& p) {
    const double slack = std::isfinite(p.u) ? 2.0 * p.u : 0.0;
    return !(p.value < p.lower - slack) && !(p.value > p.upper + slack);
  });
}

/// What has no name is another cause. One that has and is like it may be no more than a piece of it: it keeps its
/// probability as far as it explains more than that.
void DeclareUnknown(const std::string& otherwise, const Answered& answered, Naming& naming) {
  const double unnamed = UnnamedPower(answered);
  naming.verdict = Verdict::kUnknown;
  naming.unknown.probability = std::clamp(naming.unknown.probability, 0.5, tuning::kListed);
  if (naming.unknown.signature.empty()) naming.unknown.signature = otherwise;
  for (Cause& cause : naming.causes) {
    if (IsPossible(cause) && StandsAlone(cause, answered)) continue;
    const double own = std::isfinite(cause.rho) ? cause.rho * cause.rho : 0.0;
    const double share = own > 0.0 ? own / (own + unnamed) : 0.0;
    const double left = std::max(share, 1.0 - naming.unknown.probability);
    cause.probability = IsPossible(cause) ? std::min(cause.probability, left) : 1.0 - naming.unknown.probability;
  }
}

/// A tone or a step has its own place in a bench; many of them at one place are the pieces of something else, which
/// no formula of the catalogue has: a chirp, lost counts. Orders of an angle are not: a wheel may well have many.
bool IsPiece(const Cause& cause, const std::vector<Cause>& causes) {
  constexpr std::ptrdiff_t kPieces = 3;
  const bool is_own = std::isnan(Value(cause, "frequency")) && std::isnan(Value(cause, "at_reading"));
  return !is_own && std::ranges::count_if(causes, [&](const Cause& c) {
                      return c.effect == cause.effect && c.where == cause.where;
                    }) >= kPieces;
}

/// @return the effects that came in pieces, which then are hardly believed.
std::string DisbelievePieces(Naming& naming) {
  const std::vector<Cause> all = naming.causes;
  std::string effects;
  for (Cause& cause : naming.causes) {
    if (!IsPiece(cause, all)) continue;
    cause.probability = std::min(cause.probability, 1.0 - tuning::kListed);
    if (effects.find(cause.effect) == std::string::npos) effects += (effects.empty() ? "" : ", ") + cause.effect;
  }
  return effects;
}

Verdict VerdictOf(const Answered& answered) {
  const auto has = [&](auto test) { return std::ranges::any_of(answered.answers, test); };
  if (has([](const Answer& a) { return a.causes.size() > 1; })) return Verdict::kTie;
  return has([](const Answer& a) { return !a.causes.empty(); }) ? Verdict::kNamed : Verdict::kUnknown;
}

}  // namespace

Naming Name(const SearchResult& found, const std::vector<Family>& families, double threshold, bool noise_free) {
  if (found.terms.empty()) return {};
  Answered answered = AnswerAll(found, families);
  MarkPieces(found, answered);
  const bool is_mostly_unnamed = IsMostlyUnnamed(found, answered, threshold);
  LeaveOutBends(found, families, answered);
  if (noise_free) std::erase_if(answered.answers, [&](const Answer& a) { return answered.IsSmall(a); });
  Naming naming{VerdictOf(answered), CausesOf(answered), UnknownOf(answered)};
  const double one_unknown = ChanceOfOneUnknown(found, families);
  Doubt(std::max(one_unknown, found.overtones), naming);
  if (!std::ranges::all_of(naming.causes, IsPossible)) {
    DeclareUnknown("as the cause identified here, in a size that is not possible for it", answered, naming);
  } else if (found.overtones > 0.5) {
    DeclareUnknown("something that repeats as the wave identified here and is no sine, function of time", answered, naming);
  } else if (is_mostly_unnamed || one_unknown > 0.5) {
    DeclareUnknown(kStructureUnexplained, answered, naming);
  } else if (naming.unknown.signature.empty() && LeavesStructure(answered, found.last_statistic, threshold)) {
    naming.unknown = {tuning::kListed, kStructureUnexplained};
  }
  if (const std::string effects = DisbelievePieces(naming); !effects.empty()) {
    naming.verdict = Verdict::kUnknown;
    naming.unknown.probability = std::max(naming.unknown.probability, tuning::kListed);
    naming.unknown.signature += (naming.unknown.signature.empty() ? "" : " | ") +
                                ("structure of which many effects " + effects + " are the pieces, function of time");
  }
  return naming;
}

}  // namespace twinbench::diagnose
