#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "twin/core/scenario.h"
#include "twin/core/time.h"

/// What a scenario of the bench turntable_autocollimator says beside the errors of its two tables. Defaults: the
/// instruments of Guo et al. (2014); what that paper does not state is assumed.
namespace twinbench {

struct MultitoothSettings {  // [multitooth], beside its errors as a table
  int teeth = 360;
  double tooth_rms_rad = 0.1 * units::arcsec;  // of errors that differ from tooth to tooth
  double u_tooth_rad = 0.15 * units::arcsec;   // stated standard uncertainty of a tooth
  double index_time_s = 4.0;                   // to lift, turn and seat it
};

/// A polygon in the place of the multi-tooth table: its faces, each a mirror as [mirror] says, are nulled one after
/// the other by turning the turntable.
struct PolygonSettings {                        // [polygon]
  int faces = 0;                                // 0: there is none
  std::vector<double> face_errors_rad = {0.0};  // of the face angles, one a face or one for all
  double face_rms_rad = 0.0;                    // of what is drawn on top of them
  double pyramid_rms_rad = 0.0;                 // of the faces' tilts against the polygon's axis
};

struct TurntableEncoderSettings {  // [encoder]: what its reading adds to the turntable's errors
  double noise_rad = 0.0;
  double step_rad = 0.0;  // least count
};

struct MirrorSettings {  // [mirror]
  double width_m = 60.0 * units::mm;
  double height_m = 60.0 * units::mm;
  double flatness_m = 0.0;             // sag over the width; positive: hollow
  double radius_m = 40.0 * units::mm;  // its surface from the multi-tooth table's axis
};

struct CollimatorSettings {  // [autocollimator], beside its noise, range and gain error
  double distance_m = 0.35;  // objective from the turntable's axis
  double focal_length_m = 0.3;
  double aperture_m = 30.0 * units::mm;  // diameter
  double roll_rad = 0.0;                 // of the crosshair: x' = x + y' sin roll
  double error_at_edge_rad = 0.0;        // grows with the cube of the angle to this at the range's edge
  double pixel_pitch_m = 5.0 * units::um;
  double interpolation_error_px = 0.0;  // amplitude, with the period of a pixel
  double x_per_kelvin_rad = 0.0;        // zero, against environment.reference_degC
  double y_per_kelvin_rad = 0.0;
  double deadband_rad = 0.05 * units::arcsec;  // of the servo that nulls it: x up to this counts as zero
  int frames = 1;         // of the camera, whose mean is one reading: its noise is less by their root
  double frame_s = 0.05;  // from one to the next

  /// From the first frame of a reading to its middle, which its time is.
  Duration HalfReading() const { return FromSeconds(0.5 * (frames - 1) * frame_s); }
};

/// Lists with one entry a set-up; one entry alone holds for all of them.
struct TurntableProcedureSettings {                                   // [turntable_procedure]
  std::vector<std::string> phases = {"full_circle", "verification"};  // of calibration, full_circle, verification
  int positions = 72;
  std::vector<double> tilts_rad = {60.0 * units::arcsec, 100.0 * units::arcsec};  // of the multi-tooth table's axis
  std::vector<double> tilt_azimuths_rad = {0.0};              // on the turntable: where it leans to
  std::vector<int> shifts = {0};                              // shifts_teeth of the multi-tooth table
  std::vector<double> eccentricities_m = {50.0 * units::um};  // of the multi-tooth table's axis, along the azimuth
  std::vector<int> passes = {1, -1};                          // directions
  std::vector<double> dwell_s = {1.0};                        // drawn at random from this list at every stop
  double run_up_steps = 0.5;                                  // every pass comes to its first stop from this far
  std::vector<double> polygon_offsets_rad = {0.0};            // of the turntable where the polygon's face 0 is seen
  int highest_order = 12;                    // of the encoder's error that is fitted to a polygon's faces
  double remount_s = 600.0;                  // time a set-up takes
  double sweep_rad = 200.0 * units::arcsec;  // calibration: the turntable alone, +- this about position 0
  int sweep_points = 9;
  int verification_positions = 144;  // whole teeth off the grid of positions
  std::vector<int> verification_passes = {1};

  int SetUps() const;  // the length of the longest list
  template <class Value>
  static Value Of(const std::vector<Value>& list, int setup) {
    return list.size() == 1 ? list.front() : list.at(static_cast<std::size_t>(setup));
  }
};

inline int TurntableProcedureSettings::SetUps() const {
  std::size_t most = tilts_rad.size();
  for (const std::size_t length :
       {tilt_azimuths_rad.size(), shifts.size(), eccentricities_m.size(), polygon_offsets_rad.size()})
    most = length > most ? length : most;
  return static_cast<int>(most);
}

struct TurntableSettings {
  TableSettings turntable;         // the table under test
  TableSettings multitooth_table;  // the reference: its errors as a table ...
  MultitoothSettings multitooth;   // ... and its teeth
  MechanicsSettings mechanics;
  MirrorSettings mirror;
  AutocollimatorSettings autocollimator;
  CollimatorSettings collimator;
  PolygonSettings polygon;
  TurntableEncoderSettings encoder;
  TurntableProcedureSettings turntable_procedure;

  /// Of one reading.
  double ReadingNoise_rad() const { return autocollimator.noise_rad / std::sqrt(collimator.frames); }
  bool HasPolygon() const { return polygon.faces > 0; }
  /// Standard uncertainty of a tooth: no less than what teeth are said to err at random.
  double Tooth_rad() const {
    return std::max(multitooth.u_tooth_rad,
                    std::hypot(multitooth.tooth_rms_rad,
                               multitooth_table.random_rms[static_cast<std::size_t>(Component::kEz)]));
  }
  /// Places, a turn, to which what stands on the turntable turns its mirror: teeth or faces.
  int Seats() const { return HasPolygon() ? polygon.faces : multitooth.teeth; }
  double Pitch_rad() const { return units::turn / Seats(); }
  /// Number of the face that is seen at a position of the circle.
  int FaceAt(int position) const { return position * (polygon.faces / turntable_procedure.positions); }
  /// Nominal angle of the turntable at which a face of the polygon is seen; unwrapped.
  double FaceAngle_rad(int setup, int face) const {
    return turntable_procedure.Of(turntable_procedure.polygon_offsets_rad, setup) + face * Pitch_rad();
  }
};

/// The bench's own part of a scenario. @throws std::logic_error if it is another bench's.
inline TurntableSettings& TurntableOf(Scenario& scenario) {
  return scenario.own.As<TurntableSettings>();
}
inline const TurntableSettings& TurntableOf(const Scenario& scenario) {
  return scenario.own.As<TurntableSettings>();
}

}  // namespace twinbench
