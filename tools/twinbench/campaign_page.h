#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "tools/twinbench/live_page.h"
#include "twin/campaign/campaign.h"
#include "twin/campaign/summary.h"

namespace twinbench::tools {

/// The live page of a campaign: trials done and lost, time left, and what some results have come to so far.
class CampaignPage {
 public:
  /// @param where   Study and table, in words.
  /// @param table   What is in it already counts.
  /// @param chosen  Results as the summary names them, "score.device.ez_arcsec[]"; empty: the first few, single ones that are scored before others.
  CampaignPage(LivePage& page, const std::string& where, const campaign::Table& table, std::vector<std::string> chosen);
  /// @throws InputError if the trials so far have come to results and a chosen one is not among them.
  void Hear(const campaign::CampaignProgress& progress);

 private:
  void TellLost(const campaign::TrialRow& row);
  void TellResults(const campaign::CampaignProgress& progress);
  void ChooseAmong(const std::map<std::string, campaign::ResultSummary>& results);

  using WallClock = std::chrono::steady_clock;
  LivePage& page_;
  std::vector<std::string> chosen_;
  bool is_chosen_ = false;
  campaign::Summary summary_;
  WallClock::time_point begun_ = WallClock::now(), due_{};
};

}  // namespace twinbench::tools
