#include "tools/twinbench/measured_run.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <optional>

#include "twin/core/device_fault.h"
#include "twin/core/errors.h"
#include "twin/core/nearest_key.h"

namespace twinbench::tools {
namespace {

std::string UtcText(std::time_t now) {
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

void RequireSameScenario(const Scenario& scenario, const RunFolder& folder) {
  if (WriteScenario(LoadScenario(folder.scenario())) != WriteScenario(scenario)) {
    throw InputError(folder.path, "the run was begun with another scenario or other --set", "the same");
  }
}

/// A run beside a folder that is not there, begun and not finished, whose name differs by a slip of the finger: the one that
/// was probably meant. Empty: there is none.
std::string RunProbablyMeant(const RunFolder& folder) {
  namespace fs = std::filesystem;
  constexpr int kSlip = 2;
  const fs::path asked = fs::absolute(folder.path).lexically_normal();
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(asked.parent_path(), unreadable)) {
    const std::string name = entry.path().filename().string();
    if (EditDistance(asked.filename().string(), name) > kSlip || !fs::exists(entry.path() / "record.sqlite")) continue;
    if (!RunRecord::Open(entry.path().string())->finished()) return name;
  }
  return "";
}

/// @throws InputError if another folder was probably meant.
void BeginAnewInsteadOfResuming(const RunFolder& folder) {
  const std::string meant = RunProbablyMeant(folder);
  if (!meant.empty())
    throw InputError("--resume", "there is no run in " + folder.path,
                     "the folder of a run that was begun, perhaps " + meant + "; without --resume a new one is");
  fmt::print("there is no run in {} to resume; a new one begins\n", folder.path);
  std::fflush(stdout);
}

constexpr const char* kClock = "clock";

/// What the computer's clocks showed at Time 0; of an old record UTC alone. Nothing: it is not of a real bench.
std::optional<ClockMark> BeginOf(const RunRecord& record) {
  for (const RecordedEvent& event : record.Events()) {
    if (event.device == kClock) return ParseClockMark(event.text);
  }
  std::tm utc{};
  if (!strptime(record.provenance().clock_origin_utc.c_str(), "%Y-%m-%dT%H:%M:%SZ", &utc)) return {};
  return ClockMark{"", 0.0, static_cast<double>(timegm(&utc))};
}

}  // namespace

RunFolder FolderOf(const MeasureOptions& options) {
  if (options.folder.empty()) throw InputError("measure", "there is no -o", "-o DIR, a folder for the run");
  return {options.folder};
}

BegunRun TakeUpIfAsked(const MeasureOptions& options, const Scenario& scenario, const RunFolder& folder) {
  const bool is_begun = std::filesystem::exists(folder.record());
  if (!options.resume) {
    if (is_begun) throw InputError(folder.path, "there is a run already", "another folder, or --resume to go on with it");
    RequireRoomFor(folder, scenario);
    return {};
  }
  if (!std::filesystem::exists(folder.path)) BeginAnewInsteadOfResuming(folder);
  if (!is_begun) {  // it ended before there was anything to keep
    if (std::filesystem::exists(folder.scenario())) RequireSameScenario(scenario, folder);
    return {};
  }
  BegunRun begun{RunRecord::Continue(folder.path), {}};
  if (std::filesystem::exists(folder.scenario()))
    RequireSameScenario(scenario, folder);
  else  // the program ended between making the record and writing it
    begun.record->WriteBeside(kScenarioFile, WriteScenario(scenario));
  begun.readings = begun.record->Readings();
  return begun;
}

std::unique_ptr<RunRecord> BeginRun(const Scenario& scenario, const RunFolder& folder, const std::string& kind,
                                    const std::string& identity) {
  const std::string origin = kind == "hardware" ? UtcText(std::time(nullptr)) : "";
  auto record =
      RunRecord::Create(folder.path, {TWINBENCH_VERSION, identity, scenario.seed, origin, scenario.bench});
  if (!origin.empty()) record->AppendEvent(Time{}, kClock, TextOf(ClockMarkNow()));
  record->WriteBeside(kScenarioFile, WriteScenario(scenario));
  return record;
}

Duration SinceBegin(const BegunRun& begun, const ClockMark& now) {
  if (!begun.record) return {};
  const Time last = begun.readings.empty() ? Time{} : begun.readings.back().time;
  const std::optional<ClockMark> begin = BeginOf(*begun.record);
  if (!begin) return last.time_since_epoch();
  const Elapsed elapsed = Between(*begin, now);
  if (!elapsed.note.empty()) {
    begun.record->AppendEvent(last, kClock, elapsed.note);
    fmt::print(stderr, "twinbench: {}\n", elapsed.note);
  }
  return std::max<Duration>(last.time_since_epoch(), elapsed.time);
}

bool MayHaveLostZeros(const BegunRun& begun) {
  if (!begun.record) return false;
  return std::ranges::any_of(begun.record->FailedAttempts(), [&](const FailedAttempt& failed) {
    const bool may_be_others = failed.fault == FaultName(FaultKind::kImplausible) && failed.text.find("zero") != std::string::npos;
    return failed.reading == static_cast<int>(begun.readings.size()) &&
           (may_be_others || failed.text.find("lost its origin") != std::string::npos);
  });
}

void TakeUp(const BegunRun& begun, const std::string& identity) {
  const std::string source = begun.record->provenance().source;
  if (source != identity)
    throw BenchError(fmt::format("the run was begun on \"{}\" and this is \"{}\"", source, identity));
  for (const FailedAttempt& failed : begun.record->FailedAttempts())
    if (failed.fault == FaultName(FaultKind::kChanged))
      throw InputError("--resume", failed.text, "another folder, for a run without the readings that are kept in this one");
  const int kept = static_cast<int>(begun.readings.size());
  const Time last = begun.readings.empty() ? Time{} : begun.readings.back().time;
  begun.record->AttemptFailed(kept, last, "interrupted", "the program ended; resumed");
  fmt::print(stderr, "twinbench: {} readings are kept; going on behind them\n", kept);
}

}  // namespace twinbench::tools
