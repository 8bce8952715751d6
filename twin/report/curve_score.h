#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "twin/report/evaluation.h"

namespace twinbench::report {

/// An estimated curve against its true one, in the unit of the file.
struct CurveScore {
  std::string name;   // "turntable", "multitooth"
  std::string value;  // "ez_arcsec"
  std::string position_name = "position_deg";
  std::vector<double> position, estimate, u, truth;  // equally long; u may be NaN
  double dof = std::numeric_limits<double>::infinity();  // behind u
};

/// A row a curve: root mean squares, the worst error, the stated uncertainty and the mean of (error / u)^2.
std::string ScoreTable(const std::vector<CurveScore>& curves);
/// A row a position: estimate, uncertainty and truth.
std::string PositionTable(const std::vector<CurveScore>& curves);
/// {"turntable": {"ez": {"positions": n, "rms_error_arcsec": ..., ...}}}
nlohmann::json ToJson(const std::vector<CurveScore>& curves);
/// Every point of every curve: "turntable.ez_arcsec[3]".
std::vector<ScoredValue> ValuesOf(const std::vector<CurveScore>& curves);

}  // namespace twinbench::report
