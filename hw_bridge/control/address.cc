#include "hw_bridge/control/address.h"

#include <fmt/format.h>

#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

/// The whole number behind the last colon, if there is one from 1 to `highest`.
std::optional<int> TakeNumber(std::string& text, int highest) {
  const auto colon = text.rfind(':');
  if (colon == std::string::npos) return std::nullopt;
  const auto number = ParseWholeNumber(text.substr(colon + 1));
  if (!number || *number < 1 || *number > highest) return std::nullopt;
  text.erase(colon);
  return static_cast<int>(*number);
}

std::optional<Address> ParseTcp(std::string host) {
  const auto port = TakeNumber(host, 65535);
  const bool in_brackets = host.size() > 2 && host.front() == '[' && host.back() == ']';  // IPv6
  if (in_brackets) host = host.substr(1, host.size() - 2);
  if (!port || host.empty()) return std::nullopt;
  return Address{Address::Kind::kTcp, host, *port};
}

/// The frame behind the last colon, if there is one.
std::optional<std::string> TakeFrame(std::string& text) {
  const auto colon = text.rfind(':');
  if (colon == std::string::npos || text.size() - colon != 4) return std::nullopt;
  const std::string frame = text.substr(colon + 1);
  const auto is_one_of = [](char c, std::string_view allowed) { return allowed.find(c) != std::string_view::npos; };
  if (!is_one_of(frame[0], "78") || !is_one_of(frame[1], "NEO") || !is_one_of(frame[2], "12")) return std::nullopt;
  text.erase(colon);
  return frame;
}

std::optional<Address> ParseSerial(std::string path) {
  const auto frame = TakeFrame(path);
  const auto baud = TakeNumber(path, 10'000'000);
  if (!path.starts_with('/') || (frame && !baud)) return std::nullopt;
  return Address{Address::Kind::kSerial, path, baud.value_or(kDefaultBaud), frame.value_or("8N1")};
}

}  // namespace

std::string Address::Text() const {
  if (kind == Kind::kSerial) return fmt::format("serial:{}:{}{}", place, number, frame == "8N1" ? "" : ":" + frame);
  const bool needs_brackets = place.find(':') != std::string::npos;
  return needs_brackets ? fmt::format("tcp:[{}]:{}", place, number) : fmt::format("tcp:{}:{}", place, number);
}

std::optional<Address> ParseAddress(const std::string& text) {
  if (text.starts_with("tcp:")) return ParseTcp(text.substr(4));
  if (text.starts_with("serial:")) return ParseSerial(text.substr(7));
  return std::nullopt;
}

}  // namespace twinbench::hw
