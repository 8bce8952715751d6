#include "tests/foreign/stand_fault.h"

namespace twinbench::foreign {

StandFault Moving(Truth truth, double Disturbed::*member, std::function<double(const StandStop&)> shape) {
  return {std::move(truth), [=](const StandRun& run, double size, std::vector<Disturbed>& all) {
            for (std::size_t i = 0; i < run.size(); ++i) all[i].*member += size * shape(run[i]);
          }};
}

StandFault Shining(Truth truth, double Light::*member, std::function<double(const StandStop&)> shape) {
  return {std::move(truth), [=](const StandRun& run, double size, std::vector<Disturbed>& all) {
            for (std::size_t i = 0; i < run.size(); ++i) all[i].light.*member += size * shape(run[i]);
          }};
}

StandFault OnChannel(Truth truth, int channel, std::function<double(const StandStop&, double shown_m)> shape) {
  return {std::move(truth), {}, [=](const StandRun& run, double size, Eigen::MatrixX4d& shown_m) {
            for (std::size_t i = 0; i < run.size(); ++i) {
              double& value = shown_m(static_cast<Eigen::Index>(i), channel);
              value += size * shape(run[i], value);
            }
          }};
}

std::string ChannelName(int channel) {
  return kChannelNames[static_cast<std::size_t>(channel)];
}

}  // namespace twinbench::foreign
