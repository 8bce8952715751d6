#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/uncertainty/quantities.h"

namespace twinbench::plan {

/// Results of one kind: "separation.target.ez_arcsec", at all positions.
struct Certainty {
  std::string name;
  std::size_t values = 0;
  double rms_u = 0.0, worst_u = 0.0;
};

/// What a run would give.
struct Outlook {
  int readings = 0;
  double minutes = 0.0;  // by the procedure's own clock
  double dof = 0.0;      // that are left when all is fitted; NaN if the bench does not say
  std::vector<Certainty> results;
  std::vector<std::string> not_separable;  // in words
};

/// From the results of a run of the twin, which has the noise that the scenario states.
/// @param last_s  Time of its last reading.
Outlook OutlookOf(const nlohmann::json& results, int readings, double last_s);

}  // namespace twinbench::plan
