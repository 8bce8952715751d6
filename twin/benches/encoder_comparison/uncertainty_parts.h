#pragma once

#include <nlohmann/json_fwd.hpp>

#include "twin/benches/encoder_comparison/estimators/device_error.h"
#include "twin/benches/encoder_comparison/settings.h"
#include "twin/uncertainty/joint.h"

namespace twinbench::benches::encoder {

/// The steps of what is read.
separate::encoder::ScaleSteps StepsOf(const EncoderSettings& settings);

/// What an evaluation of the device knows of it: its steps, orders of its lines, teeth and signals with their
/// doubles.
separate::encoder::DeviceOptions DeviceOptionsOf(const EncoderSettings& settings);

/// `u_parts` of a curve at 0, 360 / points, ... deg: white noise of the readings, of it what the least step of the
/// device's reading makes (LSB^2 / 12), and what scatters between turns and passes beyond that.
nlohmann::json CurveParts(const separate::harmonics::HarmonicSeries& series,
                          const separate::encoder::DeviceError& device, const DeviceSettings& settings, int points);

/// The same of order k's coefficient.
nlohmann::json OrderParts(int order, const separate::encoder::DeviceError& device, const DeviceSettings& settings);

/// The same of the mean of forward - backward.
nlohmann::json ReversalParts(const separate::encoder::DeviceError& device, const DeviceSettings& settings);

/// The same of means by angle, alike for all of them: a few readings do not tell each for itself. What they scatter by, pooled, beyond white noise is
/// repeatability.
nlohmann::json MeansParts(const separate::encoder::AngleMeans& means, const separate::encoder::DeviceError& device,
                          const DeviceSettings& settings);

/// Of a curve that white noise of the readings (of it steps, this share) and what published equations are wrong by make uncertain.
/// @param by_noise  The curve without the latter.
nlohmann::json PublishedCurveParts(const separate::harmonics::HarmonicSeries& series,
                                   const separate::harmonics::HarmonicSeries& by_noise, double of_steps, int points);
/// The same of a spectrum (HarmonicsJson): adds `u_parts` to every line of it.
void AddPublishedOrderParts(const separate::harmonics::HarmonicSeries& series,
                            const separate::harmonics::HarmonicSeries& by_noise, double of_steps, nlohmann::json& lines);

/// Share that steps have of white noise of this size: LSB^2 / 12.
double StepShare(double reading_rad, const DeviceSettings& settings);

/// The curve's values together: `name`.ez_arcsec[i]. Orders are independent of each other.
uncertainty::Joint CurveJoint(const std::string& name, const separate::harmonics::HarmonicSeries& series, int points);

}  // namespace twinbench::benches::encoder
