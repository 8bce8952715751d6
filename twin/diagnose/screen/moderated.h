#pragma once

#include <string>

#include "twin/diagnose/screen/screen.h"

namespace twinbench::diagnose::screen {

/// "0.31 um (0.32 arcsec)", whichever there is; empty if a size has no meaning.
std::string SizeInWords(const ScreenTest& test);

/// The test with its size in its reading. Words that claim something are kept for what noise alone seldom does.
ScreenTest Moderated(ScreenTest test);

}  // namespace twinbench::diagnose::screen
