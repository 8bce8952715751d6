#include <algorithm>

#include "twin/core/errors.h"
#include "twin/diagnose/screen/significance.h"

namespace twinbench::diagnose::screen {
namespace {

/// In the order of the screen. In a scan, `reading` follows the item and the place where it shows.
constexpr Words kWords[] = {
    {"fit to stated noise", "all readings", "residuals are {:.3f} times the stated noise: ",
     "something is not modelled, or the noise figure is too small", "the noise figure is too large"},
    {"fit to repeats", "places visited again",
     "the part of the residual that comes back at each visit is {:.2f} times what noise gives (variance): ",
     "the model lacks something repeatable", "no lack of fit"},
    {"noise of the channels", "",
     "residual of {} is {:.3f} times that of the channels together: noisy channel, or a cause that shows there "
     "only"},
    {"noise of the detectors", "",
     "residual of {} is {:.3f} times that of the detectors together: its electronics, its distance, or light that "
     "reaches it alone"},
    {"noise against spot radius", "",
     "scatter on {} {} with the distance of the spot from the centre: speckle, spot shape, stray light, or a "
     "detector that is not linear"},
    {"tails", "", "tails ", "like Student's t with {:.0f} degrees of freedom: spikes, air turbulence, bumps",
     "no heavier than a Gaussian's"},
    {"outliers", "reading {} (mounting {}, pass {}, position {}), {}: {:.1f} standard deviations",
     "one reading stands apart: {}"},
    {"whiteness within a pass", "lag {}",
     "readings {} apart are correlated by {:+.3f} beyond what the fit causes: ",
     "correlated noise, drift or slow dynamics that are not modelled",
     "alternating error, or noise that a filter has differentiated"},
    {"time: wander", "{} half wave{} over the run", "a slow change of the environment, the source or a mounting"},
    {"time: drift", "the time", "steady drift of the source, a detector or a mounting"},
    {"time: creep", "the logarithm of 1 + time in the mounting / {:.0f} s",
     "a mounting that creeps after it was clamped (amplitude per decade)"},
    {"time: exponential", "an exponential since the {} that decays in {:.2g} of the run",
     "warming up, or relaxing after a disturbance"},
    {"time: step", "a step near reading {} (at {:.0f} s)", "a knock, a slip, a mode hop, a lost or gained count"},
    {"time: running sum", "",
     "the mean of {} changes near reading {} (at {:.0f} s), at once or slowly: a knock, drift or creep"},
    {"time: tone", "a tone of {:.3g} mHz (period {:.4g} s)",
     "hum or vibration aliased by the measuring positions, an air conditioner's cycle"},
    {"time: Allan deviation", "means over {} readings of {}",
     "{} scatter more than white noise would: flicker, random walk or drift from reading to reading"},
    {"harmonics: target angle", "order {:g} of the target angle",
     "eccentricity, ellipse, gear or encoder of the target, or of the device"},
    {"harmonics: reference angle", "order {:g} of the reference angle",
     "eccentricity, ellipse, gear or encoder of the reference"},
    {"harmonics: sum of both angles", "order {:g} of the sum of both angles",
     "fixed in the laboratory, or wobble of the reference's rotor"},
    {"harmonics: difference of both angles", "order {:g} of the difference of both angles",
     "the two tables' errors multiply"},
    {"half turns: target angle", "order {:g} of the target angle", "rolling elements or the cage of a bearing"},
    {"half turns: reference angle", "order {:g} of the reference angle",
     "rolling elements or the cage of a bearing"},
    {"harmonics by mounting", "order {} with a phase of its own in each mounting", "synchronous with "},
    {"direction: mean", "the direction of travel", "backlash, hysteresis or settling"},
    {"direction: harmonics of the target angle", "the direction of travel with order {:g} of the target angle",
     "backlash or hysteresis that varies around the turn"},
    {"direction: harmonics of the reference angle",
     "the direction of travel with order {:g} of the reference angle",
     "backlash or hysteresis that varies around the turn"},
    {"direction: dwell", "the direction times exp(-dwell / {:g} s)",
     "settling or creep after the move (amplitude at the shortest dwell)"},
    {"direction: speed", "the velocity (amplitude at the highest speed, the mean of each direction apart)",
     "latency between the two devices, lag of a servo, viscous wind-up"},
    {"offsets by mounting", "",
     "each mounting has an offset of its own on {}, for which the model leaves too little freedom"},
    {"offsets by pass", "",
     "each pass has an offset of its own on {}: something moves or is seated anew between passes"},
    {"offsets by place", "",
     "each place has an offset of its own on {}: an error of position that no free table error explains"},
    {"temperature", "temperature{}",
     "thermal expansion or wavelength (amplitude for half the range of temperature)"},
    {"temperature rate", "the rate of temperature, smoothed over {:.0f} min",
     "a gradient that bends something (amplitude for half the range of the rate)"},
    {"spot: polynomial", "degree {} of the spot's {} coordinate",
     "a detector that is not linear: pincushion, tilt, edge, converter"},
    {"spot: periodic", "the spot's own coordinate with a period of {:.3g} um",
     "interference fringes of a window, steps of a converter"},
    {"spot: map", "x = {}, y = {}",
     "residual of {} depends on where the spot stands, most at {}: dirt, an edge or uneven response"},
    {"channel pattern", "",
     "channels move together as in {} more than noise does: a body moves that way, or its model is wrong"},
    {"channel order", "what {} showed just before {}",
     "a ghost of the channel scanned before, or crosstalk (size at the rim of its range)"},
    {"raw: hum", "{}: amplitude {:.3g} codes",
     "the samples carry a wave of {}: mains hum in cables, lamps or supplies"},
    {"raw: ring-down", "{} at {:.4g} Hz, time constant {:.3g} s",
     "vibration dies out within the blocks, loudest on {}: dwell too short for a resonance"},
    {"raw: Allan deviation", "means over {:.3g} ms of {}",
     "{} scatter more than white noise would: flicker, drift or hum, and more samples do not help as they should"},
    {"raw: code density", "code {} of {}: came {:.0f} times instead of {:.0f}{}",
     "{}: a converter whose steps are not equal"},
    {"raw: settling", "{}: score {:.1f}",
     "{}: a multiplexer or amplifier that has not settled, or noise that is not white"},
    {"raw: settling, channel before", "{:+.2g} of {} stays in {}", ""},
    {"raw: settling, sample before", "{:+.2g} of the sample before stays in {}", ""},
    {"raw: settling, first sample", "the first sample of {} is off by {:+.2g} codes", ""},
};

}  // namespace

const Words& WordsOf(std::string_view test) {
  const auto* words = std::ranges::find(kWords, test, &Words::test);
  Require(words != std::end(kWords), "every test of the screen has its words");
  return *words;
}

}  // namespace twinbench::diagnose::screen
