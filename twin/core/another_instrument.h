#pragma once

#include "twin/core/reading_column.h"

namespace twinbench {

/// What another instrument shows in the place of the bench's own: few runs have it, and those that do have nothing
/// else. It is written only where it was read.
inline bool IsOfAnotherInstrument(const ReadingColumn& column) {
  return column.may_be_absent && column.role == ColumnRole::kShownToo;
}

}  // namespace twinbench
