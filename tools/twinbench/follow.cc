#include "tools/twinbench/follow.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <vector>

#include "tools/twinbench/alarm_text.h"
#include "tools/twinbench/run_folder.h"
#include "twin/benches/registry.h"
#include "twin/core/errors.h"
#include "twin/core/run_record.h"
#include "twin/diagnose/watch.h"

namespace twinbench::tools {
namespace {

using std::chrono::duration;
using WallClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPause{200};

volatile std::sig_atomic_t interrupted = 0;

void Interrupt(int /*signal*/) {
  interrupted = 1;
}

/// SIGINT ends the watch in good order while this lives.
class InterruptGuard {
 public:
  InterruptGuard() : before_(std::signal(SIGINT, Interrupt)) {}
  ~InterruptGuard() { std::signal(SIGINT, before_); }
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

 private:
  void (*before_)(int);
};

void PrintAlarm(const diagnose::Alarm& alarm, const Watched& watched) {
  fmt::print("{}\n", AlarmText(alarm, watched));
  std::fflush(stdout);
}

nlohmann::json ToJson(const Watched& watched, const FollowOptions& options, std::size_t readings, bool complete) {
  nlohmann::json json = {{"readings", readings},
                         {"judged", watched.report.judged},
                         {"complete", complete},
                         {"false_alarm_rate", options.false_alarm_rate},
                         {"noise_scale", watched.report.noise_scale},
                         {"alarms", nlohmann::json::array()}};
  for (const diagnose::Alarm& alarm : watched.report.alarms) json["alarms"].push_back(AlarmJson(alarm, watched));
  return json;
}

/// Follows one record.
class Follower {
 public:
  Follower(const FollowOptions& options, JsonAnswer& answer)
      : options_(options),
        answer_(answer),
        record_(RunRecord::Open(options.folder)),
        scenario_(LoadScenario(options.scenario.empty() ? RunFolder{options.folder}.scenario() : options.scenario,
                               options.overrides)) {}

  void Run() {
    fmt::print(stderr, "watching {} with a false-alarm rate of {:g} % per run\n", options_.folder,
               100.0 * options_.false_alarm_rate);
    while (!complete_ && interrupted == 0) {
      const auto before = WallClock::now();
      complete_ = record_->finished();  // asked first: readings that come after are looked at in the next round
      const bool is_abandoned = !complete_ && !RunRecord::HasWriter(options_.folder);  // asked first, too
      Look();
      if (is_abandoned) break;
      if (!complete_) Pause(WallClock::now() - before);
    }
    Close();
    if (!complete_ && interrupted == 0)
      throw BenchError(options_.folder + ": the program that wrote this run ended before it was complete");
  }

 private:
  void Look() {
    const std::vector<Reading> readings = record_->Readings();
    if (readings.size() == seen_ && !complete_) return;
    seen_ = readings.size();
    const auto watched = Judge(readings);
    if (!watched) return;
    last_ = *watched;
    for (; alarms_ < last_.report.alarms.size(); ++alarms_)
      PrintAlarm(last_.report.alarms[alarms_], last_);
  }

  /// Nothing while there are too few readings to predict from.
  std::optional<Watched> Judge(const std::vector<Reading>& readings) const {
    try {
      const Bench& bench = BenchOf(scenario_);
      const diagnose::LinearRun run = bench.linear_run(readings, scenario_, options_.model);
      const diagnose::WatchOptions how{options_.false_alarm_rate, bench.planned_readings(scenario_)};
      return Seen(run, how);
    } catch (const InputError&) {
      if (complete_) throw;
      return std::nullopt;
    }
  }

  /// Longer where a look takes long, so that following costs at most a quarter of a core.
  static void Pause(WallClock::duration look) {
    const auto until = WallClock::now() + std::max<WallClock::duration>(kPause, 3 * look);
    while (interrupted == 0 && WallClock::now() < until) std::this_thread::sleep_for(kPause / 4);
  }

  void Close() const {
    answer_.Write(ToJson(last_, options_, seen_, complete_));
    if (answer_.IsOnStdout()) return;
    fmt::print("{} readings, {}; {} judged by those before them; {} at a false-alarm rate of {:g} % per run\n", seen_,
               complete_ ? "complete" : "not complete", last_.report.judged,
               alarms_ == 0 ? "no alarm" : fmt::format("{} alarm{}", alarms_, alarms_ == 1 ? "" : "s"),
               100.0 * options_.false_alarm_rate);
  }

  FollowOptions options_;
  JsonAnswer& answer_;
  std::unique_ptr<RunRecord> record_;
  Scenario scenario_;
  std::size_t seen_ = 0, alarms_ = 0;
  bool complete_ = false;
  Watched last_;
};

}  // namespace

void Follow(const FollowOptions& options, JsonAnswer& answer) {
  if (!(options.false_alarm_rate > 0.0 && options.false_alarm_rate < 1.0))
    throw InputError("--false-alarm-rate", fmt::format("{:g}", options.false_alarm_rate),
                     "a number between 0 and 1");
  if (!std::filesystem::is_directory(options.folder))
    throw InputError(options.folder, "this is not the folder of a run", "one with a record.sqlite");
  const InterruptGuard guard;
  Follower(options, answer).Run();
}

}  // namespace twinbench::tools
