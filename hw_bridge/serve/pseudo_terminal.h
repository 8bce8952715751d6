#pragma once

#include <memory>
#include <string>

#include "hw_bridge/serve/listener.h"

namespace twinbench::hw {

/// A serial line that exists only in the kernel. It has one client at a time and never hangs up: when a
/// conversation ends, the next begins on the same line.
class PseudoTerminal {
 public:
  /// @throws BenchError if the system gives none.
  PseudoTerminal(asio::io_context& io, Patience patience, MakeConversation make);
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;
  const std::string& path() const { return path_; }

 private:
  void Begin();

  asio::io_context& io_;
  Patience patience_;
  MakeConversation make_;
  int master_ = -1, slave_ = -1;  // the slave stays open, so that the line stays up without a client
  std::string path_;
  asio::steady_timer again_;
  std::shared_ptr<Session> session_;
  bool ending_ = false;
};

}  // namespace twinbench::hw
