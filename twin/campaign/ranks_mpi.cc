#define OMPI_SKIP_MPICXX 1
#include <mpi.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdint>
#include <exception>
#include <thread>
#include <vector>

#include "twin/campaign/ranks.h"
#include "twin/campaign/trial.h"
#include "twin/core/errors.h"

/// A build with MPI. Another rank sends its row, empty the first time, and is sent the number of its next trial.
namespace twinbench::campaign {
namespace {

/// A row on its way between processes (CBOR); numbers keep their bits.
std::vector<std::uint8_t> MessageOf(const TrialRow& row) {
  nlohmann::json results = nlohmann::json::array();
  for (const TrialResult& r : row.results) results.push_back({r.name, r.value, r.u, r.error, r.k});
  return nlohmann::json::to_cbor({row.trial, row.failure, row.verdict, results});
}

TrialRow RowOf(const std::vector<std::uint8_t>& message) {
  const nlohmann::json json = nlohmann::json::from_cbor(message);
  TrialRow row{json[0].get<std::int64_t>(), json[1].get<std::string>(), json[2].get<std::string>(), {}};
  for (const nlohmann::json& r : json[3])
    row.results.push_back({r[0].get<std::string>(), r[1].get<double>(), r[2].get<double>(), r[3].get<double>(),
                           r[4].get<double>()});
  return row;
}

constexpr int kRowTag = 1, kTrialTag = 2, kFirst = 0;
constexpr std::int64_t kNoMore = -1;

/// Waits without holding the core, which MPI_Recv would: the trials need it.
MPI_Status AwaitMessage(int tag) {
  MPI_Status status;
  for (int there = 0; MPI_Iprobe(kFirst, tag, MPI_COMM_WORLD, &there, &status), !there;)
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  return status;
}

std::vector<std::uint8_t> ReceiveBytes(const MPI_Status& from) {
  int size = 0;
  MPI_Get_count(&from, MPI_BYTE, &size);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  MPI_Recv(bytes.data(), size, MPI_BYTE, from.MPI_SOURCE, kRowTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return bytes;
}

std::int64_t AskForTrial(const std::vector<std::uint8_t>& row) {
  MPI_Send(row.data(), static_cast<int>(row.size()), MPI_BYTE, kFirst, kRowTag, MPI_COMM_WORLD);
  AwaitMessage(kTrialTag);
  std::int64_t trial = kNoMore;
  MPI_Recv(&trial, 1, MPI_INT64_T, kFirst, kTrialTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return trial;
}

}  // namespace

Ranks::Ranks(bool with_mpi) : with_mpi_(with_mpi) {
  if (!with_mpi_) return;
  int provided = MPI_THREAD_SINGLE;
  if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided) != MPI_SUCCESS)
    throw BenchError("MPI cannot be started");
  if (provided < MPI_THREAD_FUNNELED) throw BenchError("this MPI does not allow threads beside its own");
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

Ranks::~Ranks() {
  // With an exception under way others may wait for ever in MPI_Finalize; mpirun ends them when this process ends.
  if (with_mpi_ && std::uncaught_exceptions() == 0) MPI_Finalize();
}

bool Ranks::Agree(bool can_begin) {
  int agreed = can_begin ? 1 : 0;
  if (with_mpi_) MPI_Bcast(&agreed, 1, MPI_INT, kFirst, MPI_COMM_WORLD);
  return agreed != 0;
}

void Ranks::Serve(const Take& take, const Write& write) {
  if (size_ == 1) return;
  MPI_Status status;
  for (int there = 0; MPI_Iprobe(MPI_ANY_SOURCE, kRowTag, MPI_COMM_WORLD, &there, &status), there;) {
    const std::vector<std::uint8_t> row = ReceiveBytes(status);
    const std::int64_t trial = take().value_or(kNoMore);
    MPI_Send(&trial, 1, MPI_INT64_T, status.MPI_SOURCE, kTrialTag, MPI_COMM_WORLD);
    dismissed_ += trial == kNoMore ? 1 : 0;
    if (!row.empty()) write(RowOf(row));
  }
}

void Ranks::WorkForFirst(const std::function<TrialRow(std::int64_t)>& run) {
  std::vector<std::uint8_t> row;
  for (std::int64_t trial; (trial = AskForTrial(row)) != kNoMore;) row = MessageOf(run(trial));
}

}  // namespace twinbench::campaign
