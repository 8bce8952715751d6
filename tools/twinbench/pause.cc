#include "tools/twinbench/pause.h"

#include <chrono>
#include <thread>

#include "twin/core/errors.h"

namespace twinbench::tools {
namespace {

constexpr auto kHeardWithin = std::chrono::milliseconds(10);
constexpr auto kBetweenChecks = std::chrono::milliseconds(500);

/// A controller that does not answer is for the next move to find out.
procedure::Standstill AnswerOf(const StandingCheck& stands) {
  if (!stands) return {true, ""};
  try {
    return stands();
  } catch (const BenchError& error) {
    return {false, error.what()};
  }
}

}  // namespace

void Pause::HoldIfAsked(int reading, const StandingCheck& stands, const std::function<bool()>& stop_asked) {
  if (!is_wanted_) return;
  const auto asked = std::chrono::steady_clock::now();
  if (asked - refused_ < kBetweenChecks) return;
  if (const procedure::Standstill now = AnswerOf(stands); !now.is_sure) {
    refused_ = asked;
    return ears_.not_yet(now.why_not);
  }
  refused_ = {};
  ears_.paused(reading);
  HoldWhileWanted(stands, stop_asked);
  ears_.resumed(reading);
}

void Pause::HoldWhileWanted(const StandingCheck& stands, const std::function<bool()>& stop_asked) {
  auto looked = std::chrono::steady_clock::now();
  while (is_wanted_ && !stop_asked()) {
    std::this_thread::sleep_for(kHeardWithin);
    if (!stands || std::chrono::steady_clock::now() - looked < kBetweenChecks) continue;
    if (const procedure::Standstill now = AnswerOf(stands); !now.is_sure) ears_.restless(now.why_not);
    looked = std::chrono::steady_clock::now();
  }
}

}  // namespace twinbench::tools
