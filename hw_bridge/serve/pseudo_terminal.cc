#include "hw_bridge/serve/pseudo_terminal.h"

#include <fcntl.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include <climits>

#include "twin/core/errors.h"

namespace twinbench::hw {
namespace {

constexpr auto kPause = std::chrono::milliseconds(20);  // between two conversations

}  // namespace

PseudoTerminal::PseudoTerminal(asio::io_context& io, Patience patience, MakeConversation make)
    : io_(io), patience_(patience), make_(std::move(make)), again_(io) {
  char name[PATH_MAX];
  termios raw{};
  cfmakeraw(&raw);
  if (openpty(&master_, &slave_, name, &raw, nullptr) != 0) throw BenchError("serve: no pseudo-terminal is left");
  path_ = name;
  Begin();
}

PseudoTerminal::~PseudoTerminal() {
  ending_ = true;
  if (session_) session_->Close();
  close(master_);
  close(slave_);
}

void PseudoTerminal::Begin() {
  using Stream = asio::posix::stream_descriptor;
  auto stream = std::make_unique<AsioStream<Stream>>(Stream(io_, fcntl(master_, F_DUPFD_CLOEXEC, 0)));
  session_ = std::make_shared<Session>(io_, std::move(stream), make_(), patience_, [this] {
    if (ending_) return;
    tcflush(slave_, TCIOFLUSH);
    again_.expires_after(kPause);
    again_.async_wait([this](const asio::error_code& error) {
      if (!error) Begin();
    });
  });
  session_->Start();
}

}  // namespace twinbench::hw
