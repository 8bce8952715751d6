#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "tools/twinbench/campaign_table.h"
#include "tools/twinbench/commands.h"
#include "tools/twinbench/common_options.h"
#include "tools/twinbench/json_answer.h"
#include "tools/twinbench/live_page.h"
#include "tools/twinbench/progress.h"
#include "tools/twinbench/run_folder.h"
#include "tools/twinbench/stop_signal.h"
#include "twin/campaign/campaign.h"
#include "twin/campaign/summary.h"
#include "twin/campaign/trial.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"
#include "twin/core/side_by_side.h"
#include "twin/report/sound.h"

namespace twinbench::tools {
namespace {

constexpr std::size_t kFewResults = 6;
constexpr auto kBetweenSums = std::chrono::milliseconds(100);
constexpr int kShareOfLooks = 20;  // summing up takes one part in so many of this thread's time at the most

bool IsList(const std::string& name) {
  return name.ends_with("[]");
}

nlohmann::json OrNull(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

/// Of a list, whose numbers have means of their own, no uncertainty of the mean is told.
nlohmann::json ResultJson(const std::string& name, const campaign::ResultSummary& r) {
  const double u_mean = IsList(name) || r.count < 2 ? NAN : r.sd / std::sqrt(static_cast<double>(r.count));
  return {{"name", name},           {"count", r.count},        {"mean", OrNull(r.mean)}, {"u_mean", OrNull(u_mean)}, {"sd", OrNull(r.sd)},
          {"rms_u", OrNull(r.rms_u)}, {"scored", r.scored}, {"rms_error", OrNull(r.rms_error)}, {"bias", OrNull(r.bias)}, {"coverage95", OrNull(r.coverage95)}};
}

/// Single numbers whose error is known first, then other single ones, then lists.
std::vector<std::string> FirstFew(const std::map<std::string, campaign::ResultSummary>& results) {
  std::vector<std::pair<int, std::string>> ranked;
  for (const auto& [name, r] : results) ranked.emplace_back(2 * (IsList(name) ? 1 : 0) + (r.scored > 0 ? 0 : 1), name);
  std::ranges::sort(ranked);
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min(kFewResults, ranked.size()); ++k) names.push_back(ranked[k].second);
  return names;
}

/// The live page of a campaign: trials done and lost, time left, and what some results have come to so far.
class CampaignPage {
 public:
  /// @param where   Study and table, in words.
  /// @param table   What is in it already counts.
  /// @param chosen  Results as the summary names them, "score.device.ez_arcsec[]"; empty: the first few, single ones that are scored before others.
  CampaignPage(LivePage& page, const std::string& where, const campaign::Table& table, std::vector<std::string> chosen)
      : page_(page), chosen_(std::move(chosen)) {
    if (!page_.IsOpen()) return;
    page_.Begin({{"bench", ""}, {"folder", where}, {"columns", nlohmann::json::array()}});
    table.ForEach([this](const campaign::TrialRow& row) {
      summary_.Add(row);
      TellLost(row);
    });
  }

  /// @throws InputError if the trials so far have come to results and a chosen one is not among them.
  void Hear(const campaign::CampaignProgress& progress) {
    if (!page_.IsOpen()) return;
    summary_.Add(*progress.row);
    TellLost(*progress.row);
    const auto now = WallClock::now();
    if (now < due_ && progress.done < progress.planned) return;
    TellResults(progress);
    due_ = WallClock::now() + std::max<WallClock::duration>(kBetweenSums, kShareOfLooks * (WallClock::now() - now));
  }

 private:
  void TellLost(const campaign::TrialRow& row) {
    if (!row.failure.empty()) page_.Told("lost_trial", {{"trial", row.trial}, {"failure", row.failure}});
  }

  void TellResults(const campaign::CampaignProgress& progress) {
    const std::map<std::string, campaign::ResultSummary> results = summary_.Results();
    if (!is_chosen_ && !results.empty()) ChooseAmong(results);
    const double elapsed_s = std::chrono::duration<double>(WallClock::now() - begun_).count();
    nlohmann::json told = {{"done", progress.done},
                           {"planned", progress.planned},
                           {"lost", progress.lost},
                           {"left_s", elapsed_s * static_cast<double>(progress.planned - progress.done) / static_cast<double>(progress.done)},
                           {"trials", summary_.Trials()},
                           {"results", nlohmann::json::array()}};
    for (const std::string& name : chosen_)
      if (const auto found = results.find(name); found != results.end()) told["results"].push_back(ResultJson(name, found->second));
    page_.Told("trials", told);
  }

  void ChooseAmong(const std::map<std::string, campaign::ResultSummary>& results) {
    is_chosen_ = true;
    if (chosen_.empty()) chosen_ = FirstFew(results);
    std::vector<std::string> names;
    for (const auto& [name, r] : results) names.push_back(name);
    for (const std::string& name : chosen_)
      if (!results.contains(name))
        throw InputError("--show " + name, "the trials come to no such result; those that are done are in the table, and --resume goes on",
                         "one that the summary names; the nearest is " + Nearest(name, names));
  }

  using WallClock = std::chrono::steady_clock;
  LivePage& page_;
  std::vector<std::string> chosen_;
  bool is_chosen_ = false;
  campaign::Summary summary_;
  WallClock::time_point begun_ = WallClock::now(), due_{};
};

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
  return ranks.Others() > 0 ? 1 : ProcessorCount();
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
