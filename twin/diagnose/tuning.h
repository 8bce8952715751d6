#pragma once

#include <array>
#include <cstddef>

/// The numbers that decide what a diagnosis says, each with its reason. What only guards against rounding stands
/// where it is used; sizes that a bench finds plausible are the bench's.
namespace twinbench::diagnose::tuning {

// --- what is thought before any reading ---

/// One half for no effect; the rest is shared evenly by the groups of named causes and by those of the unknown, and
/// inside a group by its families. A catalogue was made because its causes occur: four times the unknown.
inline constexpr double kPriorNone = 0.5, kPriorNamed = 0.4, kPriorUnknown = 0.1;
/// Widths of the amplitude's prior that the evidence is averaged over, in plausible sizes: the width is not known
/// better than to a factor of four.
inline constexpr std::array<double, 3> kPriorScales = {0.25, 1.0, 4.0};
/// Trust in the noise figure, in degrees of freedom beside those of the data. Stated: 20 lets a run of 600 readings
/// find it 10 % wrong, 200 does not. Estimated from the same data: next to none.
inline constexpr double kPseudoDegrees = 20.0, kPseudoEstimated = 2.0;
/// Weight of a shape without a name that a cause of the catalogue has exactly: less likely to be something else.
inline constexpr double kSameShape = 0.2;
/// Odds, before its overtones are looked at, that what shows a wave in time repeats so and is no sine: what swings freely
/// or is stirred by a rotor is one; pumps, valves, compressors and thermostats switch.
inline constexpr double kNoSine = 0.25;

// --- what is claimed ---

/// Probability of an alarm on a run without effect: half of what is promised, for noise is never as clean as
/// simulated.
inline constexpr double kAlarmProbability = 0.005;
/// Share of the machines that look exactly like a cause of the catalogue and have it; the others have something
/// that the catalogue lacks.
inline constexpr double kListed = 0.97;
/// The same for causes with a double outside the catalogue: a wrong scale of a whole detector and its distance.
inline constexpr double kListedDoubled = 0.85;
/// A cause has to be there: its size so many standard uncertainties from zero.
inline constexpr double kHeadline = 3.0;
/// One name alone from here on; below, the smallest set that holds so much of what is not unknown, without causes
/// that hardly count.
inline constexpr double kNamedFrom = 0.8, kTieFrom = 0.95, kWorthListing = 0.02;
/// Other places are told beside the first if the same shape is nearly as likely there: a factor of five, in log.
inline constexpr double kNearlyAsLikely = 1.6;
/// A shape that no formula hits exactly leaves a rest; up to this share of the explained power it is no news.
inline constexpr double kSmallRest = 0.015;
/// Most that is claimed of a cause whose gain on held-out passes is not above zero at 95 %.
inline constexpr double kNotProven = 0.6;
/// Non-centrality of what is called detectable: found in 80 % of cases at a test of 0.1 % (Baarda).
inline constexpr double kBaarda = 4.13;
/// Plausible sizes that a cause may have at most before "invisible" is said of it.
inline constexpr double kPlausibleTop = 3.0;

// --- the search ---

/// Families that explain so much of what the best does are moved to their best shape before they are compared: a
/// grid is too coarse for a strong effect. No more than eight, for the time it takes.
inline constexpr double kNearlyAsMuch = 0.6;
/// Of what a family explains at its best shape, the most that the nearest point of its grid loses: of a wave between
/// two frequencies that are 0.6 cycles of the run apart, 1 - sinc^2(0.3).
/// Those that would come first with it are moved too.
inline constexpr double kLostBetween = 0.27;
inline constexpr int kMostLeaders = 8;

/// Causes and shapes with a form that are tried before shapes that take any course in time: an angle device may well
/// show so many orders.
inline constexpr int kMostBeforeCourses = 12;
/// Of the power that does not repeat at places visited again, the most that a course in time may explain: those that
/// wander little between two visits repeat in part.
inline constexpr double kMostOfNotRepeating = 2.0;

// --- noise ---

/// Log Bayes factor from which a noise model is not used any more. Single values: less than one run in a thousand
/// of white noise. What is left of a correlation that was taken out before: projection makes the first estimate too
/// small.
inline constexpr double kRefuted = 8.0, kRefutedBySingle = 6.0, kRefutedAgain = 1.5;
/// Rounds of repair: each kind of fault once.
inline constexpr int kMostRepairs = 4;
/// Single values: beyond this many deviations (one row in two million by chance) and no more than this share of all
/// rows; more are no exceptions.
inline constexpr double kFarOff = 5.0, kMostOutlying = 0.05;
/// Log odds of single values in normal noise against heavy tails from which they are called outliers. In noise like
/// Student's t with 5 degrees of freedom 3 raised an alarm in 3 of 15 short runs, 6 in none; outliers of 8 to 20
/// deviations are found as before.
inline constexpr double kExceptional = 6.0;
/// A remark on the noise that is worth a sentence, log Bayes factor.
inline constexpr double kWorthTelling = 3.0;

// --- shapes without a name ---

/// Whole orders of an angle that may change with speed or time, and with direction: cogging and commutation come 50,
/// 100 or 200 times a turn.
inline constexpr int kModulatedOrders = 24, kDirectionOrders = 250;
/// Values of a label (passes, set-ups) with an offset, or with waves, of their own; more are a wander.
inline constexpr int kMostOffsets = 64, kMostWaves = 24, kMostDwells = 8;
/// Orders that may differ from pass to pass, and from set-up to set-up.
inline constexpr int kPassOrders = 3, kSetupOrders = 6;
/// Orders of each of two angles in what is locked to both.
inline constexpr int kInteractionOrders = 8;
/// Lines between whole orders: from here on, and in no less than so many turns where whole orders are not free.
inline constexpr double kFirstLine = 0.3, kFewestTurns = 1.4;
inline constexpr int kMostLines = 2000;
/// Tones: spacing in resolutions (a wave between two keeps nine tenths) from so many on (slower ones are a wander).
/// Steps: at every reading. Both thinned evenly beyond so many.
inline constexpr double kToneSpacing = 0.6, kFirstTone = 3.0;
inline constexpr std::size_t kMostTones = 1500, kMostSteps = 1500;
/// Modes of a slow wander one by one, together, and of a random walk.
inline constexpr int kWanderModes = 4, kWanderTogether = 6, kWalkModes = 24;
/// Speeds that differ by less are one speed.
inline constexpr double kOneSpeed = 0.05;
/// Fringes: the shortest period, in plausible sizes of a disturbance, and how many periods are tried.
inline constexpr double kShortestFringe = 25.0;
inline constexpr int kMostFringes = 400;
/// Time constants in a run, of something that warms up and stays.
inline constexpr double kWarmUps = 3.0;

// --- effects that the twin is asked about ---

/// Grid points over all shapes of an effect, and of onsets.
inline constexpr double kAskedPoints = 16.0;
inline constexpr std::size_t kAskedOnsets = 200;
/// About the plausible value: a factor either way of a shape with a fixed sign, multiples of one that may change
/// it.
inline constexpr double kAskedRatio = 16.0, kAskedSide = 4.0;
/// Slopes are differenced over this share of the plausible size.
inline constexpr double kAskedStep = 0.01;

}  // namespace twinbench::diagnose::tuning
