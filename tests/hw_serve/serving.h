#pragma once

#include "tests/support/served_twin.h"

namespace twinbench::test {

inline constexpr double kAtOnce = std::numeric_limits<double>::infinity();
inline constexpr const char* kToken = "4f2a9c";  // of guarded servers

/// Scans of a buffer with all channels and the time stamp.
struct Scans {
  std::vector<std::int16_t> raw;
  std::vector<std::int64_t> stamps_ns;
};

/// A client of IIOD with a buffer open on all channels and the time stamp.
class BufferClient {
 public:
  static constexpr std::size_t kScanBytes = 16;
  explicit BufferClient(int port, int scans) : socket_(port) {
    if (socket_.Ask("OPEN psd-adc16 " + std::to_string(scans) + " 0000001f") != "0")
      throw std::runtime_error("the buffer does not open");
  }
  Scans Read(int scans) {
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
  TcpClient& socket() { return socket_; }

 private:
  TcpClient socket_;
};

// What is said and answered in tests/data/conversations.txt.

struct Said {
  std::string port, text;
  std::vector<std::string> answers;
};

struct Conversation {
  std::string name;
  std::vector<Said> turns;
};

inline std::string WithCharacters(std::string text) {
  for (const auto& [written, character] :
       {std::pair{"\\n", "\n"}, {"\\r", "\r"}, {"\\x01", "\x01"}, {"\\x02", "\x02"}})
    for (std::size_t at = text.find(written); at != std::string::npos; at = text.find(written))
      text.replace(at, std::strlen(written), character);
  return text;
}

inline std::vector<Conversation> Conversations() {
  std::vector<Conversation> all;
  std::ifstream file(TWINBENCH_TEST_DATA "/conversations.txt");
  for (std::string line; std::getline(file, line);) {
    const std::size_t prompt = line.find("> ");
    if (line.starts_with("## "))
      all.push_back({line.substr(3), {}});
    else if (line.empty() || line.starts_with("#"))
      continue;
    else if (prompt < 6)
      all.back().turns.push_back({line.substr(0, prompt), WithCharacters(line.substr(prompt + 2)), {}});
    else
      all.back().turns.back().answers.push_back(line);
  }
  return all;
}

}  // namespace twinbench::test
