#include <cstdlib>

#include "twin/campaign/ranks.h"

namespace twinbench::campaign {

bool Ranks::StartedAsOneOfMany() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"}) {
    if (std::getenv(name)) return true;
  }
  return false;
}

}  // namespace twinbench::campaign
