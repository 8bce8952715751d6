#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "twin/core/reading.h"
#include "twin/report/page/figure.h"

/// What pages of diagnoses, plans and investigations say alike of causes.
namespace twinbench::report {

/// A list of an object; empty if it has none of that name.
nlohmann::json ListAt(const nlohmann::json& object, const std::string& key);

/// "psd_roll at psd_b".
std::string NameOfCause(const nlohmann::json& cause);

/// A cause, or several that this run does not tell apart.
struct CauseGroup {
  std::string name, size, next;  // "a or b"; "roll 8.26 ± 0.22 mrad"; the measurement that would tell more
  double probability = 0.0;
  double share = kNaN;           // of the variance beyond noise; NaN: not stated
};

/// Those of a diagnosis, by what they explain.
std::vector<CauseGroup> GroupsOf(const nlohmann::json& diagnosis);

/// 0.123 as "12.3 %"; NaN as nothing.
std::string Percent(double share);

/// `detectable` and `invisible` of diagnosis.json and of a plan.
PageTable DetectableTable(const nlohmann::json& seen);
PageTable InvisibleTable(const nlohmann::json& seen);

/// A table without rows is not shown.
void AddFilled(PageTable table, PageSection& section);

}  // namespace twinbench::report
