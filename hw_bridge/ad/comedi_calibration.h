#pragma once

#include <string>
#include <vector>

#include "hw_bridge/ad/comedi_card.h"

namespace twinbench::hw {

/// What range and bits say: code * range / 2^(bits - 1), for every channel.
std::vector<CalibrationPolynomial> NominalCalibration(const ComediInputs& inputs);

/// The polynomials of a calibration file, moved to two's complement codes. A card that is trimmed in hardware gets
/// its trim values and keeps the nominal polynomials.
/// @throws DeviceFault kRefused if the file cannot be read, is of another board or says nothing of a channel.
std::vector<CalibrationPolynomial> ReadCalibration(comedi_t* card, const ComediInputs& inputs,
                                                   const std::string& file);

}  // namespace twinbench::hw
