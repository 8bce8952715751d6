#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "twin/benches/encoder_comparison/estimators/scale_steps.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/core/reading.h"

namespace twinbench::benches::encoder {

/// The stops of an angle comparison evaluated as ISO 230-2 and VDI/DGQ 3441 do a rotary axis, for each set-up.
struct PositioningResults {
  nlohmann::json json;  // [{"setup", "axis": {"A": {"value_arcsec", "u_arcsec", "bias_arcsec"}, ...}, "targets",
                        // "u_parts", "missing", "notes"}]; empty without stops
  nlohmann::json vdi;   // [{"setup", "axis": {"P": {"value_arcsec", "u_arcsec", "bias_arcsec"}, ...}, "missing"}]
  std::string text;     // for a person; of many targets the values of the axis only
};

PositioningResults EvaluateStops(const std::vector<Reading>& readings, const DeviceSettings& device,
                                 const separate::encoder::ScaleSteps& steps);

}  // namespace twinbench::benches::encoder
