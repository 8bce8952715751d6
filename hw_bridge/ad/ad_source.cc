#include "hw_bridge/ad/ad_source.h"

#include "twin/core/errors.h"
#ifdef TWINBENCH_WITH_IIO
#include "hw_bridge/ad/iio_source.h"
#endif
#ifdef TWINBENCH_WITH_COMEDI
#include "hw_bridge/ad/comedi_source.h"
#endif

namespace twinbench::hw {
namespace {

constexpr const char* kWhere = "[adc]";

void RequireNoCalibrationFile(const AdSettings& settings) {
  if (settings.calibration_file.empty()) return;
  throw InputError(kWhere, "calibration_file = \"" + settings.calibration_file + "\" with kind = \"iio\"",
                   "none: an IIO device applies its own calibration");
}

}  // namespace

bool HasAdDriver([[maybe_unused]] const std::string& kind) {
#ifdef TWINBENCH_WITH_IIO
  if (kind == "iio") return true;
#endif
#ifdef TWINBENCH_WITH_COMEDI
  if (kind == "comedi") return true;
#endif
  return false;
}

std::unique_ptr<AdSource> MakeAdSource(const AdSettings& settings) {
  if (settings.kind == "iio") RequireNoCalibrationFile(settings);
#ifdef TWINBENCH_WITH_IIO
  if (settings.kind == "iio") return MakeIioSource(settings);
#endif
#ifdef TWINBENCH_WITH_COMEDI
  if (settings.kind == "comedi") return MakeComediSource(settings);
#endif
  const bool known = settings.kind == "iio" || settings.kind == "comedi";
  throw InputError(kWhere, "kind = \"" + settings.kind + "\"",
                   known ? "another kind: this build was made without the driver for it" : "\"iio\" or \"comedi\"");
}

}  // namespace twinbench::hw
