#pragma once

#include <array>
#include <string>
#include <vector>

#include "twin/core/scenario.h"

/// What a scenario of the bench freeform_five_axis says.
namespace twinbench {

inline constexpr int kMachineAxes = 5, kBodyErrors = 6, kCubicTerms = 4, kSquarenesses = 7;
inline constexpr std::array<const char*, kMachineAxes> kAxisNames = {"x", "y", "z", "a", "b"};
inline constexpr std::array<const char*, kBodyErrors> kBodyErrorNames = {"tx", "ty", "tz", "rx", "ry", "rz"};
inline constexpr std::array<const char*, kSquarenesses> kSquarenessNames = {"syx", "szx", "szy", "say",
                                                                            "saz", "sbx", "sbz"};
constexpr bool IsRotation(int body_error) {
  return body_error >= 3;
}
constexpr bool IsRotaryAxis(int axis) {
  return axis >= 3;
}

/// c0 + c1 t + c2 t^2 + c3 t^3, t = (coordinate - centre) / half.
using CubicError = std::array<double, kCubicTerms>;

struct MachineSettings {                                                   // [machine]
  double pivot_m = 0.120;                                                  // from the axes A and B to the tip
  std::array<std::array<CubicError, kBodyErrors>, kMachineAxes> errors{};  // [machine.x] tx_um ...
  std::array<double, kSquarenesses> squareness_rad{};
  std::array<double, kMachineAxes> centre = {0.0, 0.0, 0.100, 0.0, 0.0};
  std::array<double, kMachineAxes> half = {0.150, 0.150, 0.100, 12.0 * units::deg, 12.0 * units::deg};
  // [machine.random]: standard deviation of c0 and c1; c2 has 0.7, c3 0.5 of it
  double random_translation_m = 3.0 * units::um;
  double random_rotation_rad = 2.0 * units::arcsec;
  double random_squareness_rad = 5.0 * units::arcsec;
};

struct ArtefactSettings {                                  // [artefact]
  std::array<double, 2> vertex_radius_m = {0.040, 0.080};  // of cells (i, j) with i + j even, odd
  double pitch_m = 0.020;
  std::string form_error;                // OpenEXR of heights over the array; the estimators do not know of it
  int cells = 5;                         // i and j go from -cells to cells
  double mounting_m = 20.0 * units::um;  // standard deviation of where a set-up really stands
  double mounting_rad = 20.0 * units::arcsec;
};

struct QuadrantSettings {  // [qpd]
  double lens_m = 0.050;
  double spot_radius_m = 0.25 * units::mm;  // 1/e^2
  double gap_m = 0.02 * units::mm;
  double sum_V = 5.0;
  double noise_V = 10.0 * units::mV;
};

struct CameraSettings {  // [ccd]
  double object_m = 0.060, image_m = 0.060;
  double alpha_rad = 30.0 * units::deg;
  double pixel_m = 7.0 * units::um;
  double centre_px = 1024.0;
  double noise_px = 0.05;
};

/// How the probe's light is found. All but the first are known to the twin only, not to the estimators.
struct ProbeOpticsSettings {        // [optics]
  std::string fidelity = "traced";  // traced | closed
  std::string spot = "stated";      // stated | beam: of qpd.spot_radius, or as the beam's rays make it
  double beam_radius_m = 0.1e-3;    // 1/e^2, of the waist at the tip
  double wavelength_m = 650.0 * units::nm;
  std::string splitter = "grid";      // grid | stack: whose rays askew leak
  double splitter_p_reflected = 0.0;  // shares of the power
  double splitter_s_transmitted = 0.0;
  double plate_reflected = 0.0;       // of each face
  double plate_retardance_rad = 0.0;  // beyond a quarter wave
  double plate_azimuth_rad = 0.0;     // of its axis, beyond 45 deg
  double plate_tilt_x_rad = 0.0, plate_tilt_y_rad = 0.0;

  /// One spot of the stated size and all of the light in it: then the closed form says the same as the light.
  bool IsPlain() const {
    return spot == "stated" && splitter == "grid" && splitter_p_reflected == 0.0 && splitter_s_transmitted == 0.0 &&
           plate_reflected == 0.0 && plate_retardance_rad == 0.0 && plate_azimuth_rad == 0.0;
  }
};

/// Where the artefact stands on the X slide, nominally.
struct MountSettings {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, yaw_rad = 0.0;
};

/// A ball or an artefact on the table against the tool, whose displacement is read at poses (R-test, probed sphere). How
/// the machine is built may be left open: the commanded positions follow the ball, which tells.
struct DisplacementSettings {        // [displacement]
  std::string topology = "auto";     // auto | table_table | table_head | head_head
  std::string axes;                  // rotary axes from the bed on, of the table, then of the head: "AC", "A-C"
  std::string positions = "auto";    // auto | machine | workpiece: what X, Y and Z are coordinates of
  std::string seen_from = "auto";    // auto | tool | workpiece: on which side the other one is displaced
  std::string frame = "machine";     // machine | table | tool: along whose axes
  double tool_m = 0.0;               // from the head's last axis to the tool's point, where X, Y and Z do not tell
  int highest_order = 4;             // of the component errors of a rotary axis
  double noise_m = 0.0;              // of one reading, standard deviation; 0: from what is left over
};

struct FreeformProcedureSettings {  // [freeform_procedure]
  std::string instrument = "probe";  // probe | displacement: what reads; displacements are imported
  std::vector<MountSettings> mounts = {
      {}, {0.0, 0.0, 0.060, 90.0 * units::deg}, {0.0, 0.0, 0.120, 0.0}, {0.0, 0.0, 0.180, 0.0}};  // one a set-up
  int poses = 100;                                                                                // a set-up
  double angle_rad = 10.0 * units::deg;
  double height_m = 5.0 * units::mm;
  double dither_m = 30.0 * units::um;
  double dither_rad = 0.01 * units::deg;
  std::string path = "joint";  // joint | single: all axes together, or one after the other
  double interval_s = 6.0;     // from reading to reading, or as long as the way to it takes
  double remount_s = 900.0;    // time a set-up takes
};

struct FreeformSettings {
  MachineSettings machine;
  ArtefactSettings artefact;
  QuadrantSettings qpd;
  CameraSettings ccd;
  ProbeOpticsSettings optics;
  DisplacementSettings displacement;
  FreeformProcedureSettings freeform_procedure;

  bool ReadsDisplacements() const { return freeform_procedure.instrument == "displacement"; }
};

/// The bench's own part of a scenario. @throws std::logic_error if it is another bench's.
inline FreeformSettings& FreeformOf(Scenario& scenario) {
  return scenario.own.As<FreeformSettings>();
}
inline const FreeformSettings& FreeformOf(const Scenario& scenario) {
  return scenario.own.As<FreeformSettings>();
}

}  // namespace twinbench
