#include "twin/core/call_text.h"

#include <fmt/format.h>

#include <charconv>

#include "twin/core/device_call.h"
#include "twin/core/errors.h"

namespace twinbench {
namespace {

/// "nan" is a number here: out of range is an answer too.
template <class Number>
Number Parsed(const std::string& word, const std::string& text) {
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size())
    throw InputError("device call \"" + text + "\"", "\"" + word + "\" is no number",
                     "a call as a record keeps it");
  return number;
}

}  // namespace

CallWords& CallWords::operator<<(const std::string& word) {
  text_ += (text_.empty() ? "" : " ") + word;
  return *this;
}

CallWords& CallWords::operator<<(double number) {
  return *this << fmt::format("{}", number);
}

CallWords& CallWords::operator<<(std::int64_t number) {
  return *this << fmt::format("{}", number);
}

CallReader::CallReader(const std::string& text) : text_(text) {}

std::string CallReader::Word() {
  const std::size_t end = std::min(text_.find(' ', at_), text_.size());
  if (end <= at_)
    throw InputError("device call \"" + text_ + "\"", "it ends too early", "a call as a record keeps it");
  const std::string word = text_.substr(at_, end - at_);
  at_ = end + 1;
  return word;
}

double CallReader::Number() {
  return Parsed<double>(Word(), text_);
}

std::int64_t CallReader::Integer() {
  return Parsed<std::int64_t>(Word(), text_);
}

std::string CallReader::Rest() {
  return at_ < text_.size() ? text_.substr(at_) : "";
}

std::string StateText(const TableState& state) {
  CallWords words;
  words << state.commanded_rad << state.encoder_rad;
  for (const int flag : {int{state.moving}, int{state.in_position}, int{state.referenced}, state.limit})
    words << std::int64_t{flag};
  return state.fault.empty() ? words.text() : (words << state.fault).text();
}

TableState ParseState(const std::string& text) {
  CallReader reader(text);
  TableState state;
  state.commanded_rad = reader.Number();
  state.encoder_rad = reader.Number();
  state.moving = reader.Integer() != 0;
  state.in_position = reader.Integer() != 0;
  state.referenced = reader.Integer() != 0;
  state.limit = static_cast<int>(reader.Integer());
  state.fault = reader.Rest();
  return state;
}

std::string BlockText(const Acquisition& block) {
  CallWords words;
  words << block.start.time_since_epoch().count() << std::string(ReadingStatusName(block.status))
        << std::int64_t{block.n_samples} << std::int64_t{block.saturated_mask};
  for (const ChannelBlock& channel : block.channel)
    words << channel.mean_V << channel.std_V << channel.min_V << channel.max_V;
  return words.text();
}

Acquisition ParseBlock(const std::string& answer) {
  CallReader reader(answer);
  Acquisition block;
  block.start = Time(Duration(reader.Integer()));
  const auto status = ReadingStatusOf(reader.Word());
  if (!status)
    throw InputError("device call \"" + answer + "\"", "it has no status", "a call as a record keeps it");
  block.status = *status;
  block.n_samples = static_cast<int>(reader.Integer());
  block.saturated_mask = static_cast<int>(reader.Integer());
  for (ChannelBlock& channel : block.channel)
    channel = {reader.Number(), reader.Number(), reader.Number(), reader.Number()};
  return block;
}

}  // namespace twinbench
