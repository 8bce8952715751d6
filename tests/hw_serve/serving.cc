#include "tests/hw_serve/serving.h"

#include <arpa/inet.h>
#include <poll.h>

namespace twinbench::test {
namespace {

constexpr auto kPatience = std::chrono::seconds(20);

}  // namespace

TcpClient::TcpClient(int port, int receive_buffer) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
  if (receive_buffer > 0) setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("no connection");
}

TcpClient::~TcpClient() {
  close(socket_);
}

bool TcpClient::Send(const std::string& text) {
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t n = send(socket_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) return false;
    sent += static_cast<std::size_t>(n);
  }
  return true;
}

bool TcpClient::Fill(std::chrono::milliseconds within) {
  pollfd wait{socket_, POLLIN, 0};
  if (ended_ || poll(&wait, 1, static_cast<int>(within.count())) <= 0) return false;
  char bytes[65536];
  const ssize_t n = recv(socket_, bytes, sizeof bytes, 0);
  ended_ = n <= 0;
  if (n > 0) received_.append(bytes, static_cast<std::size_t>(n));
  return n > 0;
}

std::string TcpClient::Line() {
  while (received_.find('\n') == std::string::npos) {
    if (!Fill(kPatience)) throw std::runtime_error("no answer, but: " + received_);
  }
  const auto end = received_.find('\n');
  std::string line = received_.substr(0, end);
  received_.erase(0, end + 1);
  if (line.ends_with('\r')) line.pop_back();
  return line;
}

std::string TcpClient::Bytes(std::size_t n) {
  while (received_.size() < n) {
    if (!Fill(kPatience)) throw std::runtime_error("only " + std::to_string(received_.size()) + " bytes");
  }
  std::string bytes = received_.substr(0, n);
  received_.erase(0, n);
  return bytes;
}

bool TcpClient::Silent(std::chrono::milliseconds time) {
  return received_.empty() && !Fill(time) && !ended_;
}

bool TcpClient::Ends(std::chrono::milliseconds within) {
  const auto until = std::chrono::steady_clock::now() + within;
  while (!ended_ && std::chrono::steady_clock::now() < until) Fill(std::chrono::milliseconds(50));
  return ended_;
}

BufferClient::BufferClient(int port, int scans) : socket_(port) {
  if (socket_.Ask("OPEN psd-adc16 " + std::to_string(scans) + " 0000001f") != "0")
    throw std::runtime_error("the buffer does not open");
}

Scans BufferClient::Read(int scans) {
  const std::size_t bytes = static_cast<std::size_t>(scans) * kScanBytes;
  if (socket_.AskNumber("READBUF psd-adc16 " + std::to_string(bytes)) != static_cast<long long>(bytes) ||
      socket_.Line() != "0000001f") {
    throw std::runtime_error("the block is not what was asked for");
  }
  const std::string data = socket_.Bytes(bytes);
  Scans block;
  for (std::size_t at = 0; at < bytes; at += kScanBytes) {
    std::int16_t codes[kChannels];
    std::int64_t stamp_ns = 0;
    std::memcpy(codes, data.data() + at, sizeof codes);
    std::memcpy(&stamp_ns, data.data() + at + sizeof codes, sizeof stamp_ns);
    block.raw.insert(block.raw.end(), codes, codes + kChannels);
    block.stamps_ns.push_back(stamp_ns);
  }
  return block;
}

}  // namespace twinbench::test
