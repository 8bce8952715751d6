#include "hw_bridge/serve/iiod_conversation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <limits>

#include "hw_bridge/serve/words.h"
#include "twin/core/errors.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr const char* kVersion = "0.24.v0.24  \n";    // a shorter tag fails the clients
constexpr long long kLongestTimeout_ms = 0xffffffff;  // clients say so when they mean for ever

/// The whole number in a word, if it is one within [least, most]; otherwise -1.
long long Count(const std::vector<std::string>& words, std::size_t k, long long least, long long most) {
  const auto number = k < words.size() ? ParseWholeNumber(words[k]) : std::nullopt;
  return number && *number >= least && *number <= most ? *number : -1;
}

}  // namespace

Step IiodConversation::Next(InputBuffer& input) {
  if (delivery_) return Deliver();
  return awaits_value_ ? TakeValue(input) : TakeCommand(input);
}

Step IiodConversation::TakeCommand(InputBuffer& input) {
  while (auto line = input.TakeLine("\n")) {
    if (line->size() > kLongestLine) return Step::Close(fmt::format("{}\n", -EINVAL));
    if (line->ends_with('\r')) line->pop_back();
    if (line->empty()) continue;
    if (IsHttp(*line)) return Step::Close();
    const Step step = Obey(*line);
    return awaits_value_ ? TakeValue(input) : step;
  }
  return input.Unread().size() > kLongestLine ? Step::Close(fmt::format("{}\n", -EINVAL)) : Step::Read();
}

const IiodDevice* IiodConversation::Device(const Words& words) const {
  if (words.size() < 2) return nullptr;
  const auto found = std::ranges::find_if(devices_, [&](const IiodDevice& d) { return d.Is(words[1]); });
  return found == devices_.end() ? nullptr : &*found;
}

Step IiodConversation::Obey(const std::string& line) {
  const Words words = SplitWords(line);
  const std::string command = words.empty() ? std::string() : UpperCase(words[0]);
  if (command == "EXIT" || command == "QUIT") return Step::Close();
  if (command == "VERSION") return Step::Send(kVersion);
  if (command == "PRINT") return Print();
  if (command == "HELP") return Step::Send("IIOD 0.24 text protocol\n");
  if (command == "TIMEOUT") return NumberLine(Count(words, 1, 0, kLongestTimeout_ms) < 0 ? -EINVAL : 0);
  if (command == "SET") return Set(words);
  using ForDevice = Step (*)(IiodConversation&, const IiodDevice&, const Words&);
  struct Command {
    const char* name;
    ForDevice run;
  };
  static constexpr Command kCommands[] = {{"READ", [](auto& c, auto& d, auto& w) { return c.Read(d, w); }},
                                          {"WRITE", nullptr},
                                          {"OPEN", [](auto& c, auto& d, auto& w) { return c.Open(d, w); }},
                                          {"READBUF", [](auto& c, auto& d, auto& w) { return c.ReadBuffer(d, w); }},
                                          {"CLOSE", [](auto& c, auto& d, auto&) { return c.Close(d); }},
                                          {"GETTRIG", [](auto& c, auto& d, auto&) { return c.GetTrigger(d); }},
                                          {"SETTRIG", [](auto& c, auto& d, auto& w) { return c.SetTrigger(d, w); }},
                                          {"WRITEBUF", [](auto&, auto&, auto&) { return NumberLine(-EBADF); }}};
  for (const Command& known : kCommands) {
    if (command != known.name) continue;
    const IiodDevice* device = Device(words);
    if (command == "WRITE") return Write(device, words);  // without a device its value follows all the same
    return device ? known.run(*this, *device, words) : NumberLine(-ENODEV);
  }
  return NumberLine(-EINVAL);
}

Step IiodConversation::Print() {
  const std::string xml = IiodXml(devices_, served_.serial);
  return Step::Send(fmt::format("{}\n{}\n", xml.size(), xml));
}

Step IiodConversation::Read(const IiodDevice& device, const Words& words) {
  return Step::Send(ReadIiodAttributes(FindIiodTarget(device, Words(words.begin() + 2, words.end()))));
}

Step IiodConversation::Write(const IiodDevice* device, const Words& words) {
  const long long bytes = words.size() < 3 ? -1 : Count(words, words.size() - 1, 0, 1'000'000'000);
  if (bytes < 0) return NumberLine(-EINVAL);
  if (bytes > static_cast<long long>(kLongestValue)) return Step::Close(fmt::format("{}\n", -E2BIG));
  target_ = device ? FindIiodTarget(*device, Words(words.begin() + 2, words.end() - 1)) : IiodTarget();
  value_error_ = device ? 0 : -ENODEV;
  value_bytes_ = static_cast<std::size_t>(bytes);
  awaits_value_ = true;
  return Step::Read();
}

Step IiodConversation::TakeValue(InputBuffer& input) {
  if (input.Unread().size() < value_bytes_) return Step::Read();
  const std::string value(input.Unread().substr(0, value_bytes_));
  input.Discard(value_bytes_);
  awaits_value_ = false;
  return NumberLine(value_error_ != 0 ? value_error_ : WriteIiodAttribute(target_, value));
}

Step IiodConversation::Open(const IiodDevice& device, const Words& words) {
  const long long scans = Count(words, 2, 1, std::numeric_limits<int>::max());
  const auto mask = words.size() == 4 ? ParseIiodMask(words[3]) : std::nullopt;
  if (!device.has_buffer || scans < 0 || !mask) return NumberLine(-EINVAL);
  if (scans > static_cast<long long>(IiodBuffer::kMostScans)) return NumberLine(-ENOMEM);
  buffer_ = std::make_unique<IiodBuffer>(served_, *mask);
  return NumberLine(0);
}

Step IiodConversation::Close(const IiodDevice& device) {
  if (!buffer_ || !device.has_buffer) return NumberLine(-ENXIO);
  buffer_.reset();
  return NumberLine(0);
}

Step IiodConversation::Set(const Words& words) {
  if (!Device(words)) return NumberLine(-ENODEV);
  const bool known = words.size() == 4 && UpperCase(words[2]) == "BUFFERS_COUNT";
  return NumberLine(known && Count(words, 3, 1, 1024) > 0 ? 0 : -EINVAL);
}

Step IiodConversation::GetTrigger(const IiodDevice& device) {
  if (!device.has_buffer) return NumberLine(-ENOENT);
  const std::string& name = devices_.back().name;
  return Step::Send(fmt::format("{}\n{}\n", name.size(), name));
}

Step IiodConversation::SetTrigger(const IiodDevice& device, const Words& words) {
  if (!device.has_buffer) return NumberLine(-ENOENT);
  return NumberLine(words.size() < 3 || devices_.back().Is(words[2]) ? 0 : -ENOENT);
}

Step IiodConversation::ReadBuffer(const IiodDevice& device, const Words& words) {
  if (words.size() != 3) return NumberLine(-EINVAL);
  if (!buffer_ || !device.has_buffer) return NumberLine(-EBADF);
  const std::size_t scan_bytes = ScanBytes(buffer_->mask());
  const long long bytes = Count(words, 2, 1, static_cast<long long>(IiodBuffer::kMostScans * scan_bytes));
  if (bytes < static_cast<long long>(scan_bytes)) return NumberLine(-EINVAL);
  delivery_.emplace(served_, *buffer_, static_cast<std::size_t>(bytes));
  return Deliver();
}

Step IiodConversation::Deliver() {
  const Step step = delivery_->Next();
  if (delivery_->Done()) delivery_.reset();
  return step;
}

}  // namespace twinbench::hw
