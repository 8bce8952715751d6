#pragma once

#include <nlohmann/json_fwd.hpp>

#include "twin/core/scenario.h"

namespace twinbench::sim {

/// What the twin knows and the measurement may not: opened only by `twinbench score` and tests.
struct Truth {
  TableErrors target;     // repeatable errors at the stops, in L
  TableErrors reference;  // the same in its rotor frame, at its own angles
  std::vector<EffectSettings> effects;
  std::uint64_t seed = 0;
};

/// {"position_deg": [...], "ex_arcsec": [...], ..., "dz_um": [...]}
nlohmann::json ToJson(const TableErrors& errors);

/// {"effect": name, "where": place, "parameters_SI": {...}}
nlohmann::json ToJson(const EffectSettings& effect);
nlohmann::json ToJson(const std::vector<EffectSettings>& effects);

/// {"target": {"position_deg": [...], "ex_arcsec": [...], ...}, "reference": {...}, "effects": [...], "seed": n}
nlohmann::json ToJson(const Truth& truth);

}  // namespace twinbench::sim
