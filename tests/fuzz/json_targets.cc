#include <nlohmann/json.hpp>

#include "tests/fuzz/file_of_bytes.h"
#include "tests/fuzz/target.h"
#include "twin/core/errors.h"
#include "twin/report/certificate/laboratory.h"
#include "twin/report/page/diagnosis_page.h"
#include "twin/report/page/investigation_page.h"
#include "twin/report/page/modest_json.h"
#include "twin/report/page/page_json.h"
#include "twin/report/page/plan_page.h"
#include "twin/report/page/run_page.h"

/// What other commands, versions or people have written as JSON for a page, and the laboratory's words for a certificate.
namespace twinbench::fuzz {
namespace {

/// Whoever reads the file answers for exceptions of the JSON library with the file's name (PageOf in tools).
template <class Show>
void ShowPage(std::string_view bytes, Show show) {
  try {
    RefusingIsRight([&] { report::PageJson(show(report::ParseModestJson(std::string(bytes), "fuzz"))); });
  } catch (const nlohmann::json::exception&) {
  }
}

report::PageSource Source() {
  report::PageSource source;
  source.name = "fuzz";
  return source;
}

void PageOfDiagnosis(std::string_view bytes) {
  ShowPage(bytes, [](const nlohmann::json& diagnosis) {
    return report::Page{"fuzz", "diagnosis", report::VerdictOf(diagnosis).text, {}, report::DiagnosisSections(diagnosis)};
  });
}

void PageOfResults(std::string_view bytes) {
  ShowPage(bytes, [](const nlohmann::json& results) { return report::RunPage(Source(), results, {}); });
}

void PageOfPlan(std::string_view bytes) {
  ShowPage(bytes, [](const nlohmann::json& plan) { return report::PlanPage(Source(), plan); });
}

void PageOfInvestigation(std::string_view bytes) {
  ShowPage(bytes, [](const nlohmann::json& found) { return report::InvestigationPage(Source(), found); });
}

void ReadLaboratoryFile(std::string_view bytes) {
  RefusingIsRight([&] { certificate::ReadLaboratory(std::string(bytes), "fuzz"); });
}

constexpr Target kJsonTargets[] = {
    {"page_of_diagnosis", PageOfDiagnosis, ""}, {"page_of_results", PageOfResults, ""},
    {"page_of_plan", PageOfPlan, ""},           {"page_of_investigation", PageOfInvestigation, ""},
    {"laboratory", ReadLaboratoryFile, ""},
};

}  // namespace

std::span<const Target> JsonTargets() {
  return kJsonTargets;
}

}  // namespace twinbench::fuzz
