#pragma once

#include <nlohmann/json_fwd.hpp>

#include "twin/benches/encoder_comparison/estimators/device_error.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/uncertainty/joint.h"

namespace twinbench::benches::encoder {

/// `u_parts` of a curve at 0, 360 / points, ... deg: white noise of the readings, of it what the least step of the
/// device's reading makes (LSB^2 / 12), and what scatters between turns and passes beyond that.
nlohmann::json CurveParts(const separate::harmonics::HarmonicSeries& series,
                          const separate::encoder::DeviceError& device, const DeviceSettings& settings, int points);

/// The same of order k's coefficient.
nlohmann::json OrderParts(int order, const separate::encoder::DeviceError& device, const DeviceSettings& settings);

/// The curve's values together: `name`.ez_arcsec[i]. Orders are independent of each other.
uncertainty::Joint CurveJoint(const std::string& name, const separate::harmonics::HarmonicSeries& series, int points);

}  // namespace twinbench::benches::encoder
