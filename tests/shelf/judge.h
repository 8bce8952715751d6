#pragma once

#include <optional>

#include "twin/diagnose/diagnosis.h"

/// What is in the recordings of tests/data/shelf, and what may be said of them: truth.json. A diagnosis held
/// against it; and recordings as people have them, imported by a plain guess, then diagnosed, as the two commands
/// do it.
namespace twinbench::shelf {

/// One cause. A linear axis counts as `twinbench import` takes it: 360 mm are a turn, a millimetre is a degree.
struct Expected {
  std::vector<std::string> effects =
      {};  // of the catalogue, any of them; of an order every effect with that order too
  /// Of an unmodelled part, any of them, what the catalogue has no name for; behind "^" what the part begins with.
  std::vector<std::string> words = {};
  double order = kNaN;         // periods per turn
  std::string parameter = {};  // whose size it is, where it is not the effect's first
  double size = kNaN;          // NaN: not asked for; of an order, its amplitude; of a play, forward less backward
  std::string unit = {};
  /// Where several causes stand for each other: other sizes that are as right, in their units.
  std::vector<std::pair<double, std::string>> others = {};
  double at_deg = kNaN;  // of a scale: where on the axis it is that large
  double over_s = kNaN;  // of a drift: in how long it comes to its size
  double share = 0.0;    // of the variance of the error; 0: not known
  bool approximate = false;

  /// More than a twentieth of the variance: it must be named.
  bool IsWanted() const { return share > 0.05; }
};

struct Truth {
  std::vector<Expected> causes = {};
  /// What may be named besides.
  std::vector<std::pair<double, double>> orders = {};  // and amplitude, deg
  double any_order_below_deg = 0.0;                    // the rows hold many
  std::vector<std::string> effects = {}, words = {};
  bool has_rest = false;      // structure without a name: an unmodelled part may say anything
  bool nothing_else = false;  // any other cause is none
};

/// @throws InputError if the file has no such case, or a key that is none.
Truth ReadTruth(const std::string& path, const std::string& name);

struct Size {
  double value = kNaN, u = kNaN;  // SI; of a length, the angle it counts as
  std::string kind;               // "angle", "time", "ratio", "rate"
};

/// @throws InputError if there is no such unit.
Size InSI(double size, const std::string& unit);

/// Order of what a cause does once, twice or k times a turn; NaN if it does nothing of the kind.
double OrderOf(const diagnose::Cause& cause);

/// The amplitude of one order that a cause has: of faults of the signals, to first order or by their curve. Nothing
/// if it has no such order, or no size is told.
std::optional<Size> AmplitudeOf(const diagnose::Cause& cause, double order);

/// Of all causes of one order together, as far as amplitude and phase are told: one may be named in two pieces.
std::optional<Size> AmplitudeTogether(const std::vector<diagnose::Cause>& causes, double order);

/// What is told of a cause in place of the expected size: its amplitude, first parameter, ... Nothing if it is not
/// told.
std::optional<Size> SizeOf(const diagnose::Cause& cause, const Expected& expected);

/// The orders are as good as the same.
bool IsSameOrder(double a, double b);

inline constexpr double kNamed = 0.5;  // a cause, with all that these readings cannot tell from it
inline constexpr double kSure = 0.8;   // from here on what is not there must not be said

struct Judged {
  bool is_right = false;
  bool is_sure_wrong = false;  // something is stated as sure that is not there
  std::string why;             // in words, of what is not right; empty if all is
};

/// Right if every cause above a twentieth of the variance is named - alone or in a tie, that is named together -
/// with its size within three standard uncertainties or 5 % (10 % where the truth is approximate), or is told of as
/// an unmodelled part if the catalogue lacks it; and if nothing else is stated as sure. The size of a cause of a
/// tie that is told without one is not asked for. Of readings in which nothing is, nothing may be named.
Judged Judge(const Truth& truth, const diagnose::Diagnosis& diagnosis);

/// "latency", "order 4", "direction times order 72".
std::string InWords(const Expected& expected);
std::string InWords(const Truth& truth);

/// Numbers of the files in tests/data/shelf, in order.
std::vector<std::string> CaseNames();

struct Answer {
  Judged judged;
  std::string truth, words;  // in words; of a file that is refused, why
  std::optional<std::string>
      second;  // what a second diagnosis with the written file says; nothing: it was not asked
};

/// @param asks_again  Diagnose the same readings with the written file, with thresholds that are kept.
Answer Examine(const std::string& name, bool asks_again);

}  // namespace twinbench::shelf

