#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "twin/report/page/figure.h"

/// What pages of diagnoses, plans and investigations say alike of causes.
namespace twinbench::report {

/// A list of an object; empty if it has none of that name.
nlohmann::json ListAt(const nlohmann::json& object, const std::string& key);

/// "psd_roll at psd_b".
std::string NameOfCause(const nlohmann::json& cause);

/// `detectable` and `invisible` of diagnosis.json and of a plan.
PageTable DetectableTable(const nlohmann::json& seen);
PageTable InvisibleTable(const nlohmann::json& seen);

/// A table without rows is not shown.
void AddFilled(PageTable table, PageSection& section);

}  // namespace twinbench::report
