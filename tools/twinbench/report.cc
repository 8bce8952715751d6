#include <fmt/core.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/twinbench/answers.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/evaluated_run.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/reported.h"
#include "tools/twinbench/overwriting.h"
#include "tools/twinbench/run_folder.h"
#include "tools/web/bundle.h"
#include "twin/core/errors.h"
#include "twin/core/run_record.h"
#include "twin/core/scenario.h"
#include "twin/report/page/page_json.h"
#include "twin/report/page/svg.h"

namespace twinbench::tools {
namespace {

/// Within the first lines of every page of ours: one takes the place of another.
constexpr std::string_view kOwnPage = "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'sha256-";

struct ReportOptions {
  std::string source, score, output, pictures;
  bool force = false;
};

/// One file a picture, into a folder that is made if it is not there.
/// @return their names.
std::vector<std::string> WritePictures(const report::Page& page, const std::string& folder) {
  std::vector<report::ResultTable> files;
  for (const auto& [name, svg] : report::SvgPictures(page)) files.push_back({name, svg});
  if (files.empty()) throw InputError(folder, "the page has no plots", "a page with plots");
  WriteTables(folder, files);
  fmt::print("{}: {} pictures\n", folder, files.size());
  std::vector<std::string> names;
  for (const report::ResultTable& file : files) names.push_back(file.file);
  return names;
}

/// Where the page goes.
std::string OutputOf(const ReportOptions& options) {
  return options.output.empty() ? UsualPagePath(options.source) : options.output;
}

void RequirePages() {
  if (web::PageMarkup().empty())
    throw InputError("report", "this program was built without pages",
                     "--svg DIR, or a program that was built where npm is installed, without -DTWINBENCH_REPORT=OFF");
}

/// The page, once it is known to have a place.
std::string HtmlFor(const report::Page& page, const ReportOptions& options) {
  RequireFree(OutputOf(options), {options.source, options.score, RunFolder{options.source}.results()}, options.force, kOwnPage);
  return report::PageHtml(page, web::PageMarkup());
}

void WritePage(const report::Page& page, const ReportOptions& options) {
  const std::string output = OutputOf(options), html = HtmlFor(page, options);
  if (output == "-") {
    fmt::print("{}", html);
  } else {
    WriteFileAtOnce(output, html);
    fmt::print("{} ({:.1f} MB): open it with a browser\n", output, 1e-6 * static_cast<double>(html.size()));
  }
}

/// An investigation measures its runs and does not evaluate them.
/// @return whether the run has results, and so a page.
bool WriteRunPage(const RunFolder& run) try {
  if (!std::filesystem::exists(run.results())) {
    const auto record = RunRecord::Open(run.path);
    record->WriteBeside(kResultsFile, JsonText(EvaluatedWithBudget(LoadScenario(run.scenario()), record->Readings()).evaluation.results));
  }
  WritePage(PageOf(run.path, "", ""), {run.path, "", "", "", false});
  return true;
} catch (const InputError& error) {
  fmt::print(stderr, "{} has no page: {}\n", run.path, error.what());
  return false;
}

void MakeReport(const ReportOptions& options, JsonAnswer& answer) {
  RequireOutput(answer.to(), {options.source, options.score, RunFolder{options.source}.results()});
  if (options.output == "-" && answer.IsOnStdout()) throw InputError("report", "page and --json both go to stdout", "-o FILE, or --json FILE");
  const bool wants_page = options.pictures.empty() || !options.output.empty();
  if (wants_page) RequirePages();
  nlohmann::json json = {{"source", options.source}};
  for (const std::string& run : RunsOfInvestigation(options.source))
    if (wants_page && WriteRunPage({run})) json["pages_of_runs"].push_back(UsualPagePath(run));
  const report::Page page = PageOf(options.source, options.score, OutputOf(options));
  if (!options.pictures.empty()) json["pictures"] = {{"folder", options.pictures}, {"files", WritePictures(page, options.pictures)}};
  if (wants_page) {
    WritePage(page, options);
    json["page"] = OutputOf(options);
  }
  answer.Write(json);
}

}  // namespace

void WriteReport(const std::string& source, const std::string& score, const std::string& output) {
  RequirePages();
  WriteFileAtOnce(output, HtmlFor(PageOf(source, score, output), {source, score, output, ""}));
}

void AddReport(CLI::App& app) {
  auto* command = app.add_subcommand(
      "report", "Make a page of plots and tables of a run, a diagnosis, a plan, a campaign or an investigation: one file that opens offline");
  auto options = std::make_shared<ReportOptions>();
  command->add_option("source", options->source, "folder of a run or an investigation, diagnosis.json, plan's JSON, or a campaign's table")->required();
  command->add_option("--score", options->score, "what `score --json` has written; else what `score` has left in the folder");
  AddTextOutput(*command, options->output, "the page, else report.html in the folder or beside the file,");
  command->add_option("--svg", options->pictures, "write every plot as an SVG picture into this folder; without -o no page is made");
  AddForce(*command, options->force);
  AnswerWith(*command, "what was written", [options](JsonAnswer& answer) { MakeReport(*options, answer); });
}

}  // namespace twinbench::tools
