#include "tests/hw_control/fake_controller.h"

#include <arpa/inet.h>
#include <poll.h>
#include <pty.h>

#include <chrono>

namespace twinbench::test {
namespace {

constexpr int kLook_ms = 20;

void Demand(bool condition) {
  if (!condition) throw std::runtime_error("the fake controller has no socket or terminal");
}

/// A socket at `port`, or at any that is free; it is told which.
int Bind(int& port) {
  const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
  const int yes = 1;  // a port may be taken while it is only reserved
  ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(static_cast<std::uint16_t>(port));
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof place;
  Demand(::bind(fd, reinterpret_cast<sockaddr*>(&place), size) == 0);
  Demand(::getsockname(fd, reinterpret_cast<sockaddr*>(&place), &size) == 0);
  port = ntohs(place.sin_port);
  return fd;
}

int Listen(std::string& address, int port) {
  const int fd = Bind(port);
  Demand(::listen(fd, 8) == 0);
  address = "tcp:127.0.0.1:" + std::to_string(port);
  return fd;
}

int OpenTerminal(std::string& address, int& slave) {
  int master = -1;
  char name[256];
  termios raw{};
  cfmakeraw(&raw);
  Demand(::openpty(&master, &slave, name, &raw, nullptr) == 0);  // the slave stays open: no hang-up between clients
  address = std::string("serial:") + name + ":115200";
  return master;
}

bool IsReadable(int fd) {
  pollfd look{fd, POLLIN, 0};
  return ::poll(&look, 1, kLook_ms) > 0;
}

}  // namespace

ReservedPort::ReservedPort() : fd_(Bind(port_)) {}

ReservedPort::~ReservedPort() {
  ::close(fd_);
}

FakeController::FakeController(Handler handler, Wire wire, int port, char end) : handler_(std::move(handler)), end_(end) {
  const bool is_terminal = wire == Wire::kPseudoTerminal;
  fd_ = is_terminal ? OpenTerminal(address_, terminal_) : Listen(address_, port);
  thread_ = std::thread([this, is_terminal] { is_terminal ? Converse(fd_, true) : AcceptAll(); });
}

FakeController::~FakeController() {
  stop_ = true;
  thread_.join();
  ::close(fd_);
  if (terminal_ >= 0) ::close(terminal_);
}

std::vector<std::string> FakeController::Lines() const {
  const std::lock_guard lock(mutex_);
  return lines_;
}

void FakeController::Say(const std::string& bytes) const {
  Demand(::write(fd_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
}

void FakeController::AcceptAll() {
  while (!stop_) {
    if (!IsReadable(fd_)) continue;
    const int client = ::accept(fd_, nullptr, nullptr);
    ++connections_;
    Converse(client, false);
    ::close(client);
  }
}

void FakeController::Converse(int fd, bool is_terminal) {
  std::string unread;
  char bytes[1024];
  while (!stop_) {
    if (!IsReadable(fd)) continue;
    const auto n = ::read(fd, bytes, sizeof bytes);
    if (n <= 0) return;
    unread.append(bytes, static_cast<std::size_t>(n));
    for (auto end = unread.find(end_); end != std::string::npos; end = unread.find(end_)) {
      const std::string line = unread.substr(0, end);
      unread.erase(0, end + 1);
      if (!Take(fd, line, is_terminal)) return;
    }
  }
}

bool FakeController::Take(int fd, const std::string& line, bool is_terminal) {
  {
    const std::lock_guard lock(mutex_);
    lines_.push_back(line);
  }
  const Reply reply = handler_(line);
  std::this_thread::sleep_for(std::chrono::milliseconds(reply.delay_ms));
  const std::size_t size = reply.bytes.size();
  // A client that has gone is none of the controller's business.
  [[maybe_unused]] const auto sent =
      is_terminal ? ::write(fd, reply.bytes.data(), size) : ::send(fd, reply.bytes.data(), size, MSG_NOSIGNAL);
  return !reply.closes;
}

}  // namespace twinbench::test
