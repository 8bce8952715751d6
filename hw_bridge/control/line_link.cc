#include "hw_bridge/control/line_link.h"

#include <fmt/format.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <asio.hpp>
#include <chrono>

namespace twinbench::hw {
namespace {

using Tcp = asio::ip::tcp;
using HostClockPoint = std::chrono::steady_clock::time_point;

constexpr std::size_t kLongestLine = 1 << 16;

/// Runs one asynchronous operation, which `start(handler)` begins, for at most `patience`.
/// @param cancel  Ends the operation; what it had done by then still counts.
template <class Start, class Cancel>
asio::error_code RunFor(asio::io_context& io, Duration patience, Start start, Cancel cancel) {
  std::optional<asio::error_code> result;
  start([&result](asio::error_code error, auto&&...) { result = error; });
  io.restart();
  io.run_for(patience);
  if (!result) {
    cancel();
    io.restart();
    io.run();
  }
  return *result == asio::error::operation_aborted ? asio::error::timed_out : *result;
}

constexpr const char* kEnds = "\r\n";

LinkResult Failure(const asio::error_code& error) {
  if (error == asio::error::timed_out) return {"", FaultKind::kTimeout, "no answer in time"};
  if (error == asio::error::not_found)
    return {"", FaultKind::kProtocol, fmt::format("{} bytes without a line's end", kLongestLine)};
  if (error == asio::error::eof) return {"", FaultKind::kDropped, "the other side closed the connection"};
  return {"", FaultKind::kDropped, "the connection broke: " + error.message()};
}

template <class Stream>
class StreamLink : public LineLink {
 public:
  StreamLink() : stream_(io_) {}
  asio::io_context& io() { return io_; }
  Stream& stream() { return stream_; }

  LinkResult Send(const std::string& text, Duration patience) override {
    const auto error = Run(patience, [&](auto done) { asio::async_write(stream_, asio::buffer(text), done); });
    return error ? Failure(error) : LinkResult{};
  }

  LinkResult ReadLine(Duration patience) override {
    if (end_.empty()) return ReadAnyLine(patience);
    auto buffer = asio::dynamic_buffer(unread_, kLongestLine);
    const auto error = Run(patience, [&](auto done) { asio::async_read_until(stream_, buffer, end_, done); });
    const auto end = unread_.find(end_);
    if (end == std::string::npos) return Describe(error);
    LinkResult result{unread_.substr(0, end), {}, ""};
    unread_.erase(0, end + end_.size());
    if (end_ == "\n" && result.line.ends_with('\r')) result.line.pop_back();
    return result;
  }

  void EndLinesWith(const std::string& end) override { end_ = end; }

  bool HasUnread() override {
    int waiting = 0;
    ::ioctl(stream_.native_handle(), FIONREAD, &waiting);
    if (!end_.empty()) return waiting > 0 || !unread_.empty();
    std::string came(static_cast<std::size_t>(waiting), '\0');
    asio::error_code error;
    came.resize(waiting > 0 ? stream_.read_some(asio::buffer(came), error) : 0);
    unread_ += came;
    DropEnds();
    return !unread_.empty();
  }

  void ReadAway(Duration quiet, Duration patience) override {
    const HostClockPoint end = std::chrono::steady_clock::now() + patience;
    std::array<char, 4096> bytes;
    asio::error_code error;
    while (!error && std::chrono::steady_clock::now() < end) {
      error = Run(quiet, [&](auto done) { stream_.async_read_some(asio::buffer(bytes), done); });
    }
    unread_.clear();
  }

 private:
  void DropEnds() { unread_.erase(0, std::min(unread_.find_first_not_of(kEnds), unread_.size())); }

  LinkResult ReadAnyLine(Duration patience) {
    const HostClockPoint until = std::chrono::steady_clock::now() + patience;
    asio::error_code error;
    for (;;) {
      DropEnds();
      const auto end = unread_.find_first_of(kEnds);
      if (end != std::string::npos) {
        LinkResult result{unread_.substr(0, end), {}, ""};
        unread_.erase(0, end);
        return result;
      }
      if (error) return Describe(error);
      auto buffer = asio::dynamic_buffer(unread_, kLongestLine);
      const Duration left = std::max<Duration>(until - std::chrono::steady_clock::now(), Duration(0));
      if (unread_.size() >= kLongestLine) return Failure(asio::error::not_found);
      error = Run(left, [&](auto done) { asio::async_read(stream_, buffer, asio::transfer_at_least(1), done); });
    }
  }

  template <class Start>
  asio::error_code Run(Duration patience, Start start) {
    return RunFor(io_, patience, start, [this] {
      asio::error_code ignored;
      stream_.cancel(ignored);
    });
  }
  LinkResult Describe(const asio::error_code& error) const {
    LinkResult result = Failure(error);
    if (!unread_.empty() && result.failure != FaultKind::kProtocol)
      result.why += fmt::format(" (only \"{}\", without a line's end)", unread_.substr(0, 40));
    return result;
  }

  asio::io_context io_;
  Stream stream_;
  std::string unread_, end_ = "\n";
};

OpenedLink Opened(std::unique_ptr<LineLink> link, const asio::error_code& error) {
  if (!error) return {std::move(link), {}, ""};
  const bool is_late = error == asio::error::timed_out;
  return {nullptr, is_late ? FaultKind::kTimeout : FaultKind::kDropped,
          is_late ? "nobody answers there" : "cannot be reached: " + error.message()};
}

OpenedLink OpenTcp(const Address& address, Duration patience) {
  auto link = std::make_unique<StreamLink<Tcp::socket>>();
  Tcp::resolver resolver(link->io());
  Tcp::resolver::results_type places;
  const auto resolve = [&](auto done) {
    resolver.async_resolve(address.place, std::to_string(address.number),
                           [&places, done](auto error, auto found) mutable {
                             places = found;
                             done(error);
                           });
  };
  asio::error_code error = RunFor(link->io(), patience, resolve, [&] { resolver.cancel(); });
  if (error) return Opened(nullptr, error);
  asio::error_code ignored;
  const auto connect = [&](auto done) { asio::async_connect(link->stream(), places, done); };
  error = RunFor(link->io(), patience, connect, [&] { link->stream().close(ignored); });
  link->stream().set_option(Tcp::no_delay(true), ignored);
  return Opened(std::move(link), error);
}

asio::serial_port::parity::type ParityOf(char letter) {
  using Parity = asio::serial_port::parity;
  return letter == 'E' ? Parity::even : letter == 'O' ? Parity::odd : Parity::none;
}

OpenedLink OpenSerial(const Address& address) {
  using Port = asio::serial_port;
  auto link = std::make_unique<StreamLink<Port>>();
  asio::error_code error;
  const auto set = [&](const auto& option) {
    if (!error) link->stream().set_option(option, error);
  };
  link->stream().open(address.place, error);
  set(Port::baud_rate(static_cast<unsigned>(address.number)));
  set(Port::character_size(static_cast<unsigned>(address.frame[0] - '0')));
  set(Port::parity(ParityOf(address.frame[1])));
  set(Port::stop_bits(address.frame[2] == '2' ? Port::stop_bits::two : Port::stop_bits::one));
  set(Port::flow_control(Port::flow_control::none));
  return Opened(std::move(link), error);
}

}  // namespace

OpenedLink OpenLink(const Address& address, Duration patience) {
  return address.kind == Address::Kind::kTcp ? OpenTcp(address, patience) : OpenSerial(address);
}

}  // namespace twinbench::hw
