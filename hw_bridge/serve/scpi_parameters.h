#pragma once

#include <string>

/// Parameters and answers of SCPI commands.
namespace twinbench::hw {

/// A number that is none is 9.91E37 (SCPI-99, volume 1, 7.2.1.5).
std::string PrintScpi(double value_SI, double unit);

/// @throws ScpiError -120 if it is no number, -222 if it is out of bounds.
double ScpiNumber(const std::string& text, double unit);
long long ScpiWholeNumber(const std::string& text, long long least, long long most);

/// "ON" or "1", "OFF" or "0". @throws ScpiError -224.
bool ScpiSwitch(const std::string& text);

}  // namespace twinbench::hw
