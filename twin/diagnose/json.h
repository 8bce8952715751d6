#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "twin/diagnose/diagnose.h"
#include "twin/diagnose/screen/screen.h"

namespace twinbench::diagnose {

/// diagnosis.json of formats.md. Parameters are in their own units, rms values in um (on a bench that reads angles
/// the
/// `_um` keys are null); besides, `_arcsec` gives them as angles: of a PSD bench as yaw of the grating. What is not
/// known is null. More than formats.md asks: log_evidence, rho and bounds of causes, `positive` and `folds` of the
/// gain, `noise`, `detectable`, `readings`, `left_out`, `notes`.
///
/// @param extended_scenario  Path of the file that was written; empty: none, null in the file.
nlohmann::json ToJson(const DiagnosisRun& run, const std::string& extended_scenario);

/// `diagnosis.screen` of results.json.
nlohmann::json ToJson(const std::vector<ResidualTest>& tests);

/// What the simulation gets wrong, for plots: `diagnosis.plots` of results.json.
///
/// `against`.VARIABLE.SERIES holds bins of a physical variable (time_s, target_deg, reference_deg in one turn,
/// direction, temperature_degC, dwell_s, velocity_deg_s, spot_um: of the channel itself) with the mean of what the
/// model leaves there before and after the accepted causes, and the standard uncertainty of a mean. Variables that
/// were not recorded or do not vary are left out. `maps`.SERIES has the same by set-up and position.
///
/// A series is a channel, or a pattern: the readings' projection on it, as it shows on its largest channel. Values
/// are in the run's unit, which is named; four digits.
nlohmann::json PlotsJson(const DiagnosisRun& run);

}  // namespace twinbench::diagnose
