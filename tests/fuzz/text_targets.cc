#include <nlohmann/json.hpp>

#include "hw_bridge/bench_file.h"
#include "hw_bridge/control/address.h"
#include "hw_bridge/control/described_devices.h"
#include "hw_bridge/control/scpi.h"
#include "hw_bridge/control/scpi_table.h"
#include "hw_bridge/machine_file.h"
#include "hw_bridge/program/program_file.h"
#include "tests/fuzz/target.h"
#include "twin/core/compensation_table.h"
#include "twin/core/scenario.h"
#include "twin/core/table_errors.h"
#include "twin/import/import.h"
#include "twin/report/certificate/laboratory.h"
#include "twin/report/page/diagnosis_page.h"
#include "twin/report/page/investigation_page.h"
#include "twin/report/page/modest_json.h"
#include "twin/report/page/page_json.h"
#include "twin/report/page/plan_page.h"
#include "twin/report/page/run_page.h"

/// What people and other programs write as text; JSON, too, that commands or other versions have written for a page.
namespace twinbench::fuzz {
namespace {

constexpr const char* kName = "fuzz";
constexpr std::string_view kMapEnd = "---\n";  // a map, and the recording that it is of

/// A scenario that is taken must come back from its own text.
void ReadScenario(std::string_view bytes) {
  Scenario scenario;
  try {
    scenario = ParseScenario(std::string(bytes), kName, "/nowhere");
  } catch (const InputError&) {
    return;
  }
  const std::string text = WriteScenario(scenario);
  try {
    Require(WriteScenario(ParseScenario(text, "written", "/nowhere")) == text, "a scenario does not come back as it was");
  } catch (const InputError& error) {
    throw std::logic_error(std::string("what WriteScenario wrote is refused: ") + error.what());
  }
}

/// The first line is one --set, the rest the scenario.
void ReadOverride(std::string_view bytes) {
  const auto end = bytes.find('\n');
  if (end == bytes.npos) return;
  RefusingIsRight([&] {
    ParseScenario(std::string(bytes.substr(end + 1)), kName, "/nowhere", {std::string(bytes.substr(0, end))});
  });
}

void ReadReadings(std::string_view bytes) {
  std::istringstream in{std::string(bytes)};
  RefusingIsRight([&] { ParseReadingsCsv(in, kName); });
}

/// A map and a recording, or a recording alone.
void ReadRecording(std::string_view bytes) {
  const auto split = bytes.find(kMapEnd);
  const bool has_map = split != bytes.npos;
  const FileOfBytes file(has_map ? bytes.substr(split + kMapEnd.size()) : bytes);
  imports::Map map;
  try {
    if (has_map) map = imports::ParseMap(std::string(bytes.substr(0, split)), kName);
  } catch (const InputError&) {
    return;
  }
  RefusingIsRight([&] { imports::Look({file.Path()}, map); });
  RefusingIsRight([&] { imports::Import({file.Path()}, map); });
}

void ReadErrorsMap(std::string_view bytes) {
  const FileOfBytes file(bytes);
  RefusingIsRight([&] { ReadTableErrors(file.Path()); });
  RefusingIsRight([&] { ReadCompensationTable(file.Path()); });
}

void ReadProgramFile(std::string_view bytes) {
  const FileOfBytes file(bytes);
  RefusingIsRight([&] {
    if (hw::IsProgramFile(file.Path())) hw::LoadProgramFile(file.Path());
  });
}

void ReadMachineFile(std::string_view bytes) {
  RefusingIsRight([&] { hw::ParseMachineFile(std::string(bytes), kName, {{"x", false}, {"y", false}, {"a", true}}); });
}

/// A line that a device answered, as every dialogue takes it.
void ReadAnswer(std::string_view bytes) {
  const std::string answer(bytes);
  hw::ParseScpiState(answer);
  hw::SplitScpi(answer);
  for (const char* separator : {" ", ";", "\r\n"}) hw::SplitAnswer(answer, separator);
  hw::ParseScpiNumber(answer, 1.0);
  hw::ParseAddress(answer);
}

/// Whoever reads the file answers for exceptions of the JSON library with the file's name (PageOf in tools).
template <class Show>
void ShowPage(std::string_view bytes, Show show) {
  try {
    RefusingIsRight([&] { report::PageJson(show(report::ParseModestJson(std::string(bytes), kName))); });
  } catch (const nlohmann::json::exception&) {
  }
}

report::PageSource Source() {
  report::PageSource source;
  source.name = "fuzz";
  return source;
}

report::Page PageOfDiagnosis(const nlohmann::json& diagnosis) {
  return {kName, "diagnosis", report::VerdictOf(diagnosis).text, {}, report::DiagnosisSections(diagnosis)};
}

using Bytes = std::string_view;
using Json = const nlohmann::json&;

constexpr Target kTextTargets[] = {
    {"scenario", ReadScenario, "scenarios"},
    {"override", ReadOverride, ""},
    {"readings", ReadReadings, ""},
    {"recording", ReadRecording, ""},
    {"errors_map", ReadErrorsMap, ""},
    {"bench_file",
     [](Bytes b) { RefusingIsRight([&] { hw::ParseBenchFile(std::string(b), kName, "/nowhere"); }); }, ""},
    {"machine_file", ReadMachineFile, ""},
    {"dialogue",
     [](Bytes b) { RefusingIsRight([&] { hw::ParseDialogue(std::string(b), kName); }); }, "hw_bridge/dialogues"},
    {"program_file", ReadProgramFile, ""},
    {"answer", ReadAnswer, ""},
    {"page_of_diagnosis", [](Bytes b) { ShowPage(b, PageOfDiagnosis); }, ""},
    {"page_of_results",
     [](Bytes b) { ShowPage(b, [](Json results) { return report::RunPage(Source(), results, {}); }); }, ""},
    {"page_of_plan", [](Bytes b) { ShowPage(b, [](Json plan) { return report::PlanPage(Source(), plan); }); }, ""},
    {"page_of_investigation",
     [](Bytes b) { ShowPage(b, [](Json found) { return report::InvestigationPage(Source(), found); }); }, ""},
    {"laboratory", [](Bytes b) { RefusingIsRight([&] { certificate::ReadLaboratory(std::string(b), kName); }); }, ""},
};

}  // namespace

std::span<const Target> TextTargets() {
  return kTextTargets;
}

}  // namespace twinbench::fuzz
