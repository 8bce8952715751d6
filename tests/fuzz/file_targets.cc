#include <sqlite3.h>

#include <cctype>

#include "optics/height_map.h"
#include "optics/irradiance.h"
#include "optics/stl.h"
#include "tests/core/input_error.h"
#include "tests/fuzz/target.h"
#include "twin/benches/names.h"
#include "twin/core/run_record.h"

/// Files that are no text.
namespace twinbench::fuzz {
namespace {

/// Optics throws std::runtime_error for a file that is none. What leaves is our own mistake.
template <class Read>
void ReadOptics(std::string_view bytes, Read read) {
  const FileOfBytes file(bytes);
  try {
    read(file.Path());
  } catch (const std::runtime_error&) {
  }
}

void ReadExr(std::string_view bytes) {
  ReadOptics(bytes, [](const std::string& path) { optics::ReadIrradianceMaps(path); });
  ReadOptics(bytes, [](const std::string& path) { optics::ReadHeightMap(path); });
}

void ReadMesh(std::string_view bytes) {
  ReadOptics(bytes, [](const std::string& path) { optics::Validate(optics::ReadStl(path, 1e-3)); });
}

/// A folder with one record.
struct RecordFolder : TemporaryFolder {
  explicit RecordFolder(std::string_view bytes) { Write("record.sqlite", std::string(bytes)); }
};

void ReadAll(const RecordFolder& folder) {
  try {
    const auto record = RunRecord::Open(folder.path());
    record->finished();
    record->provenance();
    record->Readings();
    record->RawBlocks();
    record->Events();
    record->Calls();
    record->FailedAttempts();
  } catch (const InputError&) {
  } catch (const BenchError&) {
  }
}

void ReadRecord(std::string_view bytes) {
  ReadAll(RecordFolder(bytes));
}

/// Letters, digits and _ of a name in SQL.
std::string Word(std::string text) {
  std::erase_if(text, [](unsigned char c) { return std::isalnum(c) == 0 && c != '_'; });
  return text;
}

std::vector<std::string> MakeExr() {
  optics::IrradianceMap map;
  map.name = "psd_a.p1";
  map.width = map.height = 8;
  map.pitch_m = 10e-6;
  map.wavelength_m = 650e-9;
  map.power_W = 1e-3;
  map.order = 1;
  map.irradiance_W_m2.assign(64, 1.0f);
  const optics::HeightMap heights = {.width = 8, .height = 4, .pitch_m = 1e-4, .height_um = std::vector<float>(32, 0.01f)};
  const FileOfBytes irradiance(""), height("");
  optics::WriteIrradianceMaps(irradiance.Path(), {map});
  optics::WriteHeightMap(height.Path(), heights);
  return {BytesOfFile(irradiance.Path()), BytesOfFile(height.Path())};
}

/// A short run of the rotary bench, and an imported one.
std::vector<std::string> MakeRecord() {
  const RecordFolder folder("");
  std::filesystem::remove(folder.File("record.sqlite"));
  {
    const auto record = RunRecord::Create(folder.path(), {"fuzz", "twin", 1, "", kRotaryBench});
    for (int k = 0; k < 3; ++k) {
      Reading reading;
      reading.reading = k;
      reading.time = Time(std::chrono::seconds(k));
      reading.extra["odd"] = "1";
      reading.quantities.emplace_back("bar_um", 0.5);
      Acquisition block;
      block.n_samples = 4;
      block.raw.assign(16, 7);
      record->Called({});
      record->Append(reading, block);
    }
    record->AttemptFailed(3, Time{}, "stall", "the table stood still");
    record->AppendEvent(Time{}, "target", "homed");
    record->Finish();
  }
  return {BytesOfFile(folder.File("record.sqlite"))};
}

/// A record of ours in which somebody has changed values: lines of a table, a column, a row and the value in SQL's own words.
void ReadRecordValues(std::string_view bytes) {
  static const std::string whole = MakeRecord().front();
  const RecordFolder folder(whole);
  {
    sqlite3* database = nullptr;
    sqlite3_open(folder.File("record.sqlite").c_str(), &database);
    const auto run = [&](const std::string& sql) { sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr); };
    for (const char* table : {"provenance", "readings", "raw_blocks", "events", "calls", "attempts", "finished"})
      run(std::string("DROP TRIGGER IF EXISTS no_UPDATE_") + table);
    std::istringstream lines{std::string(bytes)};
    for (std::string table, column, row, value; lines >> table >> column >> row && std::getline(lines, value);) {
      sqlite3_stmt* update = nullptr;
      const std::string sql = "UPDATE \"" + Word(table) + "\" SET \"" + Word(column) + "\" = ?1 WHERE rowid = ?2";
      if (sqlite3_prepare_v2(database, sql.c_str(), -1, &update, nullptr) != SQLITE_OK) continue;
      value.erase(0, value.starts_with(' ') ? 1 : 0);
      sqlite3_bind_text(update, 1, value.c_str(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
      sqlite3_bind_text(update, 2, row.c_str(), static_cast<int>(row.size()), SQLITE_TRANSIENT);
      sqlite3_step(update);
      sqlite3_finalize(update);
    }
    sqlite3_close(database);
  }
  ReadAll(folder);
}

constexpr Target kFileTargets[] = {
    {"exr", ReadExr, "", MakeExr},
    {"stl", ReadMesh, ""},
    {"record", ReadRecord, "", MakeRecord},
    {"record_values", ReadRecordValues, ""},
};

}  // namespace

std::span<const Target> FileTargets() {
  return kFileTargets;
}

}  // namespace twinbench::fuzz
