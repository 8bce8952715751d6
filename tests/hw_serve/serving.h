#pragma once

#include "tests/support/served_twin.h"

/// Clients of a served twin that are nothing but a socket.
namespace twinbench::test {

inline constexpr double kAtOnce = std::numeric_limits<double>::infinity();

/// Every wait ends after some seconds with an exception, so that a test cannot hang.
class TcpClient {
 public:
  explicit TcpClient(int port, int receive_buffer = 0);
  ~TcpClient();
  TcpClient(const TcpClient&) = delete;
  TcpClient& operator=(const TcpClient&) = delete;

  /// @return false if the server has closed the connection.
  bool Send(const std::string& text);
  std::string Line();  // without its end
  std::string Bytes(std::size_t n);
  std::string Ask(const std::string& text) {
    Send(text + "\n");
    return Line();
  }
  long long AskNumber(const std::string& text) { return std::stoll(Ask(text)); }
  /// Whether nothing comes within the time.
  bool Silent(std::chrono::milliseconds time);
  /// Whether the server closes the connection before `within`; what still comes is dropped.
  bool Ends(std::chrono::milliseconds within = std::chrono::seconds(5));

 private:
  bool Fill(std::chrono::milliseconds within);

  int socket_;
  std::string received_;
  bool ended_ = false;
};

/// Scans of a buffer with all channels and the time stamp.
struct Scans {
  std::vector<std::int16_t> raw;
  std::vector<std::int64_t> stamps_ns;
};

/// A client of IIOD with a buffer open on all channels and the time stamp.
class BufferClient {
 public:
  static constexpr std::size_t kScanBytes = 16;
  explicit BufferClient(int port, int scans);
  Scans Read(int scans);
  TcpClient& socket() { return socket_; }

 private:
  TcpClient socket_;
};

}  // namespace twinbench::test
