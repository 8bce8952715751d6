#pragma once

#include <vector>

#include "twin/procedure/doubted_instruments.h"

/// What readings of one place that were taken in two passes of a mounting say of those between them. Only what is
/// claimed is asked.
namespace twinbench::procedure {

/// Of a reading at a place where the pass before in its set-up has one, too, and all between them.
/// @param kept  All before it.
/// @throws DeviceFault kChanged where what a column shows at places that were come to one behind the other
/// differs
///         from pass to pass by another amount than at the others: a zero, a mirror or a mounting has jumped,
///         perhaps there and back. What differs by the same everywhere may be the reversal of what is measured.
void RequireNoJump(const std::vector<ClaimedColumn>& claims, const Reading& reading,
                   const std::vector<Reading>& kept);

/// Of the same readings and a column, or one less another that shows nearly the same: two spots of one grating.
/// @throws DeviceFault kChanged where at the last six places, or at three beside three that are as before, it is what it was in
///         the pass before, but the other way round, by ten times the noise: a sign is another, or one was plugged in where
///         the other was. What is the same everywhere counts for nothing.
void RequireNotReversed(const ClaimedColumn& a, const ClaimedColumn* less, const Reading& reading,
                        const std::vector<Reading>& kept);

/// Closes the passes of a mounting: where one has come back to the place where those the other way before it began,
/// the axes come to it once more as they came then, and what is shown must be what was shown then.
class Closing {
 public:
  /// @param kept  Of a run that is gone on with.
  Closing(std::vector<ClaimedColumn> claims, const std::vector<Reading>& kept) : claims_(std::move(claims)) {
    for (const Reading& reading : kept) Took(reading);
  }
  /// A reading that was proved, or another in the place of that of its number.
  void Took(const Reading& reading);
  /// All of the mounting and the phase so far, in the order of taking.
  const std::vector<Reading>& taken() const { return taken_; }
  /// The reading that is to be shown again now; none: nullptr.
  const Reading* Asks() const;
  /// @param again  Shown where the last was taken, come to from the side of Asks().
  /// @throws DeviceFault kChanged where a column shows something else than then: by more than RequireAsBefore
  /// allows and by eight times what
  ///         the differences from pass to pass scatter (median, about their median), which a steady drift makes,
  ///         too.
  void Require(const Reading& again) const;

 private:
  std::size_t CountOf(int pass) const;

  std::vector<ClaimedColumn> claims_;
  std::vector<Reading> taken_;
};

}  // namespace twinbench::procedure
