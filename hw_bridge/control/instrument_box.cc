#include "hw_bridge/control/instrument_box.h"

#include <fmt/format.h>

#include "hw_bridge/control/described_devices.h"
#include "hw_bridge/control/scpi.h"
#include "twin/core/device_fault.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr std::size_t kFetchHeader = 2;  // how many, some lost

/// The column of a field for which the bench file names none.
std::string UsualColumn(const std::string& field) {
  if (field == "x") return "autocollimator_x_arcsec";
  if (field == "y") return "autocollimator_y_arcsec";
  return field == "temperature" ? kTemperatureColumn : field;
}

}  // namespace

InstrumentWords WithDialogue(const InstrumentWords& file, const DialogueWords& dialogue,
                             const std::vector<ReadingColumn>& columns) {
  const ReadWords& read = dialogue.read;
  const std::size_t fields = read.fields.size();
  if (!file.fields.empty() && file.fields.size() != fields)
    throw InputError(file.where, fmt::format("{} fields for an answer of {} by dialogue {}", file.fields.size(), fields, dialogue.name),
                     "one a field of the dialogue, or none where its own are columns");
  if (!file.scale.empty() && file.scale.size() != fields)
    throw InputError(file.where, fmt::format("{} scales for an answer of {} fields by dialogue {}", file.scale.size(), fields,
                                             dialogue.name),
                     "one a field of the dialogue");
  InstrumentWords words = file;
  words.scale.resize(fields, 1.0);
  words.fields.clear();
  for (std::size_t k = 0; k < fields; ++k) {
    words.fields.push_back(file.fields.empty() ? UsualColumn(read.fields[k]) : file.fields[k]);
    if (!InstrumentColumn(words.fields[k], columns, file.where).number) continue;
    if (!read.units.empty()) words.scale[k] *= ScaleToColumn(read.units[k], words.fields[k], file.where);
    if (!read.scale.empty()) words.scale[k] *= read.scale[k];
  }
  words.read = read.ask;
  words.look = read.look;
  words.arm = dialogue.arm;
  words.fetch = dialogue.fetch;
  words.separator = dialogue.line.separator;
  words.valid = read.valid;
  words.nothing = read.nothing;
  words.errors = dialogue.errors;
  return words;
}

InstrumentBox::InstrumentBox(DeviceLine line, InstrumentWords words, const std::vector<ReadingColumn>& columns)
    : Instrument(words.fields, words.scale, columns, words.where),
      line_(std::move(line)),
      words_(std::move(words)) {}

std::vector<std::string> InstrumentBox::Fields(const std::string& query, const std::string& answer) {
  const auto fields = SplitAnswer(answer, words_.separator);
  if (!fields || fields->empty()) line_.FailProtocol(query, answer, "fields with \"" + words_.separator + "\" between them");
  return *fields;
}

Reading InstrumentBox::Sample(const std::string& query, const std::vector<std::string>& texts, std::size_t from) {
  Reading sample;
  if (!ShowsSomething(texts, from, words_.valid)) {
    sample.status = ReadingStatus::kNoLight;
    return sample;
  }
  for (std::size_t k = 0; k < fields().size(); ++k) {
    if (!Put(fields()[k], texts[from + k], words_.nothing, sample))
      line_.FailProtocol(query, texts[from + k], "a " + fields()[k].name);
  }
  return sample;
}

Reading InstrumentBox::Ask(const std::string& query) {
  const std::string answer = AskDescribed(line_, words_.errors, query);
  const std::vector<std::string> texts = Fields(query, answer);
  if (texts.size() != fields().size()) line_.FailProtocol(query, answer, fmt::format("{} fields", fields().size()));
  return Sample(query, texts, 0);
}

void InstrumentBox::Arm(int samples, int lines) {
  waiting.clear();
  if (lines > 0 && words_.arm.find("{lines}") == std::string::npos)
    line_.Fail(FaultKind::kRefused, "latches at triggers only: its `arm` has no place for {lines}");
  TellDescribed(line_, words_.errors, Filled(words_.arm, {{"{samples}", std::to_string(samples)}, {"{lines}", std::to_string(lines)}}));
}

/// One answer holds no more than fits in a line: it is asked until there are no more.
bool InstrumentBox::Fetch() {
  for (;;) {
    const std::string answer = line_.Ask(words_.fetch);
    const std::vector<std::string> texts = Fields(words_.fetch, answer);
    const auto count = ParseWholeNumber(texts[0]);
    const bool is_whole = count && *count >= 0 && texts.size() >= kFetchHeader &&
                          texts.size() == kFetchHeader + static_cast<std::size_t>(*count) * fields().size();
    if (!is_whole) line_.FailProtocol(words_.fetch, answer, "<samples>,<0 1>, and the fields of every sample");
    for (std::size_t k = 0; k < static_cast<std::size_t>(*count); ++k)
      waiting.push_back(Sample(words_.fetch, texts, kFetchHeader + k * fields().size()));
    if (texts[1] != "0") return false;
    if (*count == 0) return true;
  }
}

}  // namespace twinbench::hw
