#include "twin/core/run_record.h"

#include <sqlite3.h>

#include "tests/core/any_reading.h"
#include "tests/core/input_error.h"
#include "tests/support/kept_text.h"
#include "twin/benches/names.h"
#include "twin/core/kept_readings.h"

namespace twinbench {
namespace {

using testing::ElementsAre, testing::FieldsAre;

Provenance AnyProvenance() {
  return {"0.1.0", "twin", 18446744073709551615u, "2026-01-02T03:04:05Z", kRotaryBench};
}

/// Every fifth has a column that we do not know, every third a quantity without a field of its own, every seventh no numbers.
Reading ReadingOf(int number) {
  Reading r = AnyReading(number);
  if (number % 7 == 6) {
    r.status = ReadingStatus::kClippedSpot;
    r.mean_V.fill(kNaN);
    r.std_V.fill(kNaN);
  }
  if (number % 3 == 0) r.quantities = {{"bar_um", 1.0 / (number + 3) * 1e-6}};
  if (number % 5 == 0) r.extra = {{"note", "a \"quoted\" \xC3\xA9"}};
  return r;
}

void ExpectReadingsOf(const std::vector<Reading>& readings, std::size_t count) {
  ASSERT_EQ(readings.size(), count);
  for (std::size_t i = 0; i < count; ++i) ExpectSame(readings[i], ReadingOf(static_cast<int>(i)));
}

Acquisition BlockOf(std::vector<std::int16_t> raw) {
  Acquisition block;
  block.raw = std::move(raw);
  return block;
}

/// Carries out SQL on a record behind its back.
std::string Sql(const std::string& directory, const char* sql) {
  sqlite3* handle = nullptr;
  sqlite3_open((directory + "/record.sqlite").c_str(), &handle);
  const int code = sqlite3_exec(handle, sql, nullptr, nullptr, nullptr);
  const std::string message = code == SQLITE_OK ? "" : sqlite3_errmsg(handle);
  sqlite3_close(handle);
  return message;
}

std::string OpenError(const std::string& directory) { return MessageOf([&] { RunRecord::Open(directory); }); }

TEST(RunRecord, GivesBackWhatItWasGivenAlsoAReadingWithoutNumbers) {
  const TemporaryFolder folder;
  const std::string directory = folder.File("runs/first");
  {
    const auto record = RunRecord::Create(directory, AnyProvenance());
    for (int i = 0; i < 40; ++i) record->Append(ReadingOf(i), {});
    EXPECT_EQ(record->Readings().size(), 40u);
  }
  const auto record = RunRecord::Open(directory);
  ExpectReadingsOf(record->Readings(), 40);
  EXPECT_THAT(record->provenance(), FieldsAre("0.1.0", "twin", 18446744073709551615u, "2026-01-02T03:04:05Z", kRotaryBench));
}

TEST(KeptReadings, AreThoseOfARecordToTheSameBits) {
  Reading odd = ReadingOf(1);
  odd.target_rad = -0.0;
  odd.measured_rad = -0.0;
  odd.quantities = {{"radius_m", 0.15}, {"feed_m_s", 0.1}, {"bar_m", kNaN}};
  const auto record = RunRecord::CreateInMemory(AnyProvenance()), other = RunRecord::CreateInMemory(AnyProvenance());
  KeptReadings kept;
  for (const Reading& reading : {ReadingOf(0), odd, ReadingOf(2)}) {
    record->Append(reading, {});
    kept.Append(reading, {});
  }
  const std::vector<Reading> of_record = record->Readings(), all = kept.Take();
  EXPECT_TRUE(other->Readings().empty()) << "two records in memory are one";
  ASSERT_EQ(all.size(), of_record.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(all[k].quantities, of_record[k].quantities);
    for (const auto number : {&Reading::target_rad, &Reading::reference_rad, &Reading::measured_rad, &Reading::temperature_degC})
      EXPECT_TRUE(std::isnan(all[k].*number) || std::bit_cast<std::uint64_t>(all[k].*number) == std::bit_cast<std::uint64_t>(of_record[k].*number));
  }
}

TEST(RunRecord, KeepsEventsAndRawBlocksWithWhereTheyStoodInTheConvertersCount) {
  const TemporaryFolder folder;
  const auto record = RunRecord::Create(folder.path(), AnyProvenance());
  Acquisition block = BlockOf({1, -2, 32767, -32768});
  block.stamp = {11, 22, 33, 44};
  block.saturated_mask = 5;
  record->Append(ReadingOf(4), {});
  record->Append(ReadingOf(5), block);
  record->AppendEvent(Time(Duration(20)), "target", "in position");
  record->AppendEvent(Time(Duration(10)), "operator", "lamp off");
  EXPECT_THAT(record->RawBlocks(), ElementsAre(FieldsAre(5, kChannels, ElementsAre(1, -2, 32767, -32768), FieldsAre(11, 22, 33, 44), 5)));
  EXPECT_THAT(record->Events(), ElementsAre(FieldsAre(Time(Duration(10)), "operator", "lamp off"),
                                            FieldsAre(Time(Duration(20)), "target", "in position")));
}

TEST(RunRecord, CanBeContinuedAndIsUnfinishedUntilItIsFinished) {
  const TemporaryFolder folder;
  RunRecord::Create(folder.path(), AnyProvenance())->Append(ReadingOf(0), {});
  const auto record = RunRecord::Open(folder.path());
  EXPECT_FALSE(record->finished());
  record->Append(ReadingOf(1), {});
  record->Finish();
  record->Finish();
  EXPECT_TRUE(record->finished());
  EXPECT_TRUE(RunRecord::Open(folder.path())->finished());
  ExpectReadingsOf(RunRecord::Open(folder.path())->Readings(), 2);
}

TEST(RunRecord, CannotBeChangedAfterwards) {
  const TemporaryFolder folder;
  {
    const auto record = RunRecord::Create(folder.path(), AnyProvenance());
    record->Append(ReadingOf(0), BlockOf({1, 2, 3, 4}));
    record->AppendEvent(Time{}, "target", "home");
    record->Finish();
  }
  for (const char* sql :
       {"UPDATE readings SET psd_a_x_V = 0", "DELETE FROM readings", "DELETE FROM raw_blocks",
        "UPDATE events SET text = ''", "UPDATE provenance SET seed = '1'", "DELETE FROM finished"})
    EXPECT_EQ(Sql(folder.path(), sql), "a run record is insert-only") << sql;
  EXPECT_EQ(RunRecord::Open(folder.path())->Readings().size(), 1u);
}

TEST(RunRecord, SaysWhenTheDiskRefusesAndIsMadeOverTheRestsOfACreationThatWasKilled) {
  const TemporaryFolder folder;
  folder.Write("file", "x");
  EXPECT_THROW(RunRecord::Create(folder.File("file"), AnyProvenance()),
               InputError);  // a wrong name, not a bad disk
  EXPECT_THROW(RunRecord::Create(folder.File("file/inside"), AnyProvenance()), BenchError);
  const TemporaryFolder rests;
  rests.Write("record.sqlite.part", "half a file");
  RunRecord::Create(rests.path(), AnyProvenance())->Finish();
  EXPECT_TRUE(RunRecord::Open(rests.path())->finished());
  EXPECT_FALSE(std::filesystem::exists(rests.File("record.sqlite.part")));
}

TEST(RunRecord, MustBeThereAndOfThisProgramAndVersionToBeOpenedAndIsNotMadeOverAnother) {
  const TemporaryFolder folder;
  const std::string path = folder.File("record.sqlite");
  std::vector<std::string> said = {OpenError(folder.path())};
  folder.Write("record.sqlite", "");
  said.push_back(OpenError(folder.path()));
  Sql(folder.path(), "CREATE TABLE readings(x)");
  said.push_back(OpenError(folder.path()));
  folder.Write("record.sqlite", "reading,time_s,setup\n0,1,2\n");
  said.push_back(OpenError(folder.path()));
  std::filesystem::remove(path);
  RunRecord::Create(folder.path(), AnyProvenance());
  said.push_back(MessageOf([&] { RunRecord::Create(folder.path(), AnyProvenance()); }));
  Sql(folder.path(), "PRAGMA user_version = 99");
  said.push_back(OpenError(folder.path()));
  for (const std::string& text : said) EXPECT_KEPT(text);
}

/// Carries out SQL that the record's triggers would refuse.
void Force(const std::string& directory, const std::string& sql) {
  for (const char* table : {"provenance", "readings", "raw_blocks", "events", "finished", "calls", "attempts", "digests", "files"})
    for (const char* change : {"UPDATE", "DELETE"}) Sql(directory, fmt::format("DROP TRIGGER no_{}_{}", change, table).c_str());
  EXPECT_EQ(Sql(directory, sql.c_str()), "") << sql;
}

/// Six readings with a block and two calls each, an event, a failed attempt and files.
void MakeSealed(const TemporaryFolder& folder) {
  const auto record = RunRecord::Create(folder.path(), AnyProvenance());
  record->WriteBeside("scenario.toml", "first");
  record->WriteBeside("scenario.toml", "as it stays");
  for (int k = 0; k < 6; ++k) {
    for (const char* answer : {"1", "2"}) record->Called({Time(Duration(k)), "target", "state", answer});
    record->Append(ReadingOf(k), BlockOf({1, 2, 3, 4}));
  }
  record->AttemptFailed(6, Time{}, "gap", "3 scans");
  record->AppendEvent(Time{}, "operator", "lamp off");
  record->Finish();
}

TEST(RunRecord, SaysWhatIsAlteredMissingOrAddedSinceItWasWritten) {
  for (const char* sql :
       {"UPDATE readings SET psd_a_x_V = psd_a_x_V * (1 + 1e-15) WHERE reading = 3", "DELETE FROM readings WHERE reading IN (3, 4)",
        "DELETE FROM readings WHERE reading = 5", "UPDATE readings SET id = 50 WHERE reading = 2",
        "UPDATE raw_blocks SET samples = x'0100' WHERE reading = 1", "UPDATE calls SET answer = '3' WHERE id = 4",
        "DELETE FROM events", "INSERT INTO events VALUES(NULL, 0, 'operator', 'lamp on')", "UPDATE attempts SET fault = 'stuck'",
        "UPDATE provenance SET seed = '2'", "UPDATE files SET sha256 = ''", "DELETE FROM finished",
        "DELETE FROM digests WHERE id = 9", "DELETE FROM digests", "DROP TABLE digests",
        "DELETE FROM digests WHERE id > 9; DELETE FROM readings WHERE reading > 1; DELETE FROM raw_blocks WHERE reading > 1"}) {
    const TemporaryFolder folder;
    MakeSealed(folder);
    ASSERT_EQ(RunRecord::Open(folder.path())->Readings().size(), 6u);
    Force(folder.path(), sql);
    EXPECT_KEPT(OpenError(folder.path()));
  }
}

TEST(RunRecord, SaysWhenAFileBesideItIsNoneThatWasWrittenWithItAndReadsOneThatIsMissing) {
  const TemporaryFolder folder;
  MakeSealed(folder);
  folder.Write("scenario.toml", "first");
  EXPECT_NO_THROW(RunRecord::Open(folder.path())) << "the power failed behind the digest of the second";
  folder.Write("scenario.toml", "as it stays\n");
  EXPECT_KEPT(OpenError(folder.path()));
  std::filesystem::remove(folder.File("scenario.toml"));
  EXPECT_NO_THROW(RunRecord::Open(folder.path())) << "whoever needs it says so";
}

TEST(RunRecord, AgreesWithAScenarioThatHasNoDigestOrSaysSo) {
  const TemporaryFolder folder;
  RunRecord::Create(folder.path(), {"0.1.0", "twin", 7, "", kHobBench});
  for (const char* fits : {"bench = \"hob_transmission\"\nseed = 7\n", "bench = \"hob_transmission\"\n[laser]  # of another version\n"}) {
    folder.Write("scenario.toml", fits);
    EXPECT_NO_THROW(RunRecord::Open(folder.path())) << fits;
  }
  for (const char* other : {"bench = \"hob_transmission\"\nseed = 8\n", "bench = \"encoder_comparison\"\nseed = 7\n"}) {
    folder.Write("scenario.toml", other);
    EXPECT_KEPT(OpenError(folder.path()));
  }
}

constexpr int kNow = 6;

/// Takes from a record what later versions brought.
void MakeVersion(int version, const std::string& folder) {
  const std::map<int, std::vector<const char*>> brought = {
      {2, {"readings DROP COLUMN measured_rad", "readings DROP COLUMN velocity_rad_s"}},
      {3,
       {"raw_blocks DROP COLUMN first_scan", "raw_blocks DROP COLUMN device_ns", "raw_blocks DROP COLUMN host_ns",
        "raw_blocks DROP COLUMN utc_ns", "raw_blocks DROP COLUMN saturated_mask"}},
      {4, {"readings DROP COLUMN head_rad", "readings DROP COLUMN interferometer_rad"}},
      {5, {"provenance DROP COLUMN bench_name", "readings DROP COLUMN quantities"}},
      {6, {}}};
  for (int later = kNow; later > version; --later) {
    for (const std::string change : brought.at(later))
      EXPECT_EQ(Sql(folder, ("ALTER TABLE " + change).c_str()), "");
  }
  EXPECT_EQ(Sql(folder, version < 3 ? "DROP TABLE calls; DROP TABLE attempts" : ""), "");
  EXPECT_EQ(Sql(folder, "DROP TABLE digests; DROP TABLE files"), "");
  EXPECT_EQ(Sql(folder, ("PRAGMA user_version = " + std::to_string(version)).c_str()), "");
}

TEST(RunRecord, OfEveryEarlierVersionIsBroughtUpToDate) {
  for (int version = 1; version < kNow; ++version) {
    const TemporaryFolder folder;
    RunRecord::Create(folder.path(), AnyProvenance())->Append(ReadingOf(0), BlockOf({1, 2, 3, 4}));
    MakeVersion(version, folder.path());
    const auto record = RunRecord::Continue(folder.path());
    Reading reading = ReadingOf(1);
    reading.head_rad = 2.5;
    reading.interferometer_rad = 1e-5;
    record->Append(reading, {});
    EXPECT_EQ(record->Readings().at(0).target_rad, ReadingOf(0).target_rad) << version;
    EXPECT_EQ(std::isnan(record->Readings().at(0).measured_rad), version < 2) << "not known then";
    EXPECT_TRUE(version >= 4 || std::isnan(record->Readings().at(0).head_rad)) << "not known then";
    EXPECT_EQ(record->RawBlocks().at(0).stamp.first_scan, -1) << "not known then";
    ExpectSame(record->Readings().at(1), reading);
    record->AttemptFailed(1, Time{}, "gap", "3 scans");
    EXPECT_EQ(record->FailedAttempts().size(), 1u);
    EXPECT_EQ(Sql(folder.path(), "DELETE FROM attempts"), "a run record is insert-only");
    Force(folder.path(), "UPDATE readings SET setup = 9 WHERE reading = 0");
    EXPECT_THAT(OpenError(folder.path()), testing::HasSubstr("reading 0 altered")) << "since it was brought up to date";
  }
}

TEST(RunRecord, OfTheVersionWithoutTheBenchTakesItFromTheScenario) {
  const TemporaryFolder folder;
  RunRecord::Create(folder.path(), AnyProvenance())->Append(ReadingOf(0), {});
  MakeVersion(4, folder.path());
  folder.Write("scenario.toml", "bench = \"hob_transmission\"\n[laser]  # of a program that is to come\n");
  EXPECT_EQ(RunRecord::Open(folder.path())->provenance().bench, kHobBench);
  EXPECT_EQ(RunRecord::Open(folder.path())->provenance().bench, kHobBench) << "kept";
  EXPECT_EQ(Sql(folder.path(), "UPDATE provenance SET bench_name = 'x'"), "a run record is insert-only");
}

TEST(RunRecord, OfTheVersionWithoutTheBenchTellsItByItsReadings) {
  Reading rotary = ReadingOf(1), encoder, hob, turntable;
  rotary.autocollimator_yaw_rad = rotary.autocollimator_tilt_rad = 1e-5;  // of a calibration
  encoder.reference_rad = encoder.measured_rad = 1.0;
  hob = encoder;
  hob.head_rad = 2.0;
  turntable.target_rad = turntable.reference_rad = 1.0;
  turntable.autocollimator_yaw_rad = turntable.autocollimator_tilt_rad = 1e-5;
  const std::vector<std::pair<Reading, std::string>> cases = {
      {rotary, kRotaryBench}, {encoder, kEncoderBench}, {turntable, kTurntableBench}, {hob, kHobBench}};
  for (const auto& [reading, bench] : cases) {
    const TemporaryFolder folder;
    RunRecord::Create(folder.path(), AnyProvenance())->Append(reading, {});
    MakeVersion(4, folder.path());
    EXPECT_EQ(RunRecord::Open(folder.path())->provenance().bench, bench);
  }
  const TemporaryFolder empty;
  RunRecord::Create(empty.path(), AnyProvenance());
  MakeVersion(4, empty.path());
  EXPECT_EQ(RunRecord::Open(empty.path())->provenance().bench, "") << "there is nothing to tell it by";
}

TEST(RunRecord, KeepsManyReadingsInOneTransactionOrNoneAndTellsOfEveryOneThatIsSafeAndOfNoOther) {
  const TemporaryFolder folder;
  const auto record = RunRecord::Create(folder.path(), AnyProvenance());
  std::vector<int> heard;
  record->TellOf([&](const Reading& r) {
    heard.push_back(r.reading);
    EXPECT_EQ(RunRecord::Open(folder.path())->Readings().back().reading, record->Readings().back().reading)
        << "another program sees it too";
  });
  record->Append(ReadingOf(0), BlockOf({1, 2, 3, 4}));
  EXPECT_THROW(record->Append(ReadingOf(0), BlockOf({1, 2, 3, 4})), BenchError) << "a number is taken";
  EXPECT_EQ(record->RawBlocks().size(), 1u) << "of the one that was refused nothing is kept";
  record->AppendAll({ReadingOf(1), ReadingOf(2)});
  EXPECT_THROW(record->AppendAll({ReadingOf(3), ReadingOf(1)}), BenchError);
  ExpectReadingsOf(record->Readings(), 3);
  record->AppendAll({ReadingOf(3)});
  EXPECT_THAT(heard, ElementsAre(0, 1, 2, 3));
}

TEST(RunRecord, KeepsCallsWithTheReadingThatTheyLedTo) {
  const TemporaryFolder folder;
  const DeviceCall move{Time(Duration(7)), "target", "move 0.1", ""},
      look{Time(Duration(9)), "target", "state", "0.1 0.1"};
  {
    const auto record = RunRecord::Create(folder.path(), AnyProvenance());
    record->Called(move);
    record->Append(ReadingOf(0), {});
    record->Called(look);
    record->ForgetCalls();  // an attempt that failed
    record->Called(look);
    record->Append(ReadingOf(1), {});
    record->Called(move);  // no reading came of it
  }
  EXPECT_EQ(RunRecord::Open(folder.path())->Calls(), (std::vector<DeviceCall>{move, look}));
}

TEST(RunRecord, NumbersTheAttemptsOfEachReadingAndUsesNoneTwice) {
  const TemporaryFolder folder;
  RunRecord::Create(folder.path(), AnyProvenance())->AttemptFailed(4, Time{}, "gap", "a");
  const auto record = RunRecord::Continue(folder.path());
  record->AttemptFailed(4, Time{}, "timeout", "b");
  record->AttemptFailed(5, Time{}, "gap", "c");
  std::vector<std::pair<int, int>> numbers;
  for (const FailedAttempt& attempt : record->FailedAttempts())
    numbers.emplace_back(attempt.reading, attempt.attempt);
  EXPECT_EQ(numbers, (std::vector<std::pair<int, int>>{{4, 1}, {4, 2}, {5, 1}}));
}

TEST(RunRecord, HasOneWriterAndSaysSo) {
  const TemporaryFolder folder;
  auto record = RunRecord::Create(folder.path(), AnyProvenance());
  EXPECT_TRUE(RunRecord::HasWriter(folder.path()));
  EXPECT_THROW(RunRecord::Continue(folder.path()), InputError);
  EXPECT_NO_THROW(RunRecord::Open(folder.path())) << "whoever only reads may";
  record.reset();
  EXPECT_FALSE(RunRecord::HasWriter(folder.path()));
  record = RunRecord::Continue(folder.path());
  EXPECT_THROW(RunRecord::Continue(folder.path()), InputError);
}

/// Somebody who is not root, whom permissions do not hold, opens it. @return readings; -1: refused.
int ReadingsSeenByNobody(const std::string& directory) {
  const pid_t child = fork();
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    if (geteuid() == 0 && setuid(kNobody) != 0) _exit(254);
    try {
      const auto record = RunRecord::Open(directory);
      _exit(static_cast<int>(record->Readings().size()));
    } catch (const std::exception&) {
      _exit(255);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WEXITSTATUS(status) == 255 ? -1 : WEXITSTATUS(status);
}

TEST(RunRecord, IsReadWhereNothingMayBeWritten) {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  const auto record = RunRecord::Create(folder.path(), AnyProvenance());
  for (int i = 0; i < 100; ++i) record->Append(ReadingOf(i), {});  // all of it in the write-ahead log as yet
  constexpr auto kRead = fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read;
  constexpr auto kSearch = fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec;
  for (const auto& file : fs::directory_iterator(folder.path())) fs::permissions(file, kRead);
  fs::permissions(folder.path(), kRead | kSearch);
  EXPECT_EQ(ReadingsSeenByNobody(folder.path()), 100);
  fs::permissions(folder.path(), kRead | kSearch | fs::perms::owner_write);
}

void FillRecord(const std::string& directory) {
  const auto record = RunRecord::Create(directory, AnyProvenance());
  for (int i = 0; i < 100; ++i) record->Append(ReadingOf(i), BlockOf(std::vector<std::int16_t>(400, 7)));
}

TEST(RunRecord, ThatWasCutOffOrOverwrittenIsRefused) {
  for (const bool is_cut : {true, false}) {
    const TemporaryFolder folder;
    FillRecord(folder.path());
    const std::string path = folder.File("record.sqlite");
    const auto middle = std::filesystem::file_size(path) / 2;
    if (is_cut) std::filesystem::resize_file(path, middle);
    if (!is_cut) {
      std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
      file.seekp(static_cast<std::streamoff>(middle)) << std::string(20000, '\xAA');
    }
    EXPECT_THAT(OpenError(folder.path()), testing::StartsWith(path + ": the record ")) << is_cut;
  }
}

}  // namespace
}  // namespace twinbench
