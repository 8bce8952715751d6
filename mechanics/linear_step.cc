#include "mechanics/linear_step.h"

#include <cstring>

#include "mechanics/stack_propagator.h"

namespace twinbench::mechanics {
namespace {

using EightRows [[gnu::vector_size(64)]] = double;

struct Column {
  EightRows top, middle, bottom;
};
static_assert(sizeof(Column) == sizeof(StackPropagator::State));

[[gnu::always_inline]] inline void Add(const double* rows, double factor, EightRows& sum) {
  EightRows added;
  std::memcpy(&added, rows, sizeof(added));
  sum += added * factor;
}

/// Written out: in a loop the sums would go through memory.
[[gnu::always_inline]] inline Column SumOfColumns(const double* columns, const double* factors, int size) {
  Column sum = {};
  for (int j = 0; j < size; ++j) {
    const double* column = columns + 2 * kCoordinates * j;
    Add(column, factors[j], sum.top);
    Add(column + 8, factors[j], sum.middle);
    Add(column + 16, factors[j], sum.bottom);
  }
  return sum;
}

/// A third of a driven stack's time goes here.
[[gnu::target_clones("avx512f", "avx2", "default")]] void StepArrays(const StepMatrices& matrices, const double* from,
                                                                     const double* input, double* to) {
  const Column carried = SumOfColumns(matrices.transition, from, 2 * kCoordinates);
  const Column driven = SumOfColumns(matrices.drive, input, matrices.inputs);
  const Column sum{carried.top + driven.top, carried.middle + driven.middle, carried.bottom + driven.bottom};
  std::memcpy(to, &sum, sizeof(Column));
}

}  // namespace

void LinearStep(const StepMatrices& matrices, const double* from, const double* input, double* to) {
  StepArrays(matrices, from, input, to);
}

}  // namespace twinbench::mechanics
