#pragma once

#include <memory>

#include "hw_bridge/ad/ad_source.h"

namespace twinbench::hw {

/// A card behind comedilib: one command of so many scans a block, read as it comes.
///
/// The card must be able to run commands; what it makes of rate and scan list is asked with comedi_command_test
/// until it has nothing to change. Codes are offset binary and become two's complement by taking off the middle
/// code, so that a volt is range / 2^(bits - 1) codes, or come with the polynomials of a calibration file. A full
/// FIFO ends a command for good (kOverrun). The driver stamps nothing: within a command no scan can be lost
/// unnoticed.
std::unique_ptr<AdSource> MakeComediSource(const AdSettings& settings);

}  // namespace twinbench::hw
