#include "twin/diagnose/engine/naming.h"

#include <algorithm>
#include <cmath>

#include "twin/diagnose/engine/answer.h"
#include "twin/diagnose/engine/prior.h"

namespace twinbench::diagnose {
namespace {

/// A shape that no formula hits exactly leaves a rest; up to this share of the explained power it is no news.
constexpr double kSmallRest = 0.015;

/// The answers of all places, and the power that they explain.
struct Hearing {
  std::vector<Answer> answers;
  double power = 0.0;

  bool IsSmall(const Answer& answer) const { return answer.weight < kSmallRest * power; }
};

Hearing Hear(const SearchResult& found, const std::vector<Family>& families) {
  Hearing hearing;
  for (std::size_t k = 0; k < found.picks.size(); ++k) {
    hearing.answers.push_back(AnswerOf(found, k, families));
    hearing.power += std::max(0.0, hearing.answers.back().weight);
  }
  return hearing;
}

/// Every cause once, in the order of the places.
std::vector<Cause> CausesOf(const Hearing& hearing) {
  std::vector<Cause> causes;
  const auto listed = [&causes](const Cause& cause) {
    return std::ranges::any_of(causes,
                               [&](const Cause& c) { return c.effect == cause.effect && c.where == cause.where; });
  };
  for (const Answer& answer : hearing.answers) {
    for (const Cause& cause : answer.causes) {
      if (!listed(cause)) causes.push_back(cause);
    }
  }
  return causes;
}

/// The signatures of the places without a name, and the largest probability of such a shape.
UnknownPart UnknownOf(const Hearing& hearing) {
  UnknownPart unknown;
  for (const Answer& answer : hearing.answers) {
    if (!hearing.IsSmall(answer)) unknown.probability = std::max(unknown.probability, answer.unknown);
    if (!answer.causes.empty()) continue;
    unknown.signature += (unknown.signature.empty() ? "" : " | ") + answer.signature;
  }
  return unknown;
}

/// Something significant is left, or a place has a shape without a name.
bool LeavesStructure(const Hearing& hearing, double last_statistic, double threshold) {
  if (last_statistic > std::max(threshold, 0.5 * kSmallRest * hearing.power)) return true;
  return std::ranges::any_of(hearing.answers,
                             [&](const Answer& a) { return a.causes.empty() && !hearing.IsSmall(a); });
}

/// Several named causes together against one generic shape alone, which needs no coincidence.
double ChanceOfOneUnknown(const SearchResult& found, const std::vector<Family>& families) {
  if (found.picks.size() < 2) return 0.0;
  const Eigen::VectorXd log_priors = LogPriors(families);
  double best = -1e300;
  for (int k = 0; k < std::ssize(families); ++k) {
    if (families[static_cast<std::size_t>(k)].kind != Kind::kUnknown) continue;
    best = std::max(best, found.alone.log_bayes(k, 0) + log_priors[k] - std::log(kPriorNone));
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

/// The causes share what the unknown leaves.
void DeclareUnknown(const std::string& otherwise, Naming& naming) {
  naming.verdict = Verdict::kUnknown;
  naming.unknown.probability = std::clamp(naming.unknown.probability, 0.5, kMostProbable);
  if (naming.unknown.signature.empty()) naming.unknown.signature = otherwise;
  for (Cause& cause : naming.causes) {
    cause.probability = std::clamp(1.0 - naming.unknown.probability, 0.0, cause.probability);
  }
}

Verdict VerdictOf(const Hearing& hearing) {
  const auto has = [&](auto test) { return std::ranges::any_of(hearing.answers, test); };
  if (has([](const Answer& a) { return a.causes.size() > 1; })) return Verdict::kTie;
  return has([](const Answer& a) { return !a.causes.empty(); }) ? Verdict::kNamed : Verdict::kUnknown;
}

}  // namespace

Naming Name(const SearchResult& found, const std::vector<Family>& families, double threshold, bool noise_free) {
  if (found.picks.empty()) return {};
  Hearing hearing = Hear(found, families);
  if (noise_free) std::erase_if(hearing.answers, [&](const Answer& a) { return hearing.IsSmall(a); });
  Naming naming{VerdictOf(hearing), CausesOf(hearing), UnknownOf(hearing)};
  const double one_unknown = ChanceOfOneUnknown(found, families);
  Doubt(one_unknown, naming);
  if (!std::ranges::all_of(naming.causes, IsPossible)) {
    DeclareUnknown("as the cause named here, in a size that is not possible for it", naming);
  } else if (LeavesStructure(hearing, found.last_statistic, threshold) || one_unknown > 0.5) {
    DeclareUnknown("structure that the causes named here do not explain", naming);
  }
  return naming;
}

}  // namespace twinbench::diagnose
