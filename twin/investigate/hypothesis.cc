#include "twin/investigate/hypothesis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "twin/core/happened_once.h"
#include "twin/core/signal_effect.h"
#include "twin/core/units.h"
#include "twin/diagnose/cause_groups.h"
#include "twin/diagnose/extend.h"

namespace twinbench::investigate {
namespace {

using diagnose::Cause;

constexpr std::size_t kMost = 12;
constexpr const char* kUnnamed = "unmodelled effect";

bool IsSameCause(const Supposed& a, const Supposed& b) {
  return a.name == b.name && a.where == b.where && (a.happened_in == b.happened_in || !HappensOnce(a));
}

/// Signals that the diagnosis writes for structure without a name, where they are more than a table of that run.
std::vector<EffectSettings> SignalsOf(const diagnose::DiagnosisRun& found, const Scenario& scenario) {
  std::vector<EffectSettings> signals;
  const Scenario extended = diagnose::Extend(scenario, found, "");
  for (std::size_t k = scenario.effects.size(); k < extended.effects.size(); ++k) {
    if (!extended.effects[k].signal.empty()) signals.push_back(extended.effects[k]);
  }
  return signals;
}

/// A signal is written without uncertainties: its size is known to about a tenth, its phase to as many radians.
void FreeSizes(EffectSettings& signal, const std::string& bench) {
  constexpr double kTenth = 0.1;
  for (const EffectParameter& p : EntryOf(signal, bench).parameters) {
    const double size = std::abs(signal.parameters.at(p.name));
    if ((p.name == "amplitude" || p.name == "share") && size > 0.0) signal.finding.u[p.name] = kTenth * size;
    if (p.name == kPhase) signal.finding.u[p.name] = kTenth;
  }
}

double Sum(const std::vector<Cause>& causes, const diagnose::CauseGroup& group) {
  double sum = 0.0;
  for (const std::size_t k : group) sum += causes[k].probability;
  return sum;
}

/// A rival may come without sizes: then they are where the catalogue has them, as uncertain as they are large,
/// until they are fitted.
EffectSettings Sized(const Cause& cause, const std::string& bench) {
  EffectSettings effect = diagnose::EffectOf(cause, bench, "");
  if (!effect.finding.u.empty()) return effect;
  const EffectEntry entry = EntryOf(effect, bench);
  for (const EffectParameter& p : entry.parameters) {
    if (effect.parameters.contains(p.name)) effect.finding.u[p.name] = ThoughtOf(p, entry);
  }
  return effect;
}

const Cause* FindIn(const std::vector<Cause>& causes, const std::string& effect, const std::string& where) {
  const auto at = std::ranges::find_if(causes, [&](const Cause& c) { return c.effect == effect && c.where == where; });
  return at == causes.end() ? nullptr : &*at;
}

/// Those of the same name and unit become as `from` has them.
void ShareParameters(const std::vector<diagnose::ParameterEstimate>& from, std::vector<diagnose::ParameterEstimate>& to) {
  for (diagnose::ParameterEstimate& p : to) {
    const auto same = std::ranges::find(from, p.name, &diagnose::ParameterEstimate::name);
    if (same != from.end() && same->unit == p.unit) p = *same;
  }
}

/// Its fit alone shows most of what the other's does.
bool IsAsStrong(const Cause& alone, const Cause& other) {
  constexpr double kNearlyAll = 0.7;
  return alone.rho > kNearlyAll * other.rho;
}

/// What readings leave open.
struct Finding {
  const diagnose::DiagnosisRun& found;
  const std::string& bench;
  int run;  // that was diagnosed

  /// Causes that the diagnosis did not fit are as large as they would be alone. Where that says little, for most of
  /// it was taken out first as another one's, what they have in common with that one - an order - is as there.
  Supposed Suppose(Cause cause) const {
    if (cause.parameters.empty()) {
      const Cause* alone = FindIn(found.suspects, cause.effect, cause.where);
      if (alone) cause.parameters = alone->parameters;
      for (const diagnose::Rival& rival : cause.indistinguishable_from) {
        const Cause* fitted = FindIn(found.diagnosis.causes, rival.effect, rival.where);
        if (!fitted || fitted->parameters.empty() || (alone && IsAsStrong(*alone, *fitted))) continue;
        ShareParameters(fitted->parameters, cause.parameters);
      }
    }
    Supposed supposed{Sized(cause, bench)};
    if (HappensOnce(supposed)) supposed.happened_in = run;
    for (const diagnose::ParameterEstimate& p : cause.parameters) {
      if (p.lower < p.upper) supposed.within[p.name] = {p.lower, p.upper};
    }
    return supposed;
  }
};

/// Each of `open` with each cause of the group.
std::vector<Weighed> Times(const std::vector<Weighed>& open, const diagnose::CauseGroup& group, const Finding& finding) {
  const std::vector<Cause>& causes = finding.found.diagnosis.causes;
  std::vector<Weighed> product;
  const double sum = Sum(causes, group);
  for (const Weighed& one : open) {
    for (const std::size_t k : group) {
      Weighed more = one;
      more.hypothesis.causes.push_back(finding.Suppose(causes[k]));
      more.probability *= causes[k].probability / sum;
      product.push_back(std::move(more));
    }
  }
  return product;
}

/// Nothing was found: each suspect alone beside nothing.
std::vector<Weighed> NothingOrSuspects(const Finding& finding) {
  constexpr double kWorthASuspicion = 0.01;
  std::vector<Weighed> open(1);
  open.front().probability = 1.0;
  for (const Cause& suspect : finding.found.suspects) {
    if (suspect.probability < kWorthASuspicion) continue;
    Weighed one;
    one.hypothesis.causes.push_back(finding.Suppose(suspect));
    one.probability = suspect.probability;
    open.front().probability -= suspect.probability;
    open.push_back(std::move(one));
  }
  return open;
}

double SumOf(const std::vector<Cause>& causes) {
  double sum = 0.0;
  for (const Cause& cause : causes) sum += cause.probability;
  return sum;
}

/// What was found has no name, or one of these that further runs may show the size of.
std::vector<Weighed> NothingOrUnsized(const Finding& finding) {
  const diagnose::DiagnosisRun& found = finding.found;
  std::vector<Weighed> open(1);
  open.front().probability = std::max(0.0, 1.0 - found.diagnosis.unknown.probability);
  for (const Cause& cause : found.unsized) {
    Weighed one;
    one.hypothesis.causes.push_back(finding.Suppose(cause));
    one.probability = cause.probability;
    open.push_back(std::move(one));
  }
  return open;
}

void KeepTheMostProbable(std::vector<Weighed>& open) {
  std::ranges::stable_sort(open, std::ranges::greater{}, &Weighed::probability);
  if (open.size() > kMost) open.resize(kMost);
  double sum = 0.0;
  for (const Weighed& one : open) sum += one.probability;
  for (Weighed& one : open) one.probability /= sum;
}

}  // namespace

double ThoughtOf(const EffectParameter& parameter, const EffectEntry& entry) {
  return parameter.name == kPhase ? units::kPi / std::sqrt(3.0) : entry.Plausible(parameter);
}

std::string Hypothesis::Name() const {
  if (causes.empty()) return IsNothing() ? "nothing" : kUnnamed;
  if (!causes.front().signal.empty()) return kUnnamed;
  std::string name;
  for (const Supposed& cause : causes) {
    name += (name.empty() ? "" : " + ") + cause.name;
    if (!cause.where.empty()) name += " " + cause.where;
    if (HappensOnce(cause) && cause.happened_in > 0) name += fmt::format(" in run {}", cause.happened_in + 1);
  }
  return name;
}

bool IsSame(const Hypothesis& a, const Hypothesis& b) {
  const auto has_all = [](const Hypothesis& all, const Hypothesis& of) {
    return std::ranges::all_of(of.causes, [&all](const Supposed& cause) {
      return std::ranges::any_of(all.causes,
                                 [&cause](const Supposed& other) { return IsSameCause(cause, other); });
    });
  };
  return has_all(a, b) && has_all(b, a) && a.besides.empty() == b.besides.empty();
}

Hypothesis Together(const Hypothesis& a, const Hypothesis& b) {
  Hypothesis both = a;
  for (const Supposed& cause : b.causes) {
    const bool is_there =
        std::ranges::any_of(both.causes, [&cause](const Supposed& other) { return IsSameCause(cause, other); });
    if (!is_there) both.causes.push_back(cause);
  }
  if (both.besides.empty()) both.besides = b.besides;
  return both;
}

diagnose::DiagnosisRun WithLessLikely(diagnose::DiagnosisRun found) {
  std::vector<Cause>& causes = found.diagnosis.causes;
  const auto find = [&causes](const std::string& effect, const std::string& where) {
    return std::ranges::find_if(causes, [&](const Cause& c) { return c.effect == effect && c.where == where; });
  };
  for (const Cause& cause : found.less_likely) {
    const diagnose::Rival& beside = cause.indistinguishable_from.front();
    const auto first = find(beside.effect, beside.where);
    if (first == causes.end() || find(cause.effect, cause.where) != causes.end()) continue;
    first->indistinguishable_from.push_back({cause.effect, cause.where});
    causes.push_back(cause);
  }
  found.less_likely.clear();
  return found;
}

double UnlistedBy(const diagnose::DiagnosisRun& found) {
  if (found.diagnosis.verdict == diagnose::Verdict::kNone) return 0.0;
  return std::clamp(found.diagnosis.unknown.probability, 0.0, 1.0) * (1.0 - SumOf(found.unsized));
}

std::vector<Weighed> LeftOpen(const diagnose::DiagnosisRun& found, const Scenario& scenario, int run) {
  const std::vector<Cause>& causes = found.diagnosis.causes;
  const Finding finding{found, scenario.bench, run};
  if (found.diagnosis.verdict == diagnose::Verdict::kNone) return NothingOrSuspects(finding);
  if (causes.empty() && !found.unsized.empty()) {
    std::vector<Weighed> open = NothingOrUnsized(finding);
    KeepTheMostProbable(open);
    return open;
  }
  std::vector<Weighed> open(1);
  open.front().probability = 1.0;
  open.front().hypothesis.besides = SignalsOf(found, scenario);
  for (const diagnose::CauseGroup& group : diagnose::GroupsOf(causes)) {
    if (Sum(causes, group) > 0.0) open = Times(open, group, finding);
  }
  KeepTheMostProbable(open);
  return open;
}

std::vector<Weighed> EachAlone(const diagnose::DiagnosisRun& found, const Scenario& scenario, int run) {
  const Finding finding{found, scenario.bench, run};
  std::vector<Weighed> each;
  for (const Cause& suspect : found.suspects) {
    each.push_back({{}, suspect.probability});
    each.back().hypothesis.causes.push_back(finding.Suppose(suspect));
  }
  return each;
}

Hypothesis Unnamed(const diagnose::DiagnosisRun& struck, const Scenario& scenario) {
  Hypothesis unnamed;
  if (struck.diagnosis.verdict != diagnose::Verdict::kUnknown) return unnamed;
  for (EffectSettings signal : SignalsOf(struck, scenario)) {
    FreeSizes(signal, scenario.bench);
    unnamed.causes.push_back({std::move(signal)});
  }
  return unnamed;
}

std::vector<std::string> EffectsIn(const std::vector<Weighed>& open) {
  std::vector<std::string> names;
  for (const Weighed& one : open) {
    for (const Supposed& cause : one.hypothesis.causes) {
      if (std::ranges::find(names, cause.name) == names.end()) names.push_back(cause.name);
    }
  }
  return names;
}

Scenario With(const Scenario& scenario, const Hypothesis& hypothesis, int run) {
  Scenario with = scenario;
  for (const Supposed& cause : hypothesis.causes) {
    const bool is_elsewhere = HappensOnce(cause) && run != cause.happened_in;
    if (is_elsewhere && run < cause.happened_in) continue;
    const EffectSettings& effect = cause;
    with.effects.push_back(is_elsewhere ? AsHappened(effect) : effect);
  }
  with.effects.insert(with.effects.end(), hypothesis.besides.begin(), hypothesis.besides.end());
  return with;
}

}  // namespace twinbench::investigate
