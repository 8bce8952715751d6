#include "tests/scores/sets.h"

namespace twinbench::scores {

const std::vector<Set>& Sets() {
  static const std::vector<Set> sets = {
      {"hidden", "every effect at every place, by the twin; pairs; mounts that creep", HiddenSet},
      {"challenge", "cases of independent generators, tests/data/challenge*", ChallengeSet},
      {"foreign", "machines that share nothing with the program: causes without a name, several at once",
       ForeignSet},
      {"two_runs", "a first run is diagnosed, its written file predicts another day's run of the same machine",
       TwoRunsSet},
      {"own_scenario", "a run of the twin with its own scenario, key by key and effect by effect: silence is right",
       OwnScenarioSet},
      {"investigate", "one hidden cause, with as many runs as it takes", InvestigateSet},
      {"clean", "nothing wrong, the noise odd: silence is right", CleanSet},
      {"unlisted", "causes that the catalogue lacks, and effects struck from it", UnlistedSet},
      {"shelf", "recordings as people have them, imported by a plain guess: tests/data/shelf", ShelfSet}};
  return sets;
}

}  // namespace twinbench::scores
