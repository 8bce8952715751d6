#include "twin/core/sample_text.h"

#include <algorithm>
#include <sstream>

#include "twin/core/call_text.h"
#include "twin/core/errors.h"

namespace twinbench {
namespace {

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

[[noreturn]] void RefuseSample(const std::string& text, const std::string& why) {
  throw InputError("device call \"" + text + "\"", why, "a sample as a record of this bench keeps it");
}

}  // namespace

std::string StatesText(const std::vector<AxisState>& states) {
  std::string text;
  for (const AxisState& s : states) {
    text += text.empty() ? "" : "\n";
    text += StateText({s.commanded, s.encoder, s.moving, s.in_position, s.referenced, s.limit, s.fault});
  }
  return text;
}

std::vector<AxisState> ParseStates(const std::string& text) {
  std::vector<AxisState> states;
  for (const std::string& line : LinesOf(text)) {
    const TableState s = ParseState(line);
    states.push_back({s.commanded_rad, s.encoder_rad, s.moving, s.in_position, s.referenced, s.limit, s.fault});
  }
  return states;
}

std::string TravelText(const std::vector<AxisLimits>& travel) {
  CallWords words;
  for (const AxisLimits& axis : travel) words << axis.lower << axis.upper;
  return words.text();
}

std::vector<AxisLimits> ParseTravel(const std::string& text) {
  std::vector<AxisLimits> travel;
  for (CallReader words(text); !words.AtEnd();) {
    AxisLimits& axis = travel.emplace_back();
    axis.lower = words.Number();
    axis.upper = words.Number();
  }
  return travel;
}

std::string SampleText(const Reading& sample, const std::vector<ReadingColumn>& shown) {
  Reading readable = sample;  // whose numbers may be asked for by their places
  CallWords words;
  words << sample.time.time_since_epoch().count() << std::string(ReadingStatusName(sample.status));
  for (const ReadingColumn& column : shown) {
    if (!column.print(sample).empty()) words << column.name << column.number(readable);
  }
  return words.text();
}

Reading ParseSample(const std::string& text, const std::vector<ReadingColumn>& shown) {
  CallReader words(text);
  Reading sample;
  sample.time = Time(Duration(words.Integer()));
  const auto status = ReadingStatusOf(words.Word());
  if (!status) RefuseSample(text, "it has no status");
  sample.status = *status;
  while (!words.AtEnd()) {
    const std::string name = words.Word();
    const auto column = std::ranges::find(shown, name, &ReadingColumn::name);
    if (column == shown.end()) RefuseSample(text, "\"" + name + "\" is no column of an instrument");
    column->number(sample) = words.Number();
  }
  return sample;
}

std::string LatchedText(const LatchedSamples& latched, const std::vector<ReadingColumn>& shown) {
  std::string text = latched.overrun ? "1" : "0";
  for (const Reading& sample : latched.samples) text += "\n" + SampleText(sample, shown);
  return text;
}

LatchedSamples ParseLatched(const std::string& text, const std::vector<ReadingColumn>& shown) {
  const std::vector<std::string> lines = LinesOf(text);
  if (lines.empty()) RefuseSample(text, "it is empty");
  LatchedSamples latched;
  latched.overrun = lines.front() == "1";
  for (std::size_t k = 1; k < lines.size(); ++k) latched.samples.push_back(ParseSample(lines[k], shown));
  return latched;
}

}  // namespace twinbench
