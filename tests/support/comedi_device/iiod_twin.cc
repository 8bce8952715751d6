#include "tests/support/comedi_device/iiod_twin.h"

#include <arpa/inet.h>
#include <netinet/tcp.h>

#include <cmath>
#include <cstring>

namespace twinbench::test {
namespace {

constexpr const char* kDevice = "psd-adc16";
constexpr const char* kMask = "0000001f";  // four inputs and the time stamp
constexpr std::size_t kScanBytes = kInputs * sizeof(std::int16_t) + sizeof(std::int64_t);

struct Ended : std::runtime_error {
  Ended() : std::runtime_error("the twin has closed the connection") {}
};

class Connection {
 public:
  explicit Connection(const std::string& address) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    const auto colon = address.find(':');
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(address.substr(colon + 1))));
    inet_pton(AF_INET, address.substr(0, colon).c_str(), &to.sin_addr);
    const int on = 1;
    setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    if (connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0) return;
    close(socket_);
    throw Ended();
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() { close(socket_); }
  int socket_number() const { return socket_; }

  void Send(const std::string& line) {
    const std::string text = line + "\r\n";
    if (send(socket_, text.data(), text.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(text.size())) throw Ended();
  }
  std::string Bytes(std::size_t n) {
    std::string bytes(n, '\0');
    if (recv(socket_, bytes.data(), n, MSG_WAITALL) != static_cast<ssize_t>(n)) throw Ended();
    return bytes;
  }
  std::string Line() {
    std::string line;
    for (char c = Bytes(1)[0]; c != '\n'; c = Bytes(1)[0]) line += c;
    return line;
  }
  long Number() { return std::stol(Line()); }

 private:
  int socket_;
};

/// Scans out of bytes that come in any pieces; watches their time stamps.
class Scans {
 public:
  explicit Scans(double period_ns) : period_ns_(period_ns) {}

  /// @return false where a scan is missing.
  bool Feed(const std::string& bytes, const std::function<void(std::span<const std::int16_t, kInputs>)>& take) {
    rest_ += bytes;
    std::size_t at = 0;
    for (; at + kScanBytes <= rest_.size(); at += kScanBytes) {
      std::array<std::int16_t, kInputs> codes;
      std::int64_t stamp_ns = 0;
      std::memcpy(codes.data(), &rest_[at], sizeof codes);
      std::memcpy(&stamp_ns, &rest_[at + sizeof codes], sizeof stamp_ns);
      if (!Follows(stamp_ns)) return false;
      take(codes);
    }
    rest_.erase(0, at);
    return true;
  }

 private:
  bool Follows(std::int64_t stamp_ns) {
    const bool follows =
        !any_ || std::abs(static_cast<double>(stamp_ns - last_ns_) - period_ns_) < 0.5 * period_ns_;
    any_ = true;
    last_ns_ = stamp_ns;
    return follows;
  }

  double period_ns_;
  std::string rest_;
  bool any_ = false;
  std::int64_t last_ns_ = 0;
};

}  // namespace

std::string IiodTwin::Attribute(const std::string& name) {
  Connection twin(address_);
  twin.Send(std::string("READ ") + kDevice + " " + name);
  const long length = twin.Number();
  if (length < 0) throw Ended();
  std::string text = twin.Bytes(static_cast<std::size_t>(length));
  return text.c_str();  // up to its NUL
}

CardTraits IiodTwin::Traits() {
  return {std::stoi(Attribute("bits")), std::stod(Attribute("conversion_frequency")),
          std::stod(Attribute("range_V"))};
}

unsigned IiodTwin::Lines() {
  const std::string light = Attribute("light");
  if (light == "ok") return 7;
  return light == "clipped_spot" ? 3 : 4;
}

Ending IiodTwin::Acquire(int scans, const std::function<void(std::span<const std::int16_t, kInputs>)>& take) {
  try {
    Scans taken(kInputs * 1e9 / std::stod(Attribute("conversion_frequency")));
    Connection twin(address_);
    streaming_ = twin.socket_number();
    if (aborted_) throw Ended();
    twin.Send(std::string("OPEN ") + kDevice + " " + std::to_string(scans) + " " + kMask);
    if (twin.Number() < 0) return Ending::kFifoFull;
    std::size_t missing = static_cast<std::size_t>(scans) * kScanBytes;
    twin.Send(std::string("READBUF ") + kDevice + " " + std::to_string(missing));
    for (bool first = true; missing > 0; first = false) {
      const long n = twin.Number();
      if (n == 0) return Ending::kShort;
      if (n < 0) return Ending::kFifoFull;
      if (first) twin.Line();  // the mask
      if (!taken.Feed(twin.Bytes(static_cast<std::size_t>(n)), take)) return Ending::kFifoFull;
      missing -= static_cast<std::size_t>(n);
    }
    streaming_ = -1;
    twin.Send(std::string("CLOSE ") + kDevice);
    twin.Number();
    return Ending::kComplete;
  } catch (const Ended&) {
    streaming_ = -1;
    return Ending::kFifoFull;
  }
}

void IiodTwin::Abort() {
  aborted_ = true;
  const int streaming = streaming_;
  if (streaming >= 0) shutdown(streaming, SHUT_RDWR);
}

std::unique_ptr<IiodTwin> TwinOfThisProcess() {
  const char* address = std::getenv("TWINBENCH_COMEDI_TWIN");
  if (address == nullptr) throw Ended();
  return std::make_unique<IiodTwin>(address);
}

}  // namespace twinbench::test
