#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "twin/benches/turntable_autocollimator/estimators/harmonic_model.h"
#include "twin/report/curve_score.h"

/// Curves of the turntable bench in results.json, and against the truth.
namespace twinbench::benches::turntable {

nlohmann::json ToJson(const separate::turntable::AngleSeries& series);
nlohmann::json ToJson(const separate::turntable::HarmonicModel& model);

/// True ez at angles that the truth lists, its mean over them taken out [arcsec].
std::vector<double> TruthAt(const nlohmann::json& table, const std::vector<double>& position_rad);

report::CurveScore CurveOf(const std::string& name, const separate::turntable::AngleSeries& series,
                           const nlohmann::json& table);

/// The teeth as the shifts see them: of each row of teeth, which stand at even positions, its mean and these orders are
/// taken out of the true curve.
void TakeOutLost(const std::vector<int>& orders, int positions, report::CurveScore& curve);

}  // namespace twinbench::benches::turntable
