#pragma once

#include <string>

#include "twin/diagnose/diagnose.h"

/// The words that diagnoses are told in. Where they stand on a page is for the report to say.
namespace twinbench::diagnose {

/// Of causes that predict nothing.
inline constexpr const char* kNoGainNote =
    "the held-out improvement is not above zero at 95 %: the cause is a proposal and is not written";

/// "psd_gain at psd_a_x".
std::string Place(const std::string& effect, const std::string& where);

/// "97 %", "< 1 %"; "-" if it is not known.
std::string Percent(double share);

/// What values up to `largest_SI` are told in: um for lengths in mm that are below a tenth, else their own unit.
ChannelUnit FinerUnit(const ChannelUnit& unit, double largest_SI);

/// "0.0031 ± 0.0002 mrad": as many digits as the uncertainty has meaning; without an uncertainty three.
std::string WithUncertainty(const ParameterEstimate& parameter);

/// "gain error 0.0031 ± 0.0002".
std::string NameAndSize(const ParameterEstimate& parameter);

/// What the extended model gains on readings that it was not fitted to, in a sentence; "" if it was not measured.
std::string GainInWords(const Gain& gain, const LinearRun& run);

}  // namespace twinbench::diagnose
