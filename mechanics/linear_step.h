#pragma once

namespace twinbench::mechanics {

/// Matrices of a step of StackPropagator::State, column after column.
struct StepMatrices {
  const double* transition;  // square
  const double* drive;       // `inputs` columns
  int inputs;
};

/// to = transition from + drive input. Column after column on every processor: equal bits.
void LinearStep(const StepMatrices& matrices, const double* from, const double* input, double* to);

}  // namespace twinbench::mechanics
