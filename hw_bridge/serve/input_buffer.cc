#include "hw_bridge/serve/input_buffer.h"

#include <algorithm>

namespace twinbench::hw {

std::span<char> InputBuffer::Space() {
  if (begin_ > 0) {
    std::copy(bytes_.begin() + static_cast<long>(begin_), bytes_.begin() + static_cast<long>(end_), bytes_.begin());
    end_ -= begin_;
    begin_ = 0;
  }
  return std::span(bytes_).subspan(end_);
}

std::optional<std::string> InputBuffer::TakeLine(std::string_view ends) {
  const std::string_view unread = Unread();
  const auto end = unread.find_first_of(ends);
  if (end == std::string_view::npos) return std::nullopt;
  std::string line(unread.substr(0, end));
  Discard(end + 1);
  return line;
}

}  // namespace twinbench::hw
