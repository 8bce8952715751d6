#include "tests/hidden/score_table.h"

#include "tests/hidden/score_sections.h"

namespace twinbench::hidden {

std::string ScoreTable(const std::vector<Outcome>& outcomes) {
  Outcomes all;
  for (const Outcome& o : outcomes) all.push_back(&o);
  return SetSection(all) + EffectSection(all) + RhoSection(all) + UnlistedSection(all) + AlarmSection(all) +
         LeaveOneOutSection(all) + CalibrationSection(all) + SizeSection(all) + GainSection(all) +
         TimeSection(all) + FailureSection(all);
}

}  // namespace twinbench::hidden
