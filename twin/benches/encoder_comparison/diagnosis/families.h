#pragma once

#include <string>
#include <vector>

#include "twin/benches/encoder_comparison/diagnosis/encoder_run.h"
#include "twin/diagnose/engine/family.h"

/// Candidates for an angle comparison: every effect of the catalogue that leaves a trace in this run, and generic
/// shapes for what the catalogue has not.
namespace twinbench::diagnose::encoder {

/// Named families, then unknown ones; they own what they need.
///
/// Left out are causes that this run cannot show: latency of a device at rest, interpolation and gear mesh without
/// stated lines or teeth, a faulty reference unless the device was turned on the shaft between set-ups. Causes of
/// the same order (eccentricity and signal offset; ellipticity, amplitude mismatch and quadrature error where the
/// zero of the signals is not known) have the same columns and the same prior: they tie. Outliers are no signature
/// but a matter of the noise.
///
/// Prior sizes: a trace of 0.01 deg rms, or three times the noise if that is more.
///
/// @param excluded  Effects taken out of the catalogue, or `kGradualPlay`. The unknown ones are the same whatever is excluded,
/// but for "harmonic": whole orders that all have a name.
std::vector<Family> Families(const EncoderRun& encoder, const std::vector<std::string>& excluded = {});

/// A backlash that is crossed over another way than its width.
constexpr const char* kGradualPlay = "gradual backlash";

/// The closest usual distance of neighbouring readings of any pass; 0 if all are at rest.
double FinestSpacing_rad(const SignalContext& context);

/// Gone through in one set-up, the longest: each has an offset of its own.
double RangeOfSetUp_rad(const SignalContext& context);

/// The least whole order of which the run shows enough of a period to know one: 1 of a whole turn.
int LeastOrder(const SignalContext& context);

/// Orders that differ by less are not told apart in what one set-up shows of a turn.
double OrdersApart(const SignalContext& context);

/// The largest whole order that these readings can tell from lower ones: two readings a period, or more where stops are
/// uneven; at most 720 of a turn, of a part of one as much more; of means over the way from one to the next, that they
/// lower by no more than a hundredth.
int LargestOrder(const SignalContext& context);

/// Whole orders from `first` on that the run can show, ascending. Of those that are more than a wheel or a motor has, over a part of
/// a turn that does not tell neighbours apart, every few.
std::vector<int> WholeOrders(const SignalContext& context, int first);

}  // namespace twinbench::diagnose::encoder
