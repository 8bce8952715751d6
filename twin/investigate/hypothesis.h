#pragma once

#include <string>
#include <vector>

#include "twin/core/scenario.h"
#include "twin/diagnose/diagnose.h"

namespace twinbench::investigate {

/// One way in which the scenario may be wrong: all causes at work together. None: it is right.
struct Hypothesis {
  std::vector<EffectSettings> causes;   // by name, or signals instead of one, with what is known of their sizes
  std::vector<EffectSettings> besides;  // structure without a name that goes with every hypothesis of its run
  double log_prior = 0.0;
  std::size_t since = 0;  // the run that brought it up

  /// "nothing", "psd_roll psd_a", "psd_roll psd_a + slip", "structure without a name".
  std::string Name() const;
  bool IsNamed() const { return !causes.empty() && causes.front().signal.empty(); }
};

/// The same causes at the same places.
bool IsSame(const Hypothesis& a, const Hypothesis& b);

/// The causes of both, each once.
Hypothesis Together(const Hypothesis& a, const Hypothesis& b);

/// A hypothesis and what a diagnosis gives it, of all that is in the catalogue.
struct Weighed {
  Hypothesis hypothesis;
  double probability = 0.0;
};

/// What a diagnosis leaves open: of causes that it cannot tell apart one each, of causes that are at work together
/// all; the most probable dozen. A diagnosis that found nothing leaves "nothing".
std::vector<Weighed> LeftOpen(const diagnose::DiagnosisRun& found, const Scenario& scenario);

/// What the diagnosis says of the same readings when every effect that it names is struck: the signals that it
/// would write instead, with sizes that are free. No causes if there are none that predict another run.
Hypothesis Unnamed(const diagnose::DiagnosisRun& struck, const Scenario& scenario);

/// Names of the effects in any of them.
std::vector<std::string> EffectsIn(const std::vector<Weighed>& open);

/// Scenario with the hypothesis' causes in it.
Scenario With(const Scenario& scenario, const Hypothesis& hypothesis);

}  // namespace twinbench::investigate
