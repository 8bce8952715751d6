#pragma once

#include <string>
#include <vector>

#include "twin/diagnose/encoder/family_parts.h"
#include "twin/diagnose/engine/catalogue_parts.h"

/// Building blocks of families that are named after an effect of the catalogue.
namespace twinbench::diagnose::encoder {

/// An amplitude with unit and bounds of the catalogue; its prior is set later.
Amplitude AmplitudeOf(const std::string& effect, const std::string& parameter);

Shape ShapeOf(const std::string& effect, const std::string& parameter, std::vector<double> values_SI);

/// A parameter of the catalogue as fitted [SI].
ParameterEstimate Estimate(const std::string& effect, const std::string& parameter, double value, double u);

/// Without amplitudes and columns.
Family Named(const std::string& effect);

/// A family without a shape.
Family Linear(const std::string& effect, const std::vector<std::string>& parameters,
              const Eigen::MatrixXd& columns);

/// Reports the first amplitude and the first shape (if named), which are the catalogue's; the others are not.
Parameters ReportOnly(const std::string& effect, const std::string& amplitude, const std::string& shape_name = "");

// Families of one kind of cause each; `families` grows.
void AddPeriodic(const SignalContext& context, std::vector<Family>& families);
void AddSignals(const Context& context, double plausible_rad, std::vector<Family>& families);
void AddMotion(const Context& context, double plausible_rad, std::vector<Family>& families);
void AddTime(const Context& context, std::vector<Family>& families);

}  // namespace twinbench::diagnose::encoder
