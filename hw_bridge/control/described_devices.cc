#include "hw_bridge/control/described_devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "hw_bridge/control/scpi.h"
#include "twin/core/number_text.h"
#include "twin/core/units.h"

namespace twinbench::hw {
namespace {

constexpr Duration kLookAtIndexer = std::chrono::milliseconds(50);

[[noreturn]] void Refused(const DeviceLine& line, FaultKind kind, const std::string& said,
                          const std::string& answer) {
  line.Fail(kind, fmt::format("\"{}\" was refused: {}", said, answer));
}

/// Whether a text is another, or the same number otherwise written.
bool IsSame(const std::string& text, const std::string& other) {
  return text == other || (ParseNumber(text) && ParseNumber(text) == ParseNumber(other));
}

}  // namespace

bool IsNothing(const std::string& text, const std::vector<std::string>& nothing) {
  return std::ranges::any_of(nothing, [&](const std::string& other) { return IsSame(text, other); });
}

bool ShowsSomething(const std::vector<std::string>& texts, std::size_t from,
                    const std::vector<std::string>& valid) {
  for (std::size_t k = 0; k < valid.size(); ++k) {
    if (!valid[k].empty() && !IsSame(texts[from + k], valid[k])) return false;
  }
  return true;
}

void TellDescribed(DeviceLine& line, const ErrorWords& errors, const std::string& command, Duration beyond) {
  if (errors == ErrorWords{}) return TellScpi(line, command, beyond);
  if (!errors.acknowledged.empty()) {
    const std::string answer = line.Ask(command, beyond);
    if (!answer.starts_with(errors.acknowledged)) Refused(line, FaultKind::kRefused, command, answer);
    return;
  }
  if (errors.ask.empty()) return line.Tell(command);
  const std::string answer = line.Ask(command + "\n" + errors.ask, beyond);
  if (answer.starts_with(errors.none)) return;
  const bool is_limit = !errors.limit.empty() && answer.starts_with(errors.limit);
  Refused(line, is_limit ? FaultKind::kLimit : FaultKind::kRefused, command, answer);
}

std::string AskDescribed(DeviceLine& line, const ErrorWords& errors, const std::string& query, Duration beyond) {
  std::string answer = line.Ask(query, beyond);
  for (const std::string& refusal : errors.refusals) {
    if (answer.starts_with(refusal)) Refused(line, FaultKind::kRefused, query, answer);
  }
  return answer;
}

std::optional<std::vector<std::string>> SplitAnswer(const std::string& answer, const std::string& separator) {
  if (separator == ",") return SplitScpi(answer);
  std::vector<std::string> fields;
  for (std::size_t from = 0; from <= answer.size();) {
    const std::size_t end = std::min(answer.find(separator, from), answer.size());
    if (separator != " " || end > from) fields.push_back(answer.substr(from, end - from));
    from = end + separator.size();
  }
  return fields;
}

std::vector<double> DescribedSample::Read(const std::vector<std::string>& fields) {
  const ReadWords& read = words_.read;
  const std::string answer = AskDescribed(line_, words_.errors, read.ask);
  const auto texts = SplitAnswer(answer, words_.line.separator);
  if (!texts || texts->size() != read.fields.size())
    line_.FailProtocol(read.ask, answer, fmt::format("{} fields", read.fields.size()));
  const bool shows = ShowsSomething(*texts, 0, read.valid);
  std::vector<double> numbers;
  for (const std::string& field : fields) {
    const auto at = static_cast<std::size_t>(std::ranges::find(read.fields, field) - read.fields.begin());
    numbers.push_back(shows ? NumberOf(*texts, at) : kNaN);
  }
  return numbers;
}

double DescribedSample::NumberOf(const std::vector<std::string>& texts, std::size_t field) {
  const ReadWords& read = words_.read;
  const std::string& text = texts[field];
  if (IsNothing(text, read.nothing)) return kNaN;
  const double to_SI = read.units.empty() ? 1.0 : UnitToSI(read.units[field], words_.name);
  const auto number_SI = ParseInUnit(text, to_SI);
  if (!number_SI) line_.FailProtocol(read.ask, text, "a number as " + read.fields[field]);
  return read.scale.empty() ? *number_SI : *number_SI * read.scale[field];
}

AutocollimatorReading DescribedAutocollimator::Read() {
  const std::vector<double> shown = sample_.Read({"x", "y"});
  return {shown[0], shown[1]};
}

void DescribedGoniometer::MoveTo(double yaw_rad, double tilt_rad) {
  const double to_SI = UnitToSI(words_.tilt_unit, words_.name);
  TellDescribed(
      line_, words_.errors,
      Filled(words_.tilt, {{"{yaw}", PrintInUnit(yaw_rad, to_SI)}, {"{tilt}", PrintInUnit(tilt_rad, to_SI)}}));
}

void DescribedIndexer::IndexTo(int tooth, double angle_rad) {
  try {
    Seat(tooth, angle_rad);
  } catch (const DeviceFault&) {
    SayStop();
    throw;
  }
}

void DescribedIndexer::SayStop() {
  if (words_.stop.empty()) return;
  try {
    line_.SayFirst(words_.stop);
    line_.Tell(words_.stop);
  } catch (const DeviceFault&) {  // why the seating failed is what is told
  }
}

void DescribedIndexer::Seat(int tooth, double angle_rad) {
  const auto end = std::chrono::steady_clock::now() + FromSeconds(move_timeout_s_);
  const std::string command =
      Filled(words_.move, {{"{tooth}", std::to_string(tooth)}, {"{deg}", PrintInUnit(angle_rad, units::deg)}});
  TellDescribed(line_, words_.errors, command, FromSeconds(move_timeout_s_));
  while (!words_.done.empty() && !IsSame(AskDescribed(line_, words_.errors, words_.done), words_.seated)) {
    if (std::chrono::steady_clock::now() > end)
      line_.Fail(FaultKind::kNotInPosition,
                 fmt::format("tooth {} is not seated after {:g} s", tooth, move_timeout_s_));
    std::this_thread::sleep_for(kLookAtIndexer);
  }
}

}  // namespace twinbench::hw
