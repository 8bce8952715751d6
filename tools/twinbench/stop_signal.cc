#include "tools/twinbench/stop_signal.h"

#include <csignal>
#include <initializer_list>

namespace twinbench::tools {
namespace {

volatile std::sig_atomic_t stop_asked = 0;

void Remember(int signal) {
  stop_asked = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void ListenForStop() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, Remember);
}

bool StopWasAsked() {
  return stop_asked != 0;
}

}  // namespace twinbench::tools
