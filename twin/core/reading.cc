#include "twin/core/reading.h"

namespace twinbench {
namespace {

constexpr std::array<const char*, kPhases> kPhaseNames = {"calibration", "full_circle", "stability",
                                                          "verification"};
constexpr std::array<const char*, kReadingStatuses> kStatusNames = {"ok",           "saturated", "no_light",
                                                                    "clipped_spot", "overrun",   "missing"};

template <class Value, std::size_t kCount>
std::optional<Value> Named(const std::array<const char*, kCount>& names, std::string_view name) {
  for (std::size_t i = 0; i < kCount; ++i) {
    if (name == names[i]) return static_cast<Value>(i);
  }
  return std::nullopt;
}

}  // namespace

const char* PhaseName(Phase phase) {
  return kPhaseNames[static_cast<std::size_t>(phase)];
}

const char* ReadingStatusName(ReadingStatus status) {
  return kStatusNames[static_cast<std::size_t>(status)];
}

std::optional<Phase> PhaseOf(std::string_view name) {
  return Named<Phase>(kPhaseNames, name);
}

std::optional<ReadingStatus> ReadingStatusOf(std::string_view name) {
  return Named<ReadingStatus>(kStatusNames, name);
}

}  // namespace twinbench
