#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace twinbench::hw {

/// Bytes of a client that nobody has read yet; never more than its size.
class InputBuffer {
 public:
  explicit InputBuffer(std::size_t size = 16384) : bytes_(size) {}

  /// Where new bytes go; empty: full.
  std::span<char> Space();
  void Commit(std::size_t n) { end_ += n; }

  std::string_view Unread() const { return {bytes_.data() + begin_, end_ - begin_}; }
  void Discard(std::size_t n) { begin_ += n; }

  /// Takes the next line, without its end.
  /// @param ends  Characters that end one: "\n" or "\r\n" (either).
  std::optional<std::string> TakeLine(std::string_view ends);

 private:
  std::vector<char> bytes_;
  std::size_t begin_ = 0, end_ = 0;
};

}  // namespace twinbench::hw
