#pragma once

/// Factors that turn a number with a unit into SI: `35.0 * units::um` is 35 um in metres, and
/// `x_m / units::um` prints metres as micrometres.
namespace twinbench::units {

inline constexpr double kPi = 3.141592653589793238462643383279502884;

inline constexpr double mm = 1e-3;
inline constexpr double um = 1e-6;
inline constexpr double nm = 1e-9;
inline constexpr double pm = 1e-12;
inline constexpr double rad = 1.0;
inline constexpr double mrad = 1e-3;
inline constexpr double urad = 1e-6;
inline constexpr double deg = kPi / 180.0;
inline constexpr double turn = 2.0 * kPi;
inline constexpr double arcsec = deg / 3600.0;
inline constexpr double mV = 1e-3;
inline constexpr double uV = 1e-6;
inline constexpr double ms = 1e-3;
inline constexpr double us = 1e-6;
inline constexpr double kHz = 1e3;
inline constexpr double mW = 1e-3;
inline constexpr double hour = 3600.0;

}  // namespace twinbench::units
