#include <fmt/core.h>

#include "tools/twinbench/commands.h"
#include "tools/twinbench/reported.h"
#include "tools/twinbench/run_folder.h"
#include "tools/web/bundle.h"
#include "twin/core/errors.h"
#include "twin/report/page/page_json.h"

namespace twinbench::tools {
namespace {

struct ReportOptions {
  std::string source, score, output;
};

void MakeReport(const ReportOptions& options) {
  if (web::PageMarkup().empty())
    throw InputError("report", "this program was built without pages",
                     "one that was built where npm is installed, without -DTWINBENCH_REPORT=OFF");
  const std::string output = options.output.empty() ? UsualPagePath(options.source) : options.output;
  RequireOutput(output, {options.source, options.score, RunFolder{options.source}.results()});
  const std::string html = report::PageHtml(PageOf(options.source, options.score), web::PageMarkup());
  if (output == "-") {
    fmt::print("{}", html);
  } else {
    WriteFileAtOnce(output, html);
    fmt::print("{} ({:.1f} MB): open it with a browser\n", output, 1e-6 * static_cast<double>(html.size()));
  }
}

}  // namespace

void AddReport(CLI::App& app) {
  auto* command = app.add_subcommand(
      "report", "Make a page of plots and tables of a run, a diagnosis, a plan, a campaign or an investigation: one file that opens offline");
  auto options = std::make_shared<ReportOptions>();
  command->add_option("source", options->source, "folder of a run or an investigation, diagnosis.json, plan's JSON, or a campaign's table")->required();
  command->add_option("--score", options->score, "what `score --json` has written; else score.json of the folder, if there");
  command->add_option("-o,--output", options->output, "write the page here, - for stdout; else report.html in the folder, or beside the file");
  command->callback([options] { MakeReport(*options); });
}

}  // namespace twinbench::tools
