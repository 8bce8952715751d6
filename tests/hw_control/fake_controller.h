#pragma once

#include <functional>
#include <mutex>
#include <thread>

namespace twinbench::test {

/// A controller made of a function: what to do about each line that comes. Written on the operating system's calls
/// alone, so that it shares nothing with what it tests.
class FakeController {
 public:
  struct Reply {
    std::string bytes;    // with line ends
    int delay_ms = 0;     // before them; later lines wait
    bool closes = false;  // behind them
  };
  using Handler = std::function<Reply(const std::string& line)>;

  enum class Wire { kTcp, kPseudoTerminal };
  /// @param port  0: any that is free.
  /// @param end   Of the lines that come.
  explicit FakeController(Handler handler, Wire wire = Wire::kTcp, int port = 0, char end = '\n');
  ~FakeController();

  std::string Address() const { return address_; }
  /// Every line that came, in order.
  std::vector<std::string> Lines() const;
  int Connections() const { return connections_; }
  /// On a pseudo-terminal: says something that nobody asked for.
  void Say(const std::string& bytes) const;

 private:
  void AcceptAll();
  void Converse(int fd, bool is_terminal);
  bool Take(int fd, const std::string& line, bool is_terminal);

  Handler handler_;
  std::string address_;
  char end_;
  int fd_ = -1, terminal_ = -1;
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
  std::atomic<int> connections_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// A port of this machine that nobody else is given and that refuses connections, unless a FakeController takes it.
class ReservedPort {
 public:
  ReservedPort();
  ~ReservedPort();
  int Port() const { return port_; }
  std::string Address() const { return "tcp:127.0.0.1:" + std::to_string(port_); }

 private:
  int port_ = 0;
  int fd_;
};

}  // namespace twinbench::test
