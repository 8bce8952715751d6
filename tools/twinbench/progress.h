#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "twin/core/reading.h"
#include "twin/procedure/options.h"

namespace twinbench::tools {

/// One line on stderr that says how far a run has come and how long it will still take. On a terminal the line is
/// rewritten in place; into a file or a pipe a line is written for every tenth of the run.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  void Show(int done, int planned, Phase phase, Time bench_time);

 private:
  std::string Text(int done, int planned, Phase phase, Time bench_time) const;

  using WallClock = std::chrono::steady_clock;
  bool on_terminal_;
  WallClock::time_point started_;
  WallClock::time_point shown_{};
  int shown_tenth_ = 0;
  bool line_open_ = false;
};

/// The same of a campaign, by trials.
class TrialsLine {
 public:
  TrialsLine();
  ~TrialsLine();
  void Show(std::int64_t done, std::int64_t planned, std::int64_t lost);

 private:
  using WallClock = std::chrono::steady_clock;
  bool on_terminal_;
  WallClock::time_point started_;
  std::int64_t shown_tenth_ = 0;
  bool line_open_ = false;
};

/// From here on no progress is shown: --quiet.
void ShowNoProgress();

/// What the program computes now, "run 3 of 9: other dwells": StillWorking shows it. Empty: it is about to write.
void Doing(const std::string& what);

/// Says on stderr that the work goes on, what it is and how long it has taken: on a terminal in one line that is rewritten from the
/// first second on, else once nothing was said for kQuiet or a little longer, as long as this lives.
class StillWorking {
 public:
  static constexpr std::chrono::seconds kQuiet{10};
  explicit StillWorking(std::chrono::milliseconds quiet = kQuiet);
  ~StillWorking() { Doing(""); }

 private:
  std::mutex mutex_;
  std::condition_variable_any ends_;
  std::jthread thread_;  // the last: it uses the others
};

/// What a procedure calls to be shown on `line`, which must outlive it.
procedure::ProgressCallback ShownOn(ProgressLine& line);

}  // namespace twinbench::tools
