#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/benches/encoder_comparison/axis_unit.h"
#include "twin/report/curve_score.h"
#include "twin/report/evaluation.h"
#include "twin/separate/series.h"

/// A curve of angle errors as files and persons get it.
namespace twinbench::benches::encoder {

inline constexpr int kCurvePoints = 360;  // a degree

/// {"position_deg", name + "_arcsec", "u_" + name + "_arcsec"} at every degree.
nlohmann::json CurveJson(const separate::harmonics::HarmonicSeries& series, const std::string& name);

/// What orders above the highest may make of it; empty: nothing.
std::string UnresolvedText(const separate::harmonics::HarmonicSeries& series, const AxisUnit& unit);

/// A calibration without a standard as results.json has it: what separation.json says, with notes beside it.
void AddCalibration(nlohmann::json separation, const std::vector<std::string>& notes, report::Evaluation& evaluation);

/// Amplitude and phase of every order that is known, with their uncertainties.
nlohmann::json HarmonicsJson(const separate::harmonics::HarmonicSeries& series);

/// A row for each order that stands out of the noise.
std::string LinesText(const char* what, const separate::harmonics::HarmonicSeries& series, const AxisUnit& unit);

/// A row for each of the six largest of them, and how many more there are.
std::string LargestText(const char* what, const separate::harmonics::HarmonicSeries& series, const AxisUnit& unit);

/// At the positions of the truth, `truth` of which has them and what was true there.
report::CurveScore ScoreOf(const std::string& name, const separate::harmonics::HarmonicSeries& series,
                           const nlohmann::json& truth);

}  // namespace twinbench::benches::encoder
