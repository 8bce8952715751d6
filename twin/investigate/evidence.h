#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "twin/investigate/joint_fit.h"

namespace twinbench::investigate {

/// What a hypothesis made of the runs that a diagnosis weighed it by. Its prior is that weight over this evidence, so
/// it must be the best that the hypothesis has to say of them.
struct WeighedBy {
  std::size_t runs = 0;  // the first ones; 0: its prior was not drawn from readings
  double chi2 = 0.0, log_evidence = 0.0;
};

/// A hypothesis that is still open, with its share of what is believed.
struct Open {
  JointFit fit;
  WeighedBy by = {};
  double probability = 0.0;  // of all, what the catalogue lacks included
};

/// What is believed after some runs.
struct Belief {
  std::vector<Open> open;  // most probable first
  double unlisted = 0.0;   // something that the catalogue has no name for

  const Open& Best() const { return open.front(); }
  std::vector<double> Probabilities() const;  // what the catalogue lacks comes last
};

/// After a diagnosis of the first of the runs: exactly what it said. Most of what the catalogue lacks is a hypothesis too,
/// where the readings can be written as signals without a name: they predict what other runs would show.
Belief Begun(const diagnose::DiagnosisRun& found, const std::vector<TakenRun>& runs, const Means& means);

/// After another run: everything fitted again to all of them.
void Update(Belief& belief, const std::vector<TakenRun>& runs, const Means& means);

/// Takes in what the diagnosis of a later run brought up, at the odds that a cause of the catalogue has before any
/// reading for each that it has more than `beside` it. Beside each other they weigh as that diagnosis says: rivals that
/// no reading tells apart stay so. One that is there already is fitted from its new sizes too. @return false if nothing
/// of it is new.
bool TakeIn(Belief& belief, const std::vector<Weighed>& found, const std::vector<TakenRun>& runs, const Means& means,
            const std::function<Hypothesis(const Hypothesis&)>& beside);

/// What the catalogue lacks and looked like the best hypothesis so far shows in a run of another kind in another size:
/// as large on average, give or take as much (as OfCauses_bit expects). @return the likelihood of the run's readings
/// under that over the one under the best: with s = S' W S of its signature S and r = S' W e of what it leaves,
/// exp(r^2 / 2 (1 + s)) / sqrt(1 + s). A run in which it would not be seen says nothing: 1.
double MimicFactor(const Hypothesis& best, const TakenRun& run, const Means& means);

/// A run of another kind than those before agreed with the best hypothesis, or something was left that nothing open
/// explains.
void Agreed(Belief& belief, const TakenRun& run, const Means& means);
void Disagreed(Belief& belief, double unknown);

/// The best hypothesis came up in fits of all runs together, before any diagnosis named it: of what looks exactly like
/// it, the share that no diagnosis would call it either (tuning::kListed) is what the catalogue lacks.
void NamedByFits(Belief& belief);

/// What diagnoses say of overtones (DiagnosisRun::overtones), by how the diagnosed runs were asked to differ from the
/// scenario's own; 0: no wave was found.
using Overtones = std::map<std::vector<std::string>, double>;

/// Probability that a named wave repeats and is no sine, all plans together: one that does not show its overtones - free
/// unknowns take them up, or there is no wave to be seen - leaves it as it was.
double ProbabilityOfNoSine(const Overtones& overtones);

}  // namespace twinbench::investigate
