#include "tools/twinbench/stop_signal.h"

#include <csignal>
#include <initializer_list>

namespace twinbench::tools {
namespace {

constexpr std::initializer_list<int> kStops = {SIGINT, SIGTERM, SIGQUIT, SIGHUP};

volatile std::sig_atomic_t stop_asked = 0;

void Remember(int) {
  stop_asked = 1;
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
  return stop_asked != 0;
}

}  // namespace twinbench::tools
