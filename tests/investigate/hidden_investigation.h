#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/hidden/placements.h"
#include "tests/hidden/twin_case.h"
#include "twin/investigate/investigation.h"

/// Investigations of twins with something hidden, without a disk.
namespace twinbench::investigate {

enum class Result {
  kRight,       // the one cause that is there
  kRightTie,    // "cannot be told", and it is among those that are left
  kUnfinished,  // the budget was spent with it among those that are left
  kMissed,      // nothing found
  kUnnamed,     // said to be something that the catalogue has no name for
  kWrongTie,    // left open without it
  kWrong        // another cause
};
const char* ResultName(Result result);

struct Judged {
  Result result = Result::kWrong;
  Investigation investigation;
  std::string truth, answer;
  bool tied_at_first = false;  // more than one cause was left after the first run
  double probability = 0.0;    // of the answer
  double seconds = 0.0;

  bool IsRight() const { return result == Result::kRight || result == Result::kRightTie; }
};

/// @param rho  Size of the cause in the first run, in units of noise after projection.
Judged InvestigateHidden(const hidden::Placement& at, std::uint64_t seed, double rho,
                         const hidden::SignatureScale& scale, const InvestigationOptions& options);

}  // namespace twinbench::investigate
