#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/benches/rotary_4dof/procedure/procedure.h"
#include "twin/core/scenario.h"

namespace twinbench::tools {

/// What a run will ask of the bench, found by carrying it out on the twin first.
struct Rehearsal {
  struct Travel {
    double lowest_rad = 0.0, highest_rad = 0.0;
  };
  Travel target, reference;
  int readings = 0;
  int not_ok = 0;  // readings without numbers
  int hide_lost_words = 0;      // readings in whose blocks a word that the card loses might not be seen
  double lost_word_shift_V = 0.0;  // of a mean, at most, by one that is lost half-way through such a block
  double duration_s = 0.0;
  double widest_share[2] = {};  // of half the active width, the spot that came nearest to the edge of PSD a and b
  std::vector<std::string> hints, problems;
};

/// @param limits   Soft limits of the real tables; a command beyond them is a problem, not an exception.
/// @param is_real  Steps that prove the readings of a real bench take their time.
Rehearsal Rehearse(const Scenario& scenario, const procedure::Options& limits, double mains_Hz, bool is_real);

/// A table for people, one problem a line at its end.
std::string Summary(const Rehearsal& rehearsal, const procedure::Options& limits);

/// The same for programs: {"rehearsal": {"readings", "without_numbers", "duration_s", "travel_deg", "hints", "problems"}}.
nlohmann::json RehearsalJson(const Rehearsal& rehearsal);

}  // namespace twinbench::tools
