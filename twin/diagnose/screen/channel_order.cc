#include <fmt/format.h>

#include <utility>

#include "twin/diagnose/screen/circumstances.h"
#include "twin/diagnose/screen/tests.h"
#include "twin/diagnose/screen/words.h"

namespace twinbench::diagnose::screen {

/// A converter that is switched from channel to channel may keep a trace of the one before. Channels are scanned in
/// the order of the run, again and again, so that the last comes before the first.
Tests TestChannelOrder(const Sample& sample) {
  const LinearRun& run = sample.run;
  const int channels = run.Channels();
  if (channels < 2) return {};
  Scan scan{std::vector(static_cast<std::size_t>(channels),
                        Eigen::MatrixXd(Eigen::MatrixXd::Zero(run.schedule.Readings(), channels))),
            1};
  ScanWords words{
      "channel order", {}, "a ghost of the channel scanned before, or crosstalk (size at the rim of its range)"};
  for (int c = 0; c < channels; ++c) {
    const int before = (c + channels - 1) % channels;
    scan.shapes[static_cast<std::size_t>(c)].col(c) = Normalised(Predicted(run, before));
    words.items.push_back(fmt::format("what {} showed just before {}",
                                      run.channels[static_cast<std::size_t>(before)],
                                      run.channels[static_cast<std::size_t>(c)]));
  }
  Tests tests;
  Keep(TestScan(sample, scan, words), tests);
  return tests;
}

}  // namespace twinbench::diagnose::screen
