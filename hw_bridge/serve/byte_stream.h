#pragma once

#include <asio.hpp>
#include <functional>
#include <memory>
#include <span>
#include <utility>

namespace twinbench::hw {

/// A connection of any kind: TCP, pseudo-terminal.
class ByteStream {
 public:
  using Done = std::function<void(const asio::error_code&, std::size_t)>;
  virtual ~ByteStream() = default;
  virtual void ReadSome(std::span<char> space, Done done) = 0;
  /// Writes all of it.
  virtual void Write(std::span<const char> bytes, Done done) = 0;
  virtual void Close() = 0;
};

template <class Stream>
class AsioStream : public ByteStream {
 public:
  explicit AsioStream(Stream stream) : stream_(std::move(stream)) {}
  void ReadSome(std::span<char> space, Done done) override {
    stream_.async_read_some(asio::buffer(space.data(), space.size()), std::move(done));
  }
  void Write(std::span<const char> bytes, Done done) override {
    asio::async_write(stream_, asio::buffer(bytes.data(), bytes.size()), std::move(done));
  }
  void Close() override {
    asio::error_code ignored;
    stream_.close(ignored);
  }

 private:
  Stream stream_;
};

}  // namespace twinbench::hw
