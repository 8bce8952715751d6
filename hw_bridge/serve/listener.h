#pragma once

#include <asio.hpp>
#include <functional>
#include <memory>
#include <set>
#include <string>

#include "hw_bridge/serve/session.h"

namespace twinbench::hw {

using MakeConversation = std::function<std::unique_ptr<Conversation>()>;

/// Accepts the clients of one protocol. When there are as many as it may have, the one that has been silent longest
/// gives way. If all are being served, the new one waits for a place for a while, and those behind it in the
/// system's queue.
class Listener {
 public:
  /// @throws BenchError if the port is taken.
  Listener(asio::io_context& io, const std::string& address, int port, int max_connections, Patience patience,
           MakeConversation make);
  ~Listener();
  int port() const { return acceptor_.local_endpoint().port(); }

 private:
  void Accept();
  void AcceptAfter(WallClock::duration pause);
  /// @param until  It waits for a place to become free; then the client is turned away.
  void Admit(asio::ip::tcp::socket socket, WallClock::time_point until);
  void Begin(asio::ip::tcp::socket socket);
  bool HasRoom() const { return sessions_.size() < max_connections_; }
  bool MakeRoom();

  asio::io_context& io_;
  asio::ip::tcp::acceptor acceptor_;
  asio::steady_timer again_;
  std::size_t max_connections_;
  Patience patience_;
  MakeConversation make_;
  std::set<std::shared_ptr<Session>> sessions_;
};

}  // namespace twinbench::hw
