#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "twin/core/run_record.h"
#include "twin/core/scenario.h"
#include "twin/diagnose/engine/linear_run.h"
#include "twin/diagnose/engine/noise_model.h"
#include "twin/diagnose/engine/projector.h"

/// The screen: residual tests that show where a run and its model disagree. It does not decide; it feeds the page
/// and the description of what is unknown. Reference: docs/diagnosis.md.
namespace twinbench::diagnose {

/// One residual test.
///
/// Most statistics are the largest of many scores (orders, onsets, frequencies), each a normal score: standard
/// deviations of a Gaussian. `p` holds for the largest, so the look-elsewhere effect is inside.
struct ScreenTest {
  std::string name;
  double statistic = kNaN;
  double p = kNaN;         // probability of so large a statistic in noise alone, simulated on this very design
  double effect_m = kNaN;  // size of what was found; NaN where a size has no meaning or readings are angles
  double effect_rad =
      kNaN;             // the same as an angle: of the pattern, else of the rotation that moves the channel most
  std::string reading;  // what it means physically, in words; says so if it is not beyond noise (p > 0.05)
  std::vector<std::string> tables;  // one line an item of the scan, the loudest ones
};

/// Runs every test that applies; one that does not (no temperature recorded, one direction only) is absent.
///
/// Scores of structure use residuals levelled by each channel's own rms, so that a wrong noise figure raises the
/// tests of fit and of noise and not all the others.
///
/// @param noise      As repaired so far; its sigma whitens the run.
/// @param projector  Made from the run's nuisance, whitened by `noise`.
/// @param null_runs  Simulated runs of white noise on the design, at least 50; 0: 300, down to 150 in runs of more
///                   than 6700 rows, whose cost is rows x null_runs. p below a tenth comes from an exponential
///                   fitted to the largest of them.
/// @return tests in the order: fit, noise, time, angles, direction, groups, temperature, spot, channels.
std::vector<ScreenTest> Screen(const LinearRun& run, const NoiseModel& noise, const Projector& projector,
                               int null_runs = 0, std::uint64_t seed = 1);

/// How the codes of one channel become readings.
struct RawChannel {
  std::string name;
  double code_SI = kNaN;   // one code in the SI unit of a reading
  double code_rad = kNaN;  // the same as an angle; NaN where a reading is none
};

/// How raw blocks become readings.
struct RawScale {
  std::vector<RawChannel> channels;  // in the order of the blocks
  std::vector<int> scan;             // the channel that is converted first, second, ... of each scan
  double scan_rate_Hz = kNaN;        // scans a second: each channel is converted once a scan
};

/// Tests of the samples inside the blocks: mains hum, ring-down after the stop, codes that the converter never
/// gives, settling from sample to sample, scatter that does not average out. Blocks too short for a test leave it
/// out. Nulls: independent Gaussian samples.
/// @throws std::logic_error if a block's channels differ from those of `scale`.
std::vector<ScreenTest> ScreenRaw(const std::vector<RawBlock>& blocks, const RawScale& scale, int null_runs = 300,
                                  std::uint64_t seed = 1);

/// What these blocks are too short for, in a sentence; empty if they are not.
std::string RawLimitsInWords(const std::vector<RawBlock>& blocks, const RawScale& scale);

/// The tests with their sizes in their readings, in um and arcsec, whichever there is. Words that claim something
/// are kept for what noise alone seldom does.
std::vector<ScreenTest> Moderated(std::vector<ScreenTest> tests);

/// In how many runs without any effect one test or more would be told as loud.
inline constexpr double kScreenFalseAlarms = 0.01;

/// The tests whose p is below kScreenFalseAlarms shared by all of them (Bonferroni), least probable first.
std::vector<ScreenTest> Loud(std::vector<ScreenTest> tests);

/// The loud ones in a plain paragraph; says so if there are none.
std::string ScreenInWords(const std::vector<ScreenTest>& tests);

}  // namespace twinbench::diagnose
