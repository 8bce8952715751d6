#pragma once

#include "twin/core/reading.h"
#include "twin/separate/position_error.h"

/// Worktable and hob spindle of a gear hobbing machine, coupled by a ratio, each with a ring encoder.
///
/// Everywhere in this folder: `th` is the angle of the table from its origin [rad]; e_T(th) the transmission error;
/// psi the error of the table's ring encoder in its own angle, so that a reading head at alpha_p shows
///
///   m_p(th) = e_T(th) + psi(th - alpha_p)
///
/// A periodic function is written x(th) = Re sum_k C_k exp(j k th): |C_k| is the amplitude and arg C_k the phase of
/// the cosine of order k. Reference: Tan, Wang, Ren, Yang, two-position method for hobbing machines, equations 1
/// to 15.
namespace twinbench::separate::hob {

using namespace harmonics;  // of the turn of the table

/// Both encoders at one instant. An angle that is not finite is a sample that is missing.
struct HobSample {
  int setup = 0;                    // changes whenever ring and head were turned to another place
  int pass = 0;                     // within one pass both angles are counted without a break
  int direction = 1;                // +1: the table's angle increases; -1
  double table_encoder_rad = kNaN;  // unwrapped
  double hob_encoder_rad = kNaN;    // unwrapped
  double head_rad = kNaN;  // reading head (and the ring's reference mark) from the table's origin; one a set-up
  double interferometer_rad =
      kNaN;  // optional: transmission error as the interferometer sees it, any constant added
  bool is_at_rest = false;
};

/// What the head sees of the ring, from its mark on.
/// @param from_origin  The encoder counts from the table's origin.
inline double RingAngle_rad(const HobSample& s, bool from_origin) {
  return s.table_encoder_rad - (from_origin ? s.head_rad : 0.0);
}

/// Where the table encoder counts from.
enum class EncoderZero {
  kTableOrigin,    // th = table encoder
  kReferenceMark,  // th = table encoder + head: it counts from the mark, which passes the head there
};

}  // namespace twinbench::separate::hob
