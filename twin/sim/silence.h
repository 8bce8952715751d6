#pragma once

#include "twin/core/shared_settings.h"

/// Takes out what is drawn at random from reading to reading; random table errors stay, they are errors.
namespace twinbench::sim {

void Silence(TableSettings& table);
void Silence(EnvironmentSettings& environment);
void Silence(MechanicsSettings& mechanics);

}  // namespace twinbench::sim
