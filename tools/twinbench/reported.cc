#include "tools/twinbench/reported.h"

#include <fmt/core.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/twinbench/doubts.h"
#include "tools/twinbench/light_pictures.h"
#include "tools/twinbench/run_folder.h"
#include "tools/twinbench/wrong_source.h"
#include "twin/campaign/campaign_page.h"
#include "twin/core/digest.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_file.h"
#include "twin/core/run_record.h"
#include "twin/report/page/diagnosis_page.h"
#include "twin/report/page/investigation_page.h"
#include "twin/report/page/plan_page.h"
#include "twin/report/page/run_page.h"

namespace twinbench::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExpected =
    "the folder of a run or an investigation, diagnosis.json, what plan --json has written, or a campaign's table";

report::PageSource SourceOf(const std::string& path, const std::vector<std::string>& files) {
  report::PageSource source;
  source.name = fs::weakly_canonical(path).filename().string();
  source.program_version = TWINBENCH_VERSION;
  for (const std::string& file : files) {
    if (fs::exists(file)) source.digests.emplace_back(fs::path(file).filename().string(), Sha256(BytesOfFile(file)));
  }
  return source;
}

/// The score of a run, where `score --json` has left it or the user says it is.
nlohmann::json ScoreOf(const RunFolder& folder, const std::string& named) {
  const std::string path = named.empty() ? folder.score() : named;
  if (!named.empty() || fs::exists(path)) return ReadJson(path);
  if (fs::exists(folder.truth()))
    fmt::print(stderr, "the run has not been scored: the page shows no truth (twinbench score {} leaves it there)\n", folder.path);
  return {};
}

/// results.json, and what `separate --json` has left beside it where that says more.
nlohmann::json ResultsOf(const RunFolder& folder) {
  nlohmann::json results = ReadJson(folder.results());
  const std::string separation = folder.path + "/separation.json";
  if (!results.contains("separation") && fs::exists(separation)) results["separation"] = ReadJson(separation);
  return results;
}

report::Page OfRun(const RunFolder& folder, const std::string& score) {
  report::PageSource source = SourceOf(folder.path, {folder.scenario(), folder.record(), folder.results()});
  const auto record = RunRecord::Open(folder.path);
  const Scenario scenario = LoadScenario(folder.scenario());
  source.title = scenario.title;
  TellDoubts(record->Readings(), scenario, folder.path, stderr);
  source.provenance = record->provenance();
  return report::RunPage(source, ResultsOf(folder), ScoreOf(folder, score), record->Readings(), LightPictures(folder.images()));
}

report::Page OfDiagnosis(const report::PageSource& source, const nlohmann::json& diagnosis) {
  const report::PageVerdict verdict = report::VerdictOf(diagnosis);
  report::Page page{source.name, "diagnosis", verdict.text, verdict.tone, report::DiagnosisSections(diagnosis)};
  page.sections.push_back(report::ProvenanceSection(source));
  return page;
}

std::string InvestigationOf(const std::string& source) {
  return source + "/investigation.json";
}

report::Page OfInvestigation(const std::string& folder, const std::string& output) {
  std::vector<std::string> links;
  for (const std::string& run : RunsOfInvestigation(folder)) {
    const std::string page = UsualPagePath(run);
    links.push_back(output != "-" && fs::exists(page) ? fs::proximate(page, fs::absolute(output).parent_path()).string() : "");
  }
  return report::InvestigationPage(SourceOf(folder, {InvestigationOf(folder)}), ReadJson(InvestigationOf(folder)), links);
}

report::Page OfJson(const std::string& path) {
  const nlohmann::json json = ReadJson(path);
  const report::PageSource source = SourceOf(path, {path});
  if (json.contains("verdict")) return OfDiagnosis(source, json);
  if (json.contains("runs") && json.contains("advice")) return report::PlanPage(source, json);
  if (json.contains("steps")) return report::InvestigationPage(source, json);
  throw InputError(path, "there is nothing in it that a page is made of", kExpected);
}

report::Page OfCampaign(const std::string& path) {
  const campaign::Table table = campaign::Table::Open(path);
  report::PageSource source = SourceOf(path, {path});
  source.provenance.bench = table.Made("bench");
  source.provenance.program_version = table.Made("version");
  const campaign::Summary summary = campaign::SummaryOf(table);
  report::Page page{source.name, "campaign on " + source.provenance.bench, "", report::VerdictTone::kPlain, campaign::CampaignSections(table, summary)};
  if (report::PageTile coverage = campaign::CoverageTile(summary); !coverage.value.empty()) page.tiles.push_back(std::move(coverage));
  if (const std::string study = table.Made("study"); !study.empty())
    page.sections.push_back({"Study", "", {report::PageText{"The study file", study}}});
  page.sections.push_back(report::ProvenanceSection(source));
  return page;
}

report::Page PageOfWhatIsThere(const std::string& source, const std::string& score, const std::string& output) {
  const RunFolder folder{source};
  if (fs::exists(InvestigationOf(source))) return OfInvestigation(source, output);
  if (fs::exists(folder.results())) return OfRun(folder, score);
  if (!fs::exists(source)) throw NothingToRead(source, kExpected);
  if (fs::is_directory(source)) {
    RequireRunFolder(source);
    throw InputError(source, "there is no results.json: the run was interrupted, or never evaluated", "a whole run: `twinbench measure ... --resume` goes on with it, `twinbench separate` evaluates what is there");
  }
  if (source.ends_with(".toml") || source.ends_with(".csv")) throw NoRun(source);
  return source.ends_with(".json") ? OfJson(source) : OfCampaign(source);
}

}  // namespace

report::Page PageOf(const std::string& source, const std::string& score, const std::string& output) {
  try {
    return PageOfWhatIsThere(source, score, output);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(source, std::string("a result in it is not as it is written: ") + error.what(), kExpected);
  }
}

std::vector<std::string> RunsOfInvestigation(const std::string& source) {
  std::vector<std::string> runs;
  if (!fs::exists(InvestigationOf(source))) return runs;
  for (const nlohmann::json& step : ReadJson(InvestigationOf(source)).value("steps", nlohmann::json::array()))
    if (step.contains("folder")) runs.push_back((fs::path(source) / fs::path(step.at("folder").get<std::string>()).filename()).string());
  return runs;
}

std::string UsualPagePath(const std::string& source) {
  if (fs::is_directory(source)) return source + "/report.html";
  return fs::path(source).replace_extension(".html").string();
}

}  // namespace twinbench::tools
