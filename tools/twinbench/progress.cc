#include "tools/twinbench/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>

namespace twinbench::tools {
namespace {

std::string Clock(double seconds_s) {
  const auto whole = static_cast<long>(seconds_s + 0.5);
  return whole < 3600 ? fmt::format("{}:{:02}", whole / 60, whole % 60)
                      : fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

using Steady = std::chrono::steady_clock;
std::atomic<Steady::rep> last_said{0};
std::atomic<bool> shows_progress{true};

/// A terminal that is gone must not end a measurement.
void Say(const std::string& text) {
  if (!shows_progress) return;
  last_said = Steady::now().time_since_epoch().count();
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

/// What StillWorking is to show; one program does one thing at a time.
struct {
  std::mutex mutex;
  std::string what;
  bool line_open = false;
} doing;

}  // namespace

ProgressLine::ProgressLine() : on_terminal_(isatty(fileno(stderr)) != 0), started_(WallClock::now()) {}

ProgressLine::~ProgressLine() {
  if (line_open_) Say("\n");
}

void ProgressLine::Show(int done, int planned, Phase phase, Time bench_time) {
  const auto now = WallClock::now();
  if (on_terminal_) {
    if (done < planned && now - shown_ < std::chrono::milliseconds(100)) return;
    Say("\r\033[K" + Text(done, planned, phase, bench_time));
    line_open_ = true;
  } else {
    const int tenth = planned > 0 ? 10 * done / planned : 10;
    if (tenth == shown_tenth_) return;
    shown_tenth_ = tenth;
    Say(Text(done, planned, phase, bench_time) + "\n");
  }
  shown_ = now;
}

std::string ProgressLine::Text(int done, int planned, Phase phase, Time bench_time) const {
  const double elapsed_s = std::chrono::duration<double>(WallClock::now() - started_).count();
  const double remaining_s = done > 0 ? elapsed_s * (planned - done) / done : 0.0;
  return fmt::format("{:>5} of {} readings, {}, bench time {}, {} left", done, planned, PhaseName(phase),
                     Clock(ToSeconds(bench_time)), Clock(remaining_s));
}

TrialsLine::TrialsLine() : on_terminal_(isatty(fileno(stderr)) != 0), started_(WallClock::now()) {}

TrialsLine::~TrialsLine() {
  if (line_open_) Say("\n");
}

void TrialsLine::Show(std::int64_t done, std::int64_t planned, std::int64_t lost) {
  const std::int64_t tenth = 10 * done / planned;
  if (!on_terminal_ && tenth == shown_tenth_) return;
  shown_tenth_ = tenth;
  const double elapsed_s = std::chrono::duration<double>(WallClock::now() - started_).count();
  const double remaining_s = elapsed_s * static_cast<double>(planned - done) / static_cast<double>(done);
  const std::string text =
      fmt::format("{:>5} of {} trials, {} lost, {} left", done, planned, lost, Clock(remaining_s));
  Say(on_terminal_ ? "\r\033[K" + text : text + "\n");
  line_open_ = on_terminal_;
}

void ShowNoProgress() {
  shows_progress = false;
}

void Doing(const std::string& what) {
  const std::lock_guard lock(doing.mutex);
  doing.what = what;
  if (what.empty() && doing.line_open) Say("\r\033[K");
  if (what.empty()) doing.line_open = false;
}

StillWorking::StillWorking(std::chrono::milliseconds quiet)
    : thread_([this, quiet](const std::stop_token& stop) {
        const auto begin = Steady::now();
        last_said = begin.time_since_epoch().count();
        const bool on_terminal = isatty(fileno(stderr)) != 0;
        std::unique_lock lock(mutex_);
        const std::chrono::milliseconds pause = on_terminal ? std::min(quiet / 4, std::chrono::milliseconds(500)) : quiet / 4;
        while (!ends_.wait_for(lock, stop, pause, [&stop] { return stop.stop_requested(); })) {
          const auto now = Steady::now();
          const std::string since = Clock(std::chrono::duration<double>(now - begin).count());
          const std::lock_guard what_lock(doing.mutex);
          if (on_terminal && !doing.what.empty()) {
            if (now - begin < std::chrono::milliseconds(900)) continue;
            doing.line_open = true;
            Say("\r\033[K" + doing.what + ", " + since);
          } else if (now - Steady::time_point(Steady::duration(last_said)) >= quiet) {
            Say(fmt::format("still working{}, {}\n", doing.what.empty() ? "" : " (" + doing.what + ")", since));
          }
        }
      }) {}

procedure::ProgressCallback ShownOn(ProgressLine& line) {
  return [&line](const procedure::Progress& p) {
    line.Show(p.readings_done, p.readings_planned, p.phase, p.bench_time);
  };
}

}  // namespace twinbench::tools
