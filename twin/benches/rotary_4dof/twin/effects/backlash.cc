#include <algorithm>

#include "twin/benches/rotary_4dof/twin/effects/effects.h"

namespace twinbench::sim {
namespace {

/// The rotor of one table lags behind its drive by `half_width`, on the side it came from. A move takes up the play
/// before the rotor follows. (A servo that rings can carry a rotor over the play as well:
/// `target.backlash_arcsec`.)
class Backlash : public Effect {
 public:
  explicit Backlash(const EffectSettings& e)
      : table_(e.where == "reference" ? 1 : 0), half_width_rad_(Parameter(e, "half_width")) {}

  void Advance(const Moment& moment) override {
    if (moment.departed[table_] != departed_) before_rad_ = offset_rad_;
    departed_ = moment.departed[table_];
    const int direction = table_ == 1 ? moment.reference_direction : moment.target_direction;
    const double taken_up_rad = std::min(moment.travelled_rad[table_], 2.0 * half_width_rad_);
    offset_rad_ = std::clamp(before_rad_ - direction * taken_up_rad, -half_width_rad_, half_width_rad_);
  }
  void AlterPose(const Moment&, PoseState& pose) const override {
    (table_ == 1 ? pose.reference_yaw_rad : pose.target_yaw_rad) += offset_rad_;
  }

 private:
  std::size_t table_;
  double half_width_rad_;
  Time departed_ = Time::min();
  double before_rad_ = 0.0, offset_rad_ = 0.0;  // rotor against drive, before its last move and now
};

}  // namespace

EffectPointer MakeBacklash(const EffectSettings& settings, const Scenario& /*scenario*/) {
  return std::make_unique<Backlash>(settings);
}

}  // namespace twinbench::sim
