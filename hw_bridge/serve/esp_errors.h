#pragma once

#include <string>

/// Error numbers of the Newport ESP300/301, as its manual and PyMeasure's driver have them.
namespace twinbench::hw {

inline constexpr const char *kEspShowToken = "XK", *kEspWatchdog = "XW";  // of no controller

struct EspError {
  int number;
  bool of_axis = false;  // reported as axis * 100 + number
};

inline constexpr int kEspBenchFailed = 1, kEspUnknownCommand = 6, kEspOutOfRange = 7, kEspAxisOutOfRange = 9,
                     kEspNotAllowed = 27, kEspAxisMissing = 37, kEspParameterMissing = 38,
                     kEspNoToken = 99;  // not of the ESP301

/// Of an axis. Limits: of the positive side; those of the negative side are one more.
inline constexpr int kEspAxisParameter = 1, kEspHardwareLimit = 4, kEspSoftLimit = 6, kEspMotorOff = 13;

/// Whoever has no token may ask, wait and stop; all else changes the bench.
/// @param name  Two letters of the command.
bool IsEspOpenToAll(const std::string& name, bool query);

/// @param number  As reported: 206 is of axis 2.
const char* EspErrorText(int number);

}  // namespace twinbench::hw
