#include "hw_bridge/serve/listener.h"

#include <algorithm>

#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

using asio::ip::tcp;
constexpr auto kAfterFailure = std::chrono::milliseconds(100);  // out of descriptors: nothing to be done at once
constexpr auto kForAPlace = std::chrono::milliseconds(1000), kTryAgain = std::chrono::milliseconds(10);

tcp::acceptor OpenAt(asio::io_context& io, const std::string& address, int port) {
  try {
    return tcp::acceptor(io, tcp::endpoint(asio::ip::make_address(address), static_cast<unsigned short>(port)));
  } catch (const std::system_error& error) {
    throw BenchError("serve: cannot listen at " + address + ":" + std::to_string(port) + ": " + error.what());
  }
}

}  // namespace

Listener::Listener(asio::io_context& io, const std::string& address, int port, int max_connections,
                   Patience patience, MakeConversation make)
    : io_(io),
      acceptor_(OpenAt(io, address, port)),
      again_(io),
      max_connections_(static_cast<std::size_t>(max_connections)),
      patience_(patience),
      make_(std::move(make)) {
  Accept();
}

Listener::~Listener() {
  const auto open = sessions_;
  for (const auto& session : open) session->Close();
}

void Listener::Accept() {
  acceptor_.async_accept([this](const asio::error_code& error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    error ? AcceptAfter(kAfterFailure) : Admit(std::move(socket), WallClock::now() + kForAPlace);
  });
}

void Listener::AcceptAfter(WallClock::duration pause) {
  again_.expires_after(pause);
  again_.async_wait([this](const asio::error_code& stopped) {
    if (!stopped) Accept();
  });
}

void Listener::Admit(tcp::socket socket, WallClock::time_point until) {
  const bool has_place = HasRoom() || MakeRoom();
  if (has_place) Begin(std::move(socket));
  if (has_place || WallClock::now() >= until) return Accept();
  again_.expires_after(kTryAgain);
  again_.async_wait([this, waiting = std::move(socket), until](const asio::error_code& stopped) mutable {
    if (!stopped) Admit(std::move(waiting), until);
  });
}

void Listener::Begin(tcp::socket socket) {
  asio::error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  auto stream = std::make_unique<AsioStream<tcp::socket>>(std::move(socket));
  // The session names itself when it ends, by a weak pointer, so that it does not keep itself alive.
  auto self = std::make_shared<std::weak_ptr<Session>>();
  const auto session = std::make_shared<Session>(io_, std::move(stream), make_(), patience_,
                                                 [this, self] { sessions_.erase(self->lock()); });
  *self = session;
  sessions_.insert(session);
  session->Start();
}

bool Listener::MakeRoom() {
  std::shared_ptr<Session> silent;
  for (const auto& session : sessions_) {
    if (session->IsUnused() && (!silent || session->began() < silent->began())) silent = session;
  }
  if (silent) silent->Close();
  return silent != nullptr;
}

}  // namespace twinbench::hw
