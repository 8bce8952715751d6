#pragma once

#include "twin/core/scenario.h"
#include "twin/separate/index_errors.h"

namespace twinbench::separate::turntable {

/// Index error of the turntable wherever it was read, on the grid and between: x of full circle and verification
/// without the roll of the crosshair and, where the shifts tell them apart, without the teeth.
/// With a polygon: wherever a face was nulled, without the errors of the faces.
/// @throws InputError as SeparateIndexing or ClosePolygon, or if there are no readings of a full circle.
IndexErrors TurntableIndexErrors(const Scenario& scenario, const std::vector<Reading>& readings);

}  // namespace twinbench::separate::turntable
