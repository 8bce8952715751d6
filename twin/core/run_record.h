#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "twin/core/devices.h"
#include "twin/core/reading.h"
#include "twin/core/run_log.h"

namespace twinbench {

/// Where a run came from; written once, when the record is made.
struct Provenance {
  std::string program_version;
  std::string source;  // what answered: "twin", "iio:...", "import: readings.csv"
  std::uint64_t seed = 0;
  std::string clock_origin_utc;  // ISO 8601 of Time 0; empty for the twin
  std::string bench;             // the scenario's bench; empty if an old record has neither scenario nor readings
};

struct RawBlock {
  int reading = 0;
  int channels = 0;
  std::vector<std::int16_t> samples;  // scan by scan
  BlockStamp stamp = {};
  int saturated_mask = 0;
};

/// An attempt at a reading that came to nothing.
struct FailedAttempt {
  int reading = 0;
  int attempt = 0;  // of this reading, from 1
  Time time{};
  std::string fault, text;
};

struct RecordedEvent {
  Time time{};
  std::string device;
  std::string text;
};

/// The record of a run in DIR/record.sqlite: insert-only, one transaction a reading, WAL with synchronous FULL, so
/// that it opens after kill -9 or power loss with every reading that Append returned for. Digests of every row and of the files
/// beside it (docs/record.md) are kept in the same transactions.
class RunRecord : public ReadingSink, public RunLog {
 public:
  /// Makes DIR and an empty record in it.
  /// The record is this program's to write, until it goes.
  /// @throws InputError if DIR already holds a record; BenchError if the disk refuses.
  static std::unique_ptr<RunRecord> Create(const std::string& directory, const Provenance& provenance);
  /// An empty record that is nowhere on a disk and goes with the object: for one run of thousands.
  static std::unique_ptr<RunRecord> CreateInMemory(const Provenance& provenance);
  /// Opens a record to be read, also one that another program is still writing, and one that may not be written.
  /// @throws InputError if there is no record, it is not one of ours, it is damaged, or something of it or a file beside it is
  ///         not as it was written.
  static std::unique_ptr<RunRecord> Open(const std::string& directory);
  /// Opens a record to be written on.
  /// @throws InputError as Open, and if another program is writing it.
  static std::unique_ptr<RunRecord> Continue(const std::string& directory);
  /// Whether some program is writing the record of DIR now.
  static bool HasWriter(const std::string& directory);

  ~RunRecord() override;
  /// From here on a reading is kept whatever becomes of this program, and against a power failure with all others by
  /// Finish: for a run that can be made again, which would wait for the disk most of its time.
  void SpareTheDisk();
  /// From here on `listener` hears of every reading once it is safe, on the thread that appends it. It must not throw.
  void TellOf(std::function<void(const Reading&)> listener) { listener_ = std::move(listener); }
  /// @throws BenchError if the disk refuses or the reading's number is taken; the record is then as it was before.
  void Append(const Reading& reading, const Acquisition& taken) override;
  void AppendAll(const std::vector<Reading>& readings) override;
  void Called(const DeviceCall& call) override;
  void ForgetCalls() override;
  void AttemptFailed(int reading, Time time, const std::string& fault, const std::string& text) override;
  /// Keeps what a device did or an operator noted.
  void AppendEvent(Time time, const std::string& device, const std::string& text) override;
  /// Room for kReserve_B and twice the largest block: the write-ahead log holds everything a second time.
  void RequireRoom() override;
  /// Writes a file beside the record, at once, and keeps its digest: "scenario.toml", "truth.json", "results.json". Written again, it
  /// has another one.
  /// @throws BenchError if the disk refuses.
  void WriteBeside(const std::string& name, const std::string& text);
  /// Marks the run complete; without it the run is known to be unfinished.
  void Finish();

  bool finished() const;
  Provenance provenance() const;
  /// In the order in which they were appended, to the same bits (but -0.0, which comes back as 0.0).
  std::vector<Reading> Readings() const;
  std::vector<RawBlock> RawBlocks() const;
  std::vector<RecordedEvent> Events() const;
  /// What was asked of the devices on the way to the readings that are kept, in order.
  std::vector<DeviceCall> Calls() const;
  std::vector<FailedAttempt> FailedAttempts() const;

 private:
  struct Database;
  explicit RunRecord(std::unique_ptr<Database> database);
  std::unique_ptr<Database> database_;
  std::function<void(const Reading&)> listener_;
};

}  // namespace twinbench
