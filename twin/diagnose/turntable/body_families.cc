#include <algorithm>

#include "twin/diagnose/turntable/named_parts.h"

namespace twinbench::diagnose::turntable {

void AddBody(const Context& context, std::vector<Family>& families) {
  families.push_back(Linear("backlash", "", "width", OnAxis(BacklashSignal(*context), kX)));
  if (!context->HasDwell()) return;
  const double soonest_s =
      std::max(context->since_arrival_s.array().isFinite().select(context->since_arrival_s, 1e9).minCoeff(), 0.1);
  Family settling =
      Shaped("settling", kX, {AmplitudeOf("settling", "amplitude")},
             ShapeOf("settling", "time_constant", Ratios(soonest_s / 8.0, std::max(30.0, soonest_s), 14)),
             [context](const Eigen::VectorXd& tau_s) { return SettlingSignal(*context, tau_s[0]); });
  settling.where.clear();
  families.push_back(std::move(settling));
}

}  // namespace twinbench::diagnose::turntable
