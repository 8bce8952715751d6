#include "hw_bridge/control/instrument.h"

#include <fmt/format.h>

#include <algorithm>

#include "hw_bridge/control/described_devices.h"
#include "twin/core/device_fault.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {
namespace {

constexpr const char* kTimeField = "time_ns";
constexpr const char* kStatusField = "status";
constexpr const char* kIgnoredField = "ignored";

}  // namespace

ReadingColumn InstrumentColumn(const std::string& name, const std::vector<ReadingColumn>& columns,
                               const std::string& where) {
  std::vector<std::string> known = {kTimeField, kStatusField, kIgnoredField};
  if (std::ranges::find(known, name) != known.end()) return {};
  for (const ReadingColumn& column : columns) {
    if (column.name == name) return column;
    known.push_back(column.name);
  }
  throw InputError(where, fmt::format("\"{}\" is no column that an instrument of this bench shows", name),
                   fmt::format("\"{}\"", Nearest(name, known)));
}

Instrument::Instrument(const std::vector<std::string>& names, const std::vector<double>& scale,
                       const std::vector<ReadingColumn>& columns, const std::string& where) {
  for (std::size_t k = 0; k < names.size(); ++k) {
    fields_.push_back({names[k], InstrumentColumn(names[k], columns, where), k < scale.size() ? scale[k] : 1.0});
    stamps = stamps || names[k] == kTimeField;
  }
}

bool Instrument::Put(const Field& field, const std::string& text, const std::vector<std::string>& nothing,
                     Reading& sample) {
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
  if (IsNothing(text, nothing)) return true;
  const auto number = ParseNumber(text);
  if (!number) return false;
  return field.column.parse(sample, field.scale == 1.0 ? text : PrintInUnit(*number * field.scale, 1.0));
}

void Instrument::Merge(const Reading& sample, Reading& into) const {
  Reading source = sample;
  for (const Field& field : fields_) {
    if (!field.column.number || field.column.print(sample).empty()) continue;
    field.column.number(into) = field.column.number(source);
  }
  if (sample.status != ReadingStatus::kOk) into.status = sample.status;
  if (stamps) into.time = sample.time;
}

Reading Instruments::Read() {
  return AllNow(&Instrument::Read);
}

Reading Instruments::Look() {
  return AllNow(&Instrument::Look);
}

Reading Instruments::AllNow(Reading (Instrument::*show)()) {
  Reading all;
  all.time = clock_.Now();
  for (const auto& one : all_) one->Merge((one.get()->*show)(), all);
  return all;
}

void Instruments::Arm(int samples, int lines) {
  bool any = false;
  for (const auto& one : all_) {
    if (one->Latches()) one->Arm(samples, lines);
    any = any || one->Latches();
  }
  if (!any) throw DeviceFault(FaultKind::kRefused, "instruments", "none of the bench file's can be latched");
}

LatchedSamples Instruments::Latched() {
  LatchedSamples latched;
  for (const auto& one : all_) {
    if (one->Latches() && !one->Fetch()) latched.overrun = true;
  }
  if (!AllHaveOne()) return latched;
  std::vector<Reading> now;  // of those that cannot latch
  for (const auto& one : all_) now.push_back(one->Latches() ? Reading{} : one->Read());
  while (AllHaveOne()) latched.samples.push_back(TakeOne(now));
  return latched;
}

bool Instruments::AllHaveOne() const {
  return std::ranges::all_of(all_, [](const auto& one) { return !one->Latches() || !one->waiting.empty(); });
}

Reading Instruments::TakeOne(const std::vector<Reading>& now) {
  Reading all;
  all.time = clock_.Now();
  for (std::size_t k = 0; k < all_.size(); ++k) {
    Instrument& one = *all_[k];
    one.Merge(one.Latches() ? one.waiting.front() : now[k], all);
    if (one.Latches()) one.waiting.pop_front();
  }
  return all;
}

}  // namespace twinbench::hw
