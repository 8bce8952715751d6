#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "tests/core/input_error.h"
#include "tests/support/noise.h"

/// An axis under a reference and a device that errs, made with nothing of the program's: the raw files of these
/// tests are printed from it.
namespace twinbench::test {

struct AxisSample {
  double time_s = 0.0, angle_deg = 0.0, shown_deg = 0.0;
  int sense = 1;
};

/// What a device shows too much, by its angle and the sense of the motion.
using AxisError = std::function<double(double angle_deg, int sense)>;

struct AxisMotion {
  double turns = 1.0, speed_deg_s = 20.0, interval_s = 0.05, rest_s = 0.5;
  std::vector<int> passes = {1, -1, 1, -1};
  double noise_deg = 0.002;
  unsigned seed = 1;
};

inline double Cosine(double order, double angle_deg, double phase_deg) {
  return std::cos((order * angle_deg + phase_deg) * 3.14159265358979323846 / 180.0);
}

/// Passes at constant speed, each followed by a rest.
inline std::vector<AxisSample> DriveAxis(const AxisMotion& motion, const AxisError& error) {
  twinbench::test::Noise noise(motion.noise_deg, motion.seed);
  std::vector<AxisSample> samples;
  double time_s = 0.0, angle_deg = 0.0;
  const auto add = [&](int sense) {
    samples.push_back({time_s, angle_deg, angle_deg + error(angle_deg, sense) + noise(), sense});
    time_s += motion.interval_s;
  };
  const double step_deg = motion.speed_deg_s * motion.interval_s;
  for (const int sense : motion.passes) {
    for (int i = 0; i < std::lround(motion.turns * 360.0 / step_deg); ++i) {
      angle_deg += sense * step_deg;
      add(sense);
    }
    for (int i = 0; i < std::lround(motion.rest_s / motion.interval_s); ++i) add(sense);
  }
  return samples;
}

inline double OnceRound(double angle_deg) { return angle_deg - 360.0 * std::floor(angle_deg / 360.0); }

// Raw files in the layouts that other programs write, of an axis of one's own. The layouts are those of real
// samples: TwinCAT scope exports, `camonitor`, PHD2 guide logs, tables of stepper firmwares, `halsampler`, ISO
// 230-2 reports.

inline std::string WithComma(std::string number) {
  std::ranges::replace(number, '.', ',');
  return number;
}

/// Tabs, decimal commas, a full head, two groups with clocks of their own; the reference starts again at a turn.
inline std::string ScopeExport(const std::vector<AxisSample>& samples) {
  std::string text = Contents(TWINBENCH_TEST_DATA "/heads/scope.txt");
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const AxisSample& s = samples[i];
    text += WithComma(
        fmt::format("{:.1f}\t{:.6f}\t{:.6f}", 1000.0 * s.time_s, OnceRound(s.angle_deg), OnceRound(s.shown_deg)));
    if (20 * i < samples.size())
      text += WithComma(
          fmt::format("\t{:.1f}\t{:.3f}", 1000.0 * static_cast<double>(i), 21.0 + 0.001 * static_cast<double>(i)));
    text += "\r\n";
  }
  return text + "EOF\r\n";
}

/// A stamp of `camonitor`, on the morning of some day.
inline std::string Stamp(double time_s) {
  const double second = 9.0 * 3600.0 + time_s;
  const int whole = static_cast<int>(second);
  return fmt::format("2021-10-27 {:02d}:{:02d}:{:09.6f}", whole / 3600, whole / 60 % 60,
                     second - 60 * (whole / 60));
}

/// Values only when they change, each channel with stamps of its own; the device's come `behind_s` later.
inline std::string CamonitorLog(const std::vector<AxisSample>& samples, double behind_s) {
  std::string text =
      "IOC:Axis1-PosSet               2021-10-20 08:00:00.000000 0  \n"
      "IOC:Gone                       *** Not connected (PV not found)\n";
  double last_deg = std::nan("");
  for (const AxisSample& s : samples) {
    if (s.angle_deg != last_deg)
      text += fmt::format("{:<30} {} {:.6f}  \n", "IOC:Axis1-PosSet", Stamp(s.time_s), s.angle_deg);
    last_deg = s.angle_deg;
    text += fmt::format("{:<30} {} {:.6f}  \n", "IOC:m0s004-Enc01-PosAct", Stamp(s.time_s + behind_s), s.shown_deg);
  }
  return text;
}

/// A night of guiding: calibration, then a session in which pulses take out most of the star's motion, and the place where the star
/// is held moves now and then.
/// @param error_arcsec  Of the mount's axis, by its angle [deg].
inline std::string GuideLog(const std::function<double(double)>& error_arcsec, int frames) {
  constexpr double kScale = 2.0, kRate = 6.5, kDec_deg = 30.0;
  twinbench::test::Noise seeing(0.1, 7);
  std::string text = Contents(TWINBENCH_TEST_DATA "/heads/phd2.txt");
  double taken_out_px = 0.0, held_px = 0.0;
  for (int k = 1; k <= frames; ++k) {
    const double time_s = 6.0 * k, angle_deg = 15.041067 * time_s / 3600.0;
    if (k % 400 == 0) {
      text += fmt::format("{},{:.3f},\"DROP\",,,,,,,,,,,,,0,0.00,2,\"Star lost - low SNR\"\n", k, time_s);
      continue;
    }
    if (k % 300 == 150) {
      const double by_px = k % 600 == 150 ? -1.995 : 1.25;
      held_px += by_px;
      text += fmt::format("INFO: SET LOCK POSITION, new lock pos = 423.984, 748.603\nINFO: DITHER by {:.3f}, 0.254, new lock pos = 423.945, 750.613\n"
                          "INFO: SETTLING STATE CHANGE, Settling started\n", by_px);
    }
    const double raw_px =
        error_arcsec(angle_deg) * Cosine(1.0, kDec_deg, 0.0) / kScale - taken_out_px - held_px + seeing();
    const int pulse_ms = std::abs(raw_px) > 0.2 ? static_cast<int>(700.0 * std::abs(raw_px) / kRate) : 0;
    taken_out_px += (raw_px > 0.0 ? 1.0 : -1.0) * pulse_ms / 1000.0 * kRate;
    const char* way = pulse_ms == 0 ? "" : raw_px > 0.0 ? "W" : "E";
    text += fmt::format("{},{:.3f},\"Mount\",{:.3f},0.100,{:.3f},0.050,{:.3f},0.000,{},{},0,,,,1713,28.59,0\n", k,
                        time_s, raw_px, raw_px, 0.7 * raw_px, pulse_ms, way);
  }
  return text + "Guiding Ends at 2022-01-15 22:42:46\n\nLog Summary: calcnt:1 gcnt:1 gdur:19 gacnt:2\n";
}

/// The angle of the motor for every count of its encoder; an older table stands in a comment.
inline std::string FirmwareTable(const AxisError& error, int counts) {
  std::string text = fmt::format(
      "#include \"lookup_table.h\"\n/*\nold\nconst unsigned int lookup[] = {{1 , 2 , 3 , 4}};\n*/\n"
      "const float __attribute__((__aligned__(256))) lookup[{}] = {{\n",
      counts);
  for (int i = 0; i < counts; ++i) {
    const double shown_deg = 360.0 * i / counts;
    double angle_deg = shown_deg;
    for (int k = 0; k < 30; ++k) angle_deg = shown_deg - error(angle_deg, 1);
    text += fmt::format("{:.3f}, ", OnceRound(angle_deg + 63.9));
  }
  return text + "\n};\nfloat zero_electric_angle = 1.25;\n";
}

/// `halsampler -t`: the sample's number and two pins.
inline std::string HalSamples(const std::vector<AxisSample>& samples) {
  std::string text;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i == 1000) text += "overrun\n";
    text += fmt::format("{} {:f} {:f} \n", i, samples[i].angle_deg, samples[i].shown_deg);
  }
  return text;
}

/// Tables of runs forward and backward as a motion report prints them.
/// @param actual_mm  Where the axis came to, by target, sense and run.
inline std::string PositioningReport(const std::vector<double>& target_mm, int runs,
                                     const std::function<double(double, int, int)>& actual_mm) {
  std::string text = "# motion test report\n\n# ISO 230-2 motion test\n\n## Input data\n";
  for (const auto& [name, sense] : {std::pair{"forward", 1}, std::pair{"backward", -1}}) {
    text += fmt::format("\n### Data {} direction\n\ni = Position index []\n\ni |tgt_pos(i) [mm]|", name);
    for (int j = 1; j <= runs; ++j) text += fmt::format("ref_pos(i,{}) [mm]|", j);
    text += "\n--- |---";
    for (int j = 1; j <= runs; ++j) text += " |---";
    text += " |\n";
    for (std::size_t i = 0; i < target_mm.size(); ++i) {
      text += fmt::format("{}|{}|", i + 1, target_mm[i]);
      for (int j = 1; j <= runs; ++j) text += fmt::format("{:.8f}|", actual_mm(target_mm[i], sense, j));
      text += "\n";
    }
  }
  text +=
      "\n\n## ISO230-2 calculations:\n\n#### Positioning deviation forward\n\ni |x(i,1) [mm]|x(i,2) [mm]|\n--- "
      "|--- |--- |\n1|0.1|0.2|\n2|0.1|0.2|\n";
  return text;
}

}  // namespace twinbench::test
