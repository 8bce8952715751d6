#pragma once

#include "twin/diagnose/engine/search.h"

namespace twinbench::diagnose {

/// Notes of every term which causes of its place are like nothing of it (Term::unlike): what explains as much by another
/// structure that is there too is looked at by itself, later. Likeness is that of what the free unknowns leave.
/// @param families  Of the search.
void NoteUnlike(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                const std::vector<Family>& families, SearchResult& found);

}  // namespace twinbench::diagnose
