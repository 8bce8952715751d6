#include "twin/campaign/campaign.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "tools/twinbench/campaign_page.h"
#include "tools/twinbench/campaign_table.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/progress.h"
#include "tools/twinbench/run_folder.h"
#include "tools/twinbench/stop_signal.h"
#include "twin/campaign/trial.h"
#include "twin/core/errors.h"
#include "twin/report/sound.h"

namespace twinbench::tools {
namespace {

struct CampaignOptions {
  std::string study, table, csv;
  int threads = 0;  // 0: one for each core, or one a rank
  bool resume = false, mpi = false;
  std::optional<std::int64_t> trial;
  std::optional<int> web;         // port of the live page
  std::vector<std::string> show;  // results on it
};

int ThreadsOf(const CampaignOptions& options, const campaign::Ranks& ranks) {
  if (options.threads > 0) return options.threads;
  return ranks.Others() > 0 ? 1 : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Study and table of the first rank; whatever is wrong with them is said once and ends all ranks.
struct Begun {
  campaign::Study study;
  campaign::Table table;
};

Begun Begin(const CampaignOptions& options, campaign::Ranks& ranks) {
  try {
    campaign::Study study = campaign::LoadStudy(options.study);
    campaign::Table table = OpenTable(options.table, study, options.resume);
    ranks.Agree(true);
    return {std::move(study), std::move(table)};
  } catch (...) {
    ranks.Agree(false);
    throw;
  }
}

void Report(const campaign::Table& table, const CampaignOptions& options, JsonAnswer& answer) {
  const campaign::Summary summary = SummaryOf(table);
  answer.Write(SummaryJson(summary));
  if (!answer.IsOnStdout()) fmt::print("{}", report::WithoutNoNumbers(campaign::SummaryText(summary, options.study)));
  if (!options.csv.empty()) WriteFileAtOnce(options.csv, table.Csv());
}

/// @return whether every trial is in the table.
bool CarryOutShown(Begun& begun, const CampaignOptions& options, campaign::Ranks& ranks, LivePage& page) {
  TrialsLine line;
  CampaignPage shown(page, options.study + " into " + options.table, begun.table, options.show);
  const auto tell = [&](const campaign::CampaignProgress& p) {
    line.Show(p.done, p.planned, p.lost);
    shown.Hear(p);
  };
  return campaign::RunCampaign(begun.study, begun.table, ThreadsOf(options, ranks), ranks, tell, StopWasAsked);
}

void LeadCampaign(const CampaignOptions& options, campaign::Ranks& ranks, LivePage& page, JsonAnswer& answer) {
  Begun begun = Begin(options, ranks);
  if (!CarryOutShown(begun, options, ranks, page))
    throw BenchError("stopped by the operator; trials that had begun are in " + options.table + ". Go on with --resume");
  Report(begun.table, options, answer);
}

void FollowFirst(const CampaignOptions& options, campaign::Ranks& ranks) {
  if (!ranks.Agree(false)) return;  // the first rank has said why
  const campaign::Study study = campaign::LoadStudy(options.study);
  const campaign::Design design(study);
  ranks.WorkForFirst([&](std::int64_t trial) { return campaign::RunTrial(study, design, trial); });
}

void PrintTrial(const CampaignOptions& options, JsonAnswer& answer) {
  const campaign::Study study = campaign::LoadStudy(options.study);
  const campaign::Design design(study);
  if (*options.trial < 0 || *options.trial >= design.Trials())
    throw InputError(fmt::format("--trial {}", *options.trial), "the study has no such trial",
                     fmt::format("a number from 0 to {}", design.Trials() - 1));
  const std::string toml = WriteScenario(campaign::TwinOf(study, design, *options.trial));
  answer.Write({{"trial", *options.trial}, {"scenario_toml", toml}});
  if (!answer.IsOnStdout()) fmt::print("{}", toml);
}

void Campaign(const CampaignOptions& options, JsonAnswer& answer) {
  if (options.trial) return PrintTrial(options, answer);
  for (const std::string& output : {options.csv, answer.to()}) {
    RequireOutput(output, {options.study, options.table});
    RequireFolderOf(output);
  }
  if (!options.show.empty() && !options.web) throw InputError("--show", "there is no page to show it on", "--web PORT beside it");
  if (options.table.empty()) throw InputError("campaign", "there is no table", "-o TABLE.sqlite, or --trial N");
  campaign::Ranks ranks(options.mpi || campaign::Ranks::StartedAsOneOfMany());
  if (ranks.IsFirst())
    return WithLivePage(options.web, "campaign", [&](LivePage& page) { LeadCampaign(options, ranks, page, answer); });
  FollowFirst(options, ranks);
}

}  // namespace

void AddCampaign(CLI::App& app) {
  auto* command = app.add_subcommand("campaign", "Simulate a scenario many times with other keys and seeds, and summarise the trials");
  auto options = std::make_shared<CampaignOptions>();
  command->add_option("study", options->study, "study file (TOML)")->required();
  AddOutput(*command, options->table, "the table of the results (SQLite)");
  AddThreads(*command, options->threads);
  command->add_flag("--resume", options->resume, "go on with a table; trials that are in it are not done again");
  command->add_flag("--mpi", options->mpi, "share the trials with the other ranks; the default under mpirun");
  command->add_option("--csv", options->csv, "also write the table here, one line per trial");
  command->add_option("--trial", options->trial, "print the scenario of this trial, and do no more");
  AddWebOption(*command, options->web);
  command->add_option("--show", options->show, "result whose mean the page shows, as the summary names it; left out: the first few")->allow_extra_args(false);
  AnswerWith(*command, "the summary", [options](JsonAnswer& answer) { Campaign(*options, answer); });
}

}  // namespace twinbench::tools
