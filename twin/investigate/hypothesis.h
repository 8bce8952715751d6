#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "twin/core/effect_catalogue.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/diagnose.h"

namespace twinbench::investigate {

/// What the parameter is called that says where a wave begins.
inline constexpr const char* kPhase = "phase";

/// A cause that may be at work. What happens once (HappensOnce) does so in one run: those before lack it, those after
/// are behind it.
struct Supposed : EffectSettings {
  int happened_in = 0;  // run, from 0 on
  /// Where the diagnosis that brought it up calls it so, by parameter [SI]: a creep that is slower than it looks for is a
  /// drift. Without: where the catalogue says.
  std::map<std::string, std::pair<double, double>> within = {};
};

/// One way in which the scenario may be wrong: all causes at work together. None: it is right.
struct Hypothesis {
  std::vector<Supposed> causes;         // by name, or signals instead of one, with what is known of their sizes
  std::vector<EffectSettings> besides;  // structure without a name that goes with every hypothesis of its run
  double log_prior = 0.0;

  /// "nothing", "psd_roll psd_a", "psd_roll psd_a + slip in run 2", "structure without a name".
  std::string Name() const;
  bool IsNothing() const { return causes.empty() && besides.empty(); }
  bool IsNamed() const { return !causes.empty() && causes.front().signal.empty(); }
};

/// The same causes at the same places.
bool IsSame(const Hypothesis& a, const Hypothesis& b);

/// The causes of both, each once.
Hypothesis Together(const Hypothesis& a, const Hypothesis& b);

/// How large a parameter is thought to be before any reading [SI]: as the catalogue has it. A phase is any.
double ThoughtOf(const EffectParameter& parameter, const EffectEntry& entry);

/// A hypothesis and what a diagnosis gives it, of all that is in the catalogue.
struct Weighed {
  Hypothesis hypothesis;
  double probability = 0.0;
};

/// The diagnosis with the causes that it found too unlikely to list, each among those that it cannot be told from: a
/// further run may find them likely.
diagnose::DiagnosisRun WithLessLikely(diagnose::DiagnosisRun found);

/// How probable the diagnosis finds it that something is there that no catalogue lists.
double UnlistedBy(const diagnose::DiagnosisRun& found);

/// What a diagnosis leaves open: of causes that it cannot tell apart one each, of causes that are at work together
/// all; the most probable dozen. A diagnosis that found nothing leaves "nothing".
/// @param run  Which of the investigation's was diagnosed, from 0 on.
std::vector<Weighed> LeftOpen(const diagnose::DiagnosisRun& found, const Scenario& scenario, int run = 0);

/// Every cause of the catalogue as the only one, with the sizes that these readings give it.
/// @param run  Which of the investigation's was diagnosed, from 0 on.
std::vector<Weighed> EachAlone(const diagnose::DiagnosisRun& found, const Scenario& scenario, int run);

/// What the diagnosis says of the same readings when every effect that it names is struck: the signals that it
/// would write instead, with sizes that are free. No causes if there are none that predict another run.
Hypothesis Unnamed(const diagnose::DiagnosisRun& struck, const Scenario& scenario);

/// Names of the effects in any of them.
std::vector<std::string> EffectsIn(const std::vector<Weighed>& open);

/// Scenario of a run with the hypothesis' causes in it.
/// @param run  Which of the investigation's, from 0 on; what happened once has happened in those that are to come.
Scenario With(const Scenario& scenario, const Hypothesis& hypothesis, int run = 0);

}  // namespace twinbench::investigate
