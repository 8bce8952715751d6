#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "twin/diagnose/engine/candidates.h"
#include "twin/diagnose/grouping.h"
#include "twin/diagnose/tuning.h"
#include "twin/model/follow.h"

/// Named candidates that need nothing but the catalogue and the twin: each effect's signature is what the twin
/// shows more with its [[effect]] block than without.
namespace twinbench::diagnose {

/// A record, the scenario that is believed of it, and what else is known to have entered.
struct BelievedRecord {
  model::FollowMaker follow;
  Scenario scenario;
  std::vector<Reading> record, used;     // those that a diagnosis uses, in the record's order
  std::vector<model::Disturbance> free;  // one value a used reading
  std::vector<double> onsets;            // numbers of readings at which something may begin
  int channels = 0;                      // so many of the twin's; 0: all
  Grouping groups = {};                  // of the used readings into rows
  double points = tuning::kAskedPoints;  // of a grid over all shapes of an effect
  bool alike_by_trace = false;           // sizes are thought of by the trace that they leave at any shape

  /// What each row should have shown: group i of used readings, channel c at i * channels + c, SI.
  Eigen::VectorXd Shown() const { return ShownUnder(scenario); }
  /// The same if the bench had this effect as well.
  Eigen::VectorXd ShownWith(const EffectSettings& effect) const;

 private:
  Eigen::VectorXd ShownUnder(const Scenario& believed) const;
};

/// One family for every place of every effect that the twin shows. The first parameter of an entry is its size;
/// further ones in which the twin's answer is linear and adds to the first's are sizes, too; all others become
/// shapes on a grid about the catalogue's plausible value. Beside a size alone, a "phase" makes a cosine and a sine of
/// it, and a "curvature" is the share of a second size, which makes a family with it and one without. What needs a finer grid than that (a frequency) is
/// better served by Candidates::AddTone and its like.
/// @return the effects of which this record shows nothing.
std::vector<Invisible> AddAskedEffects(const BelievedRecord& believed, const std::vector<EffectEntry>& entries,
                                       Candidates& named);

}  // namespace twinbench::diagnose
