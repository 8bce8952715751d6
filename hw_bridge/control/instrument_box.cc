#include "hw_bridge/control/instrument_box.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hw_bridge/control/described_devices.h"
#include "hw_bridge/control/scpi.h"
#include "twin/core/device_fault.h"
#include "twin/core/nearest_key.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr const char* kTimeField = "time_ns";
constexpr const char* kStatusField = "status";
constexpr const char* kIgnoredField = "ignored";
constexpr std::size_t kFetchHeader = 2;  // how many, some lost

ReadingColumn ColumnOf(const std::string& field, const std::vector<ReadingColumn>& columns, const std::string& where) {
  std::vector<std::string> known = {kTimeField, kStatusField, kIgnoredField};
  if (std::ranges::find(known, field) != known.end()) return {};
  for (const ReadingColumn& column : columns) {
    if (column.name == field) return column;
    known.push_back(column.name);
  }
  throw InputError(where, fmt::format("\"{}\" is no column that an instrument of this bench shows", field),
                   fmt::format("\"{}\"", Nearest(field, known)));
}

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
    if (!ColumnOf(words.fields[k], columns, file.where).number) continue;
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
    : line_(std::move(line)), words_(std::move(words)) {
  for (std::size_t k = 0; k < words_.fields.size(); ++k) {
    const std::string& name = words_.fields[k];
    fields_.push_back({name, ColumnOf(name, columns, words_.where), k < words_.scale.size() ? words_.scale[k] : 1.0});
    stamps = stamps || name == kTimeField;
  }
}

std::vector<std::string> InstrumentBox::Fields(const std::string& query, const std::string& answer) {
  const auto fields = SplitAnswer(answer, words_.separator);
  if (!fields || fields->empty()) line_.FailProtocol(query, answer, "fields with \"" + words_.separator + "\" between them");
  return *fields;
}

/// @return false if the text is not what the field holds.
bool InstrumentBox::Put(const Field& field, const std::string& text, Reading& sample) const {
  if (field.name == kIgnoredField) return true;
  if (field.name == kTimeField) {
    const auto time_ns = ParseWholeNumber(text);
    if (time_ns) sample.time = Time(Duration(*time_ns));
    return time_ns.has_value();
  }
  if (field.name == kStatusField) {
    const auto status = ReadingStatusOf(text);
    if (status) sample.status = *status;
    return status.has_value();
  }
  if (IsNothing(text, words_.nothing)) return true;
  const auto number = ParseNumber(text);
  if (!number) return false;
  return field.column.parse(sample, field.scale == 1.0 ? text : PrintInUnit(*number * field.scale, 1.0));
}

Reading InstrumentBox::Sample(const std::string& query, const std::vector<std::string>& texts, std::size_t from) {
  Reading sample;
  if (!ShowsSomething(texts, from, words_.valid)) {
    sample.status = ReadingStatus::kNoLight;
    return sample;
  }
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    if (!Put(fields_[k], texts[from + k], sample))
      line_.FailProtocol(query, texts[from + k], "a " + fields_[k].name);
  }
  return sample;
}

Reading InstrumentBox::Ask(const std::string& query) {
  const std::string answer = AskDescribed(line_, words_.errors, query);
  const std::vector<std::string> texts = Fields(query, answer);
  if (texts.size() != fields_.size()) line_.FailProtocol(query, answer, fmt::format("{} fields", fields_.size()));
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
                          texts.size() == kFetchHeader + static_cast<std::size_t>(*count) * fields_.size();
    if (!is_whole) line_.FailProtocol(words_.fetch, answer, "<samples>,<0 1>, and the fields of every sample");
    for (std::size_t k = 0; k < static_cast<std::size_t>(*count); ++k)
      waiting.push_back(Sample(words_.fetch, texts, kFetchHeader + k * fields_.size()));
    if (texts[1] != "0") return false;
    if (*count == 0) return true;
  }
}

void InstrumentBox::Merge(const Reading& sample, Reading& into) const {
  Reading source = sample;
  for (const Field& field : fields_) {
    if (!field.column.number || field.column.print(sample).empty()) continue;
    field.column.number(into) = field.column.number(source);
  }
  if (sample.status != ReadingStatus::kOk) into.status = sample.status;
  if (stamps) into.time = sample.time;
}

Reading InstrumentBoxes::Read() {
  return AllNow(&InstrumentBox::Read);
}

Reading InstrumentBoxes::Look() {
  return AllNow(&InstrumentBox::Look);
}

Reading InstrumentBoxes::AllNow(Reading (InstrumentBox::*show)()) {
  Reading all;
  all.time = clock_.Now();
  for (InstrumentBox& box : boxes_) box.Merge((box.*show)(), all);
  return all;
}

void InstrumentBoxes::Arm(int samples, int lines) {
  bool any = false;
  for (InstrumentBox& box : boxes_) {
    if (box.Latches()) box.Arm(samples, lines);
    any = any || box.Latches();
  }
  if (!any)
    throw DeviceFault(FaultKind::kRefused, "instruments",
                      "none of the bench file's can be latched");
}

LatchedSamples InstrumentBoxes::Latched() {
  LatchedSamples latched;
  for (InstrumentBox& box : boxes_) {
    if (box.Latches() && !box.Fetch()) latched.overrun = true;
  }
  if (!AllHaveOne()) return latched;
  std::vector<Reading> now;  // of those that cannot latch
  for (InstrumentBox& box : boxes_) now.push_back(box.Latches() ? Reading{} : box.Read());
  while (AllHaveOne()) latched.samples.push_back(TakeOne(now));
  return latched;
}

bool InstrumentBoxes::AllHaveOne() const {
  return std::ranges::all_of(boxes_, [](const InstrumentBox& b) { return !b.Latches() || !b.waiting.empty(); });
}

Reading InstrumentBoxes::TakeOne(const std::vector<Reading>& now) {
  Reading all;
  all.time = clock_.Now();
  for (std::size_t k = 0; k < boxes_.size(); ++k) {
    InstrumentBox& box = boxes_[k];
    box.Merge(box.Latches() ? box.waiting.front() : now[k], all);
    if (box.Latches()) box.waiting.pop_front();
  }
  return all;
}

}  // namespace twinbench::hw
