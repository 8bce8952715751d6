#include "twin/campaign/ranks.h"
#include "twin/core/errors.h"

/// A build without MPI.
namespace twinbench::campaign {

Ranks::Ranks(bool with_mpi) : with_mpi_(with_mpi) {
  if (with_mpi_)
    throw InputError("--mpi", "this twinbench was built without MPI",
                     "a build with libopenmpi-dev installed, or --threads");
}

Ranks::~Ranks() = default;

bool Ranks::Agree(bool can_begin) {
  return can_begin;
}

void Ranks::Serve(const Take&, const Write&) {}

void Ranks::WorkForFirst(const std::function<TrialRow(std::int64_t)>&) {
  Require(false, "a process that is alone is the first");
}

}  // namespace twinbench::campaign
