#include "tools/twinbench/progress.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>

namespace twinbench::tools {
namespace {

std::string Clock(double seconds_s) {
  const auto whole = static_cast<long>(seconds_s + 0.5);
  return whole < 3600 ? fmt::format("{}:{:02}", whole / 60, whole % 60)
                      : fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace

ProgressLine::ProgressLine() : on_terminal_(isatty(fileno(stderr)) != 0), started_(WallClock::now()) {}

ProgressLine::~ProgressLine() {
  if (line_open_) fmt::print(stderr, "\n");
}

void ProgressLine::Show(int done, int planned, Phase phase, Time bench_time) {
  const auto now = WallClock::now();
  if (on_terminal_) {
    if (done < planned && now - shown_ < std::chrono::milliseconds(100)) return;
    fmt::print(stderr, "\r\033[K{}", Text(done, planned, phase, bench_time));
    line_open_ = true;
  } else {
    const int tenth = planned > 0 ? 10 * done / planned : 10;
    if (tenth == shown_tenth_) return;
    shown_tenth_ = tenth;
    fmt::print(stderr, "{}\n", Text(done, planned, phase, bench_time));
  }
  std::fflush(stderr);
  shown_ = now;
}

std::string ProgressLine::Text(int done, int planned, Phase phase, Time bench_time) const {
  const double elapsed_s = std::chrono::duration<double>(WallClock::now() - started_).count();
  const double remaining_s = done > 0 ? elapsed_s * (planned - done) / done : 0.0;
  return fmt::format("{:>5} of {} readings, {}, bench time {}, {} left", done, planned, PhaseName(phase),
                     Clock(ToSeconds(bench_time)), Clock(remaining_s));
}

procedure::ProgressCallback ShownOn(ProgressLine& line) {
  return [&line](const procedure::Progress& p) {
    line.Show(p.readings_done, p.readings_planned, p.phase, p.bench_time);
  };
}

}  // namespace twinbench::tools
