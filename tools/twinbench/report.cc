#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/run_folder.h"
#include "tools/web/bundle.h"
#include "twin/core/errors.h"
#include "twin/core/run_record.h"
#include "twin/report/page/digest.h"
#include "twin/report/page/page_json.h"
#include "twin/report/page/run_page.h"

namespace twinbench::tools {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  std::string source, score, output;
};

std::string Contents(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The score of a run, where `score --json` has left it or the user says it is.
nlohmann::json ScoreOf(const RunFolder& folder, const std::string& named) {
  const std::string path = named.empty() ? folder.path + "/score.json" : named;
  if (!named.empty() || fs::exists(path)) return ReadJson(path);
  if (fs::exists(folder.truth()))
    fmt::print(stderr, "the run has not been scored: the page shows no truth (twinbench score {} --json {})\n", folder.path, path);
  return {};
}

std::string NameOf(const std::string& path) {
  return fs::weakly_canonical(path).filename().string();
}

report::PageSource SourceOf(const RunFolder& folder) {
  report::PageSource source{NameOf(folder.path), RunRecord::Open(folder.path)->provenance(), TWINBENCH_VERSION, {}};
  for (const std::string& file : {folder.scenario(), folder.record(), folder.results()}) {
    if (fs::exists(file)) source.digests.emplace_back(fs::path(file).filename().string(), report::Sha256(Contents(file)));
  }
  return source;
}

report::Page PageOf(const ReportOptions& options) {
  const RunFolder folder{options.source};
  if (!fs::exists(folder.results()))
    throw InputError(options.source, "there is no results.json", "the folder of a run that was evaluated");
  return report::RunPage(SourceOf(folder), ReadJson(folder.results()), ScoreOf(folder, options.score));
}

void Report(const ReportOptions& options) {
  if (web::PageMarkup().empty())
    throw InputError("report", "this program was built without pages", "one that was built where npm is installed, without -DTWINBENCH_REPORT=OFF");
  const std::string output = options.output.empty() ? options.source + "/report.html" : options.output;
  RequireOutput(output, {options.source, options.score, RunFolder{options.source}.results()});
  const std::string html = report::PageHtml(PageOf(options), web::PageMarkup());
  if (output == "-") {
    fmt::print("{}", html);
  } else {
    WriteFileAtOnce(output, html);
    fmt::print("{} ({:.1f} MB): open it with a browser\n", output, 1e-6 * static_cast<double>(html.size()));
  }
}

}  // namespace

void AddReport(CLI::App& app) {
  auto* command = app.add_subcommand("report", "Make a page of plots and tables of a run, one file that opens offline");
  auto options = std::make_shared<ReportOptions>();
  command->add_option("source", options->source, "folder of a run")->required();
  command->add_option("--score", options->score, "what `score --json` has written; else score.json of the folder, if there");
  command->add_option("-o,--output", options->output, "write the page here, - for stdout; else report.html in the folder");
  command->callback([options] { Report(*options); });
}

}  // namespace twinbench::tools
