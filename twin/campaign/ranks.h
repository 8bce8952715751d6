#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "twin/campaign/trial.h"

namespace twinbench::campaign {

/// The processes of one campaign, as MPI numbers them; a process that was not started by mpirun is alone. One
/// object in a program. In a build without MPI all are alone.
class Ranks {
 public:
  /// Whether this process was started as one of several, by mpirun or by Slurm through PMI.
  static bool StartedAsOneOfMany();

  /// @param with_mpi  Start MPI; else the process is alone.
  /// @throws BenchError if MPI cannot be started or does not keep apart what threads do.
  explicit Ranks(bool with_mpi);
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  bool IsFirst() const { return rank_ == 0; }
  int Others() const { return size_ - 1; }

  /// The first rank says whether it can begin; all return what it said.
  bool Agree(bool can_begin);

  using Take = std::function<std::optional<std::int64_t>()>;
  using Write = std::function<void(const TrialRow&)>;
  /// First rank: answers all others that wait for a trial, and writes the rows that they bring. Does not wait.
  void Serve(const Take& take, const Write& write);
  /// First rank: whether any other has not yet been told that there is no more.
  bool Busy() const { return dismissed_ < Others(); }

  /// Other ranks: asks the first for trials until there are no more.
  void WorkForFirst(const std::function<TrialRow(std::int64_t)>& run);

 private:
  bool with_mpi_;
  int rank_ = 0, size_ = 1, dismissed_ = 0;
};

}  // namespace twinbench::campaign
