#pragma once

#include <array>
#include <iosfwd>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "twin/core/time.h"

namespace twinbench {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Channels of the rotary bench in the order of the A/D scan list.
enum class Channel { kPsdAX, kPsdAY, kPsdBX, kPsdBY };
inline constexpr int kChannels = 4;
inline constexpr std::array<const char*, kChannels> kChannelNames = {"psd_a_x", "psd_a_y", "psd_b_x", "psd_b_y"};

inline constexpr int kPhases = 4;
enum class Phase { kCalibration, kFullCircle, kStability, kVerification };
const char* PhaseName(Phase phase);  // "calibration", "full_circle", "stability", "verification"

/// Why a reading carries no numbers. Anything but kOk leaves its voltages NaN.
inline constexpr int kReadingStatuses = 6;
enum class ReadingStatus { kOk, kSaturated, kNoLight, kClippedSpot, kOverrun, kMissing };
const char* ReadingStatusName(ReadingStatus status);  // "ok", "saturated", "no_light", "clipped_spot", ...
/// @return the value with that name, or nothing.
std::optional<Phase> PhaseOf(std::string_view name);
std::optional<ReadingStatus> ReadingStatusOf(std::string_view name);

/// One stop of a bench. Rotary bench: the commanded angles and the mean and scatter of one block of A/D samples.
/// Angle comparison: the angles that reference and device showed at the same instant. Turntable: target and
/// reference are the nominal angles of turntable and multi-tooth table, yaw and tilt what the autocollimator showed
/// as x and y. Hob: measured and reference are what the ring encoders of table and hob showed. The rest stays NaN.
struct Reading {
  int reading = 0;    // running number
  Time time{};        // start of the block
  int setup = 0;      // changes whenever something was re-mounted
  int pass = 0;       // one sweep through the positions
  int direction = 1;  // +1: target (or reference) angle increases; -1; 0: at rest, angle comparison only
  int position = 0;   // index of the stop
  Phase phase = Phase::kFullCircle;
  ReadingStatus status = ReadingStatus::kOk;

  double target_rad = kNaN;     // commanded, unwrapped
  double reference_rad = kNaN;  // commanded, unwrapped; angle comparison: as the reference showed it
  std::array<double, kChannels> mean_V = {kNaN, kNaN, kNaN, kNaN};
  std::array<double, kChannels> std_V = {kNaN, kNaN, kNaN, kNaN};  // of one sample, not of the mean
  int n_samples = 0;                                               // per channel; 0 if not known
  double dwell_s = kNaN;                                           // settled -> start of the block
  double temperature_degC = kNaN;
  double autocollimator_yaw_rad = kNaN;  // rotary bench: calibration and verification only
  double autocollimator_tilt_rad = kNaN;
  double measured_rad = kNaN;        // angle comparison: what the device under test showed; some wrap it at a turn
  double velocity_rad_s = kNaN;      // angle comparison: of the reference
  double head_rad = kNaN;            // hob: reading head of the table's encoder from the table's origin
  double interferometer_rad = kNaN;  // hob, optional: transmission error as the interferometer saw it

  /// What a bench reads that has no field above: SI, by the name of its column (Quantity in reading_column.h).
  std::vector<std::pair<std::string, double>> quantities = {};
  std::map<std::string, std::string> extra = {};  // columns of an imported file that we do not know, kept as text
};

/// Writes readings.csv of formats.md: units in the header, empty = not available, `readings` in time order. A
/// column `status` is added if any reading is not kOk. ReadReadingsCsv gives back the same bits.
/// @param bench  Its name: it decides the columns.
/// @throws InputError if there is no such bench; BenchError if `path` cannot be written.
void WriteReadingsCsv(const std::vector<Reading>& readings, const std::string& bench, std::ostream& out);
void WriteReadingsCsv(const std::vector<Reading>& readings, const std::string& bench, const std::string& path);

/// Reads readings.csv. Column order is free, `#` lines are comments, unknown columns are kept. A reading with an
/// empty voltage (or angle that was read) and no other status becomes kMissing. Of a file, times since
/// 1970 become times since the first reading.
/// @param bench  Its name; empty, of a file that comes without a scenario: the one that the columns speak of.
/// @throws InputError with file:line for missing required columns (all are named), a field that is no number, a
///         wrong number of fields, an unknown phase or status, a reading number that comes twice or a time that
///         goes back.
std::vector<Reading> ReadReadingsCsv(const std::string& path, const std::string& bench = "");
std::vector<Reading> ParseReadingsCsv(std::istream& in, const std::string& name, const std::string& bench = "");

}  // namespace twinbench
