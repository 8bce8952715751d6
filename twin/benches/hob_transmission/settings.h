#pragma once

#include <optional>
#include <string>
#include <vector>

#include "twin/core/compensation_table.h"
#include "twin/core/scenario.h"

/// What a scenario of the bench hob_transmission says. Defaults: the machine of Tan et al. with a gear of 44 teeth
/// and a hob of two starts; what that paper does not state is assumed.
namespace twinbench {

struct TransmissionSettings {  // [transmission]
  int hob_starts = 2;
  int gear_teeth = 44;  // the table turns starts / teeth for one turn of the hob
  int worm_wheel_teeth = 90;
  int worm_starts = 1;
  std::vector<HarmonicSettings> harmonics;  // of the transmission error, by turns of the table
  int free_orders = 4;                      // an evaluation takes the orders up to this as unknown
  double servo_Hz = 20.0;                   // of the table's drive
  double feed_forward = 1.0;                // of its speed; 1: no lag at constant speed
  double table_inertia_kg_m2 = 20.0;
  double stiffness_Nm_rad = 5e6;  // torsion between worm wheel and table
  double damping_ratio = 0.05;
  double friction_Nm = 0.0;                       // on the table: winds the torsion up, by direction
  double backlash_rad = 0.0;                      // of the worm, full width
  std::string compensation_file;                  // moved to `compensation` by the loader
  std::optional<CompensationTable> compensation;  // added by the gearbox to the table's angle that it commands

  double Ratio() const { return static_cast<double>(hob_starts) / gear_teeth; }
  double HobOrder() const { return static_cast<double>(gear_teeth) / hob_starts; }  // hob turns in one of the table
  double WormOrder() const { return static_cast<double>(worm_wheel_teeth) / worm_starts; }
};

/// A ring with lines and one reading head. Azimuths are on the ring.
struct RingEncoderSettings {  // [table_encoder], [hob_encoder]
  int lines = 18000;
  double radius_m = 100.0 * units::mm;
  double eccentricity_m = 0.0;
  double eccentricity_azimuth_rad = 0.0;
  double tilt_rad = 0.0;
  double tilt_azimuth_rad = 0.0;
  double head_height_m = 0.0;  // of the head above the ring's middle plane
  double ellipticity_m = 0.0;  // half the difference of the largest and the smallest radius
  double ellipticity_azimuth_rad = 0.0;
  std::vector<HarmonicSettings> graduation = {};  // error of its lines, by the ring's own angle
  int interpolation = 100;                        // steps a line
  double noise_rad = 0.0;                         // of one reading, white, standard deviation
};

/// Angle optics on a calibrator that turns back as the table turns: it sees the deviation alone, by the difference
/// of two paths an arm apart.
struct InterferometerSettings {  // [interferometer]
  bool used = true;
  double noise_rad = 0.02 * units::arcsec;
  double misalignment_rad = 0.0;               // of the beam against the way of the reflector: cosine error
  double arm_m = 30.0 * units::mm;             // between the two paths
  double arm_error_m = 0.0;                    // the real arm is longer than the stated one by this
  double dead_path_m = 0.0;                    // by which one path is longer when it is set to zero
  double index_drift_per_h = 0.0;              // of the air's refractive index: 1e-6 a kelvin
  std::vector<HarmonicSettings> calibrator{};  // its own error, by turns of the table
  double u_calibrator_rad = 0.0;               // of either part of an order of that error
  int stops = 0;                               // a turn, at which it is read; 0: with every sample, in motion

  bool IsReadAtRest() const { return stops > 0; }
};

struct HobProcedureSettings {  // [hob_procedure]
  /// Where the mark of the table's ring passes its reading head, from the table's origin; one a set-up.
  std::vector<double> heads_rad = {0.0, units::kPi};
  /// The table's encoder counts from there, or from the table's origin: "reference_mark" or "table_origin".
  std::string encoder_zero = "table_origin";
  std::vector<double> hob_speeds_rad_s = {50.0 * (2.0 * units::kPi / 60.0)};
  std::vector<int> passes = {1, -1};  // directions of the table; at each speed
  int turns = 3;                      // of the table, a pass
  int samples_per_turn = 720;         // every so many edges of the table's encoder one is kept
  double ramp_s = 2.0;
  double rest_s = 2.0;  // behind every pass
  double remount_s = 1800.0;
  int fifo_samples = 1024;
  double poll_s = 0.25;  // the computer empties the FIFO this often
};

struct HobSettings {
  TransmissionSettings transmission;
  RingEncoderSettings table_encoder;
  RingEncoderSettings hob_encoder = {.lines = 9000, .radius_m = 50.0 * units::mm};
  InterferometerSettings interferometer;
  MechanicsSettings mechanics;
  HobProcedureSettings hob_procedure;
};

/// The bench's own part of a scenario. @throws std::logic_error if it is another bench's.
inline HobSettings& HobOf(Scenario& scenario) {
  return scenario.own.As<HobSettings>();
}
inline const HobSettings& HobOf(const Scenario& scenario) {
  return scenario.own.As<HobSettings>();
}

}  // namespace twinbench
