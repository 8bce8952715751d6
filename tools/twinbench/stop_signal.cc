#include "tools/twinbench/stop_signal.h"

#include <atomic>
#include <csignal>
#include <initializer_list>

namespace twinbench::tools {
namespace {

constexpr std::initializer_list<int> kStops = {SIGINT, SIGTERM, SIGQUIT, SIGHUP};

std::atomic<bool> stop_asked = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal may come while it is being written");

void Remember(int) {
  stop_asked = true;
}

}  // namespace

void ListenForStop() {
  for (const int signal : kStops) std::signal(signal, Remember);
  std::signal(SIGPIPE, SIG_IGN);
}

void ListenNoMore() {
  for (const int signal : kStops) std::signal(signal, SIG_DFL);
}

bool StopWasAsked() {
  return stop_asked;
}

void AskToStop() {
  stop_asked = true;
}

}  // namespace twinbench::tools
