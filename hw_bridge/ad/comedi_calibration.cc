#include "hw_bridge/ad/comedi_calibration.h"

#include <cmath>

namespace twinbench::hw {
namespace {

struct CalibrationCloser {
  void operator()(comedi_calibration_t* calibration) const { comedi_cleanup_calibration(calibration); }
};
using Calibration = std::unique_ptr<comedi_calibration_t, CalibrationCloser>;

void RequireSameBoard(comedi_t* card, const comedi_calibration_t& calibration, const std::string& file) {
  const std::string board = comedi_get_board_name(card), driver = comedi_get_driver_name(card);
  if (calibration.board_name == board && calibration.driver_name == driver) return;
  RefuseCard(file, std::string("calibrates the board ") + calibration.board_name + " of driver " +
                       calibration.driver_name + ", the card is " + board + " of driver " + driver);
}

CalibrationPolynomial PolynomialOf(const comedi_calibration_t& calibration, const ComediInputs& inputs,
                                   unsigned packed, const std::string& file) {
  comedi_polynomial_t polynomial{};
  if (comedi_get_softcal_converter(inputs.subdevice, CR_CHAN(packed), CR_RANGE(packed), COMEDI_TO_PHYSICAL,
                                   &calibration, &polynomial) < 0) {
    RefuseCard(file, "says nothing of channel " + std::to_string(CR_CHAN(packed)) + " in range " +
                         std::to_string(CR_RANGE(packed)));
  }
  CalibrationPolynomial result;
  result.origin = polynomial.expansion_origin - std::ldexp(1.0, inputs.bits - 1);
  result.coefficients_V.assign(polynomial.coefficients, polynomial.coefficients + polynomial.order + 1);
  return result;
}

void Trim(comedi_t* card, const ComediInputs& inputs, const comedi_calibration_t& calibration,
          const std::string& file) {
  for (const unsigned packed : inputs.chanlist) {
    if (comedi_apply_parsed_calibration(card, inputs.subdevice, CR_CHAN(packed), CR_RANGE(packed), CR_AREF(packed),
                                        &calibration) < 0) {
      ThrowComedi(FaultKind::kRefused, file, "trimming channel " + std::to_string(CR_CHAN(packed)));
    }
  }
}

}  // namespace

std::vector<CalibrationPolynomial> NominalCalibration(const ComediInputs& inputs) {
  std::vector<CalibrationPolynomial> nominal;
  for (const comedi_range& range : inputs.range) {
    const double half_V = 0.5 * (range.max - range.min);
    nominal.push_back({0.0, {0.5 * (range.max + range.min), std::ldexp(half_V, 1 - inputs.bits)}});
  }
  return nominal;
}

std::vector<CalibrationPolynomial> ReadCalibration(comedi_t* card, const ComediInputs& inputs,
                                                   const std::string& file) {
  const Calibration calibration(comedi_parse_calibration_file(file.c_str()));
  if (!calibration) ThrowComedi(FaultKind::kRefused, file, "cannot be read as a calibration");
  RequireSameBoard(card, *calibration, file);
  if ((comedi_get_subdevice_flags(card, inputs.subdevice) & SDF_SOFT_CALIBRATED) == 0) {
    Trim(card, inputs, *calibration, file);
    return NominalCalibration(inputs);
  }
  std::vector<CalibrationPolynomial> polynomials;
  for (const unsigned packed : inputs.chanlist)
    polynomials.push_back(PolynomialOf(*calibration, inputs, packed, file));
  return polynomials;
}

}  // namespace twinbench::hw
