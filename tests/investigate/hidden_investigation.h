#pragma once

#include "tests/hidden/unlisted_cause.h"
#include "twin/investigate/investigation.h"

/// Investigations of benches with something hidden: of twins without a disk, and of a program of others.
namespace twinbench::investigate {

enum class Result {
  kRight,       // the one cause that is there
  kRightTie,    // "cannot be told", and it is among those that are left
  kUnfinished,  // the budget was spent with it among those that are left
  kMissed,      // nothing found
  kUnnamed,     // said to be something that the catalogue has no name for; right if it is
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

  bool IsRight() const { return result == Result::kRight || result == Result::kRightTie; }
};

/// What is hidden in a bench.
struct Truth {
  std::string effect, where;  // of the catalogue; no effect: something that it lacks
  std::string words;
};

/// A quantity of results.json ("target.ez_arcsec") and how many times more certain than after the first run it shall be.
struct Wish {
  std::string quantity;
  double times = 2.0;
};

using Measure = std::function<std::vector<Reading>(const Step&, const Scenario&)>;

/// What an investigation of such a bench can do; all its next runs may be made.
Means MeansOf(const Scenario& believed);

/// @param measure  The bench. With a wish, its first run is asked for twice.
Judged InvestigateBench(const Scenario& believed, const Truth& truth, const Measure& measure,
                        InvestigationOptions options, const std::optional<Wish>& wish = {});

/// @param rho  Size of the cause in the first run, in units of noise after projection.
Judged InvestigateHidden(const hidden::Placement& at, std::uint64_t seed, double rho,
                         const hidden::SignatureScale& scale, const InvestigationOptions& options,
                         const std::optional<Wish>& wish = {});

/// A signal that the catalogue has no name for, the same one in every run.
Judged InvestigateUnlisted(hidden::Design design, const hidden::UnlistedCause& cause, std::uint64_t seed, double rho,
                           const hidden::SignatureScale& scale, const InvestigationOptions& options);

/// An encoder that a program measures (tests/data/program/acquire_hidden.py), which shares nothing with the twin.
Judged InvestigateProgram(std::uint64_t seed);

}  // namespace twinbench::investigate
