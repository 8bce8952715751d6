#pragma once

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <string>

namespace twinbench::test {

/// A client of a server on this computer that is nothing but a socket. Every wait ends after some seconds with an
/// exception, so that a test cannot hang.
class TcpClient {
 public:
  explicit TcpClient(int port, int receive_buffer = 0) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0) setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    const int at_once = 1;
    setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) return;
    close(socket_);
    throw std::runtime_error("no connection");
  }
  ~TcpClient() { close(socket_); }
  TcpClient(const TcpClient&) = delete;
  TcpClient& operator=(const TcpClient&) = delete;

  /// For another thread, which may shut it down.
  int number() const { return socket_; }

  /// @return false if the server has closed the connection.
  bool Send(const std::string& text) {
    for (std::size_t sent = 0; sent < text.size();) {
      const ssize_t n = send(socket_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) return false;
      sent += static_cast<std::size_t>(n);
    }
    return true;
  }
  std::string Bytes(std::size_t n) {
    while (received_.size() < n)
      if (!Fill(kPatience)) throw std::runtime_error("only " + std::to_string(received_.size()) + " bytes");
    const std::string bytes = received_.substr(0, n);
    received_.erase(0, n);
    return bytes;
  }
  /// What comes before the mark, and it.
  std::string Until(const std::string& mark) {
    while (received_.find(mark) == std::string::npos)
      if (!Fill(kPatience)) throw std::runtime_error("no answer, but: " + received_);
    return Bytes(received_.find(mark) + mark.size());
  }
  /// Without its end.
  std::string Line() {
    std::string line = Until("\n");
    line.erase(line.size() - (line.ends_with("\r\n") ? 2 : 1));
    return line;
  }
  /// What comes before the server closes the connection.
  std::string Rest() {
    while (Fill(kPatience)) {
    }
    return received_;
  }
  std::string Ask(const std::string& text) {
    Send(text + "\n");
    return Line();
  }
  long long AskNumber(const std::string& text) { return std::stoll(Ask(text)); }
  /// Whether nothing comes within the time.
  bool Silent(std::chrono::milliseconds time) { return received_.empty() && !Fill(time) && !ended_; }
  /// Whether the server closes the connection before `within`; what still comes is dropped.
  bool Ends(std::chrono::milliseconds within = std::chrono::seconds(5)) {
    const auto until = std::chrono::steady_clock::now() + within;
    while (!ended_ && std::chrono::steady_clock::now() < until) Fill(std::chrono::milliseconds(50));
    return ended_;
  }

 private:
  static constexpr std::chrono::seconds kPatience{20};

  bool Fill(std::chrono::milliseconds within) {
    pollfd wait{socket_, POLLIN, 0};
    if (ended_ || poll(&wait, 1, static_cast<int>(within.count())) <= 0) return false;
    char bytes[65536];
    const ssize_t n = recv(socket_, bytes, sizeof bytes, 0);
    ended_ = n <= 0;
    if (n > 0) received_.append(bytes, static_cast<std::size_t>(n));
    return n > 0;
  }

  int socket_;
  std::string received_;
  bool ended_ = false;
};

}  // namespace twinbench::test
