#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "twin/core/reading.h"
#include "twin/core/scenario.h"

namespace twinbench::tools {

/// Compares readings with what the twin and the readings before them predict, while they come, as `diagnose --follow` does: on a thread of its
/// own, which takes at most a quarter of a core, however long the run grows.
///
/// It tells, as text of JSON:
///   residuals  {"channels": [{"name", "unit"}], "readings": [{"n", "v": [...], "u": [...]}]}: reading - prediction, in the channels' units;
///              null where those before do not determine it
///   alarm      {"words": "alarm at reading ..."}
///   unjudged   {"why"}: there will be nothing
class LiveJudge {
 public:
  /// @param tell  (kind, json); called on the judge's thread.
  LiveJudge(const Scenario& scenario, std::function<void(const char*, const std::string&)> tell);
  /// Waits for the look under way, and looks at what is left if looks are short.
  ~LiveJudge();

  /// From the thread that measures: keeps the reading and returns.
  void Hear(const Reading& reading);

 private:
  void Work(const std::stop_token& ended);
  bool TakeNew();
  void Look();
  void Judge();

  Scenario scenario_;
  std::function<void(const char*, const std::string&)> tell_;
  std::mutex mutex_;               // held for as long as it takes to move a list
  std::vector<Reading> incoming_;  // under it
  std::vector<Reading> readings_;  // the judge's own, as are those below
  std::size_t alarms_ = 0;
  int told_to_ = -1;  // number of the last reading whose residual was told
  std::chrono::steady_clock::duration look_{};
  bool gives_up_ = false;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace twinbench::tools
