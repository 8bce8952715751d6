#include "tools/live/feed.h"

#include <algorithm>

namespace twinbench::live {

void Feed::Add(const std::string& kind, const std::string& json) {
  events_.push_back("id: " + std::to_string(end()) + "\nevent: " + kind + "\ndata: " + json + "\n\n");
  if (events_.size() <= most_events_) return;
  events_.pop_front();
  ++first_;
}

std::string Feed::From(std::uint64_t& next, std::size_t most_B) const {
  std::string text;
  for (next = std::max(next, first_); next < end() && text.size() < most_B; ++next) text += events_[next - first_];
  return text;
}

}  // namespace twinbench::live
