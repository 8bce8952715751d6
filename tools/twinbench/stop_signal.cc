#include "tools/twinbench/stop_signal.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <initializer_list>

namespace twinbench::tools {
namespace {

constexpr std::initializer_list<int> kStops = {SIGINT, SIGTERM, SIGQUIT, SIGHUP};

std::atomic<bool> stop_asked = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal may come while it is being written");

std::atomic<const char*> said_at_once = nullptr;

void Remember(int) {
  const bool is_first = !stop_asked.exchange(true);
  const char* said = said_at_once;
  if (!is_first || !said) return;
  const int before = errno;
  // A terminal that is gone has nobody to tell.
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, said, std::strlen(said));
  errno = before;
}

}  // namespace

void ListenForStop(const char* said) {
  said_at_once = said;
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
