#include "twin/core/elapsed_time.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>

namespace twinbench {
namespace {

constexpr double kTold_s = 1.0;

double SecondsOf(clockid_t clock) {
  std::timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

ClockMark ClockMarkNow() {
  ClockMark mark;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> mark.boot;
  mark.since_boot_s = SecondsOf(CLOCK_BOOTTIME);
  mark.utc_s = SecondsOf(CLOCK_REALTIME);
  return mark;
}

std::string TextOf(const ClockMark& mark) {
  return fmt::format("boot {} {:.9f} s, UTC {:.9f} s", mark.boot.empty() ? "-" : mark.boot, mark.since_boot_s,
                     mark.utc_s);
}

std::optional<ClockMark> ParseClockMark(const std::string& text) {
  ClockMark mark;
  std::array<char, 64> boot{};
  if (std::sscanf(text.c_str(), "boot %63s %lf s, UTC %lf s", boot.data(), &mark.since_boot_s, &mark.utc_s) != 3)
    return {};
  if (boot[0] != '-') mark.boot = boot.data();
  return mark;
}

Elapsed Between(const ClockMark& first, const ClockMark& later) {
  const double by_utc_s = later.utc_s - first.utc_s;
  if (first.boot.empty()) return {FromSeconds(by_utc_s), ""};
  if (first.boot != later.boot)
    return {FromSeconds(by_utc_s),
            "the machine was started anew since the run began: its times go by the clock of the day"};
  const double by_boot_s = later.since_boot_s - first.since_boot_s, set_s = by_utc_s - by_boot_s;
  Elapsed elapsed{FromSeconds(by_boot_s), ""};
  if (std::abs(set_s) > kTold_s)
    elapsed.note = fmt::format(
        "the clock of the day was set by {:+.1f} s since the run began: its times do not go by it", set_s);
  return elapsed;
}

}  // namespace twinbench
