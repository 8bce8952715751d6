#pragma once

#include <string>

namespace twinbench::diagnose::turntable {

/// What would split two causes that a run cannot tell apart, in words; never empty.
std::string NextMeasurement(const std::string& effect, const std::string& rival);

/// What would show a cause that a run cannot see; empty if nothing simple does.
std::string WhatWouldShow(const std::string& effect);

}  // namespace twinbench::diagnose::turntable
