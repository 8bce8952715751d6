#include "hw_bridge/serve/faults.h"

#include <fmt/format.h>

#include <algorithm>

#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

struct Kind {
  const char* devices;  // "tables": target, reference, controller
  const char* name;
  Injected kind;
};

constexpr Kind kKinds[] = {
    {"adc", "drop", Injected::kDrop},
    {"adc", "stall", Injected::kStall},
    {"adc", "short", Injected::kShort},
    {"adc", "error", Injected::kError},
    {"adc", "gap", Injected::kGap},
    {"adc", "saturate", Injected::kSaturate},
    {"adc", "float", Injected::kFloat},
    {"adc", "stuck", Injected::kStuck},
    {"adc", "hum", Injected::kHum},
    {"adc", "slip", Injected::kSlip},
    {"adc", "no_light", Injected::kNoLight},
    {"clock", "step", Injected::kStep},
    {"clock", "ppm", Injected::kPpm},
    {"tables", "mute", Injected::kMute},
    {"tables", "late", Injected::kLate},
    {"tables", "partial", Injected::kPartial},
    {"tables", "disconnect", Injected::kDisconnect},
    {"tables", "restart", Injected::kRestart},
    {"tables", "lost_step", Injected::kLostStep},
    {"tables", "not_in_position", Injected::kNotInPosition},
    {"tables", "limit", Injected::kLimit},
    {"tables", "stall", Injected::kStandStill},
    {"machine", "mute", Injected::kMute},
    {"machine", "late", Injected::kLate},
    {"machine", "partial", Injected::kPartial},
    {"machine", "disconnect", Injected::kDisconnect},
    {"machine", "restart", Injected::kRestart},
    {"machine", "not_in_position", Injected::kNotInPosition},
    {"machine", "limit", Injected::kLimit},
    {"machine", "stall", Injected::kStandStill},
    {"instruments", "mute", Injected::kMute},
    {"instruments", "late", Injected::kLate},
    {"instruments", "partial", Injected::kPartial},
    {"instruments", "disconnect", Injected::kDisconnect},
    {"instruments", "gap", Injected::kGap},
};
constexpr std::size_t kMostEntries = 100;
constexpr long long kMostStrikes = 1'000'000;

bool IsTable(std::string_view device) {
  return device == "target" || device == "reference" || device == "controller";
}

const Kind* KindOf(std::string_view device, std::string_view name) {
  const std::string_view devices = IsTable(device) ? "tables" : device;
  const auto* found =
      std::ranges::find_if(kKinds, [&](const Kind& k) { return devices == k.devices && name == k.name; });
  return found == std::end(kKinds) ? nullptr : found;
}

}  // namespace

bool Faults::Add(std::string_view device, std::string_view kind, long long count) {
  const Kind* known = KindOf(device, kind);
  if (!known || count < 1 || count > kMostStrikes || waiting_.size() >= kMostEntries) return false;
  waiting_.push_back({std::string(device), known->name, known->kind, count});
  return true;
}

bool Faults::Add(std::string_view device, std::string_view kind_and_count) {
  const auto comma = kind_and_count.find(',');
  if (comma == std::string_view::npos) return Add(device, kind_and_count, 1);
  const auto count = ParseWholeNumber(kind_and_count.substr(comma + 1));
  return count && Add(device, kind_and_count.substr(0, comma), *count);
}

Injected Faults::Take(std::initializer_list<std::string_view> devices, Injected first, Injected last) {
  const auto strikes = [&](const Entry& e) {
    return std::ranges::find(devices, e.device) != devices.end() && e.kind >= first && e.kind <= last;
  };
  const auto found = std::ranges::find_if(waiting_, strikes);
  if (found == waiting_.end()) return Injected::kNone;
  const Injected kind = found->kind;
  if (--found->count == 0) waiting_.erase(found);
  return kind;
}

std::string Faults::Waiting() const {
  std::string text;
  for (const Entry& e : waiting_) {
    text += fmt::format("{}{},{},{}", text.empty() ? "" : ";", e.device, e.name, e.count);
  }
  return text;
}

}  // namespace twinbench::hw
