#include "hw_bridge/numbers/number_instrument.h"

#include <cmath>

#include "twin/core/device_fault.h"
#include "twin/core/number_text.h"

namespace twinbench::hw {

NumberInstrument::NumberInstrument(std::unique_ptr<NumberSource> source, const std::vector<std::string>& names,
                                   const std::vector<double>& scale, const std::vector<ReadingColumn>& columns,
                                   const std::string& where)
    : Instrument(names, scale, columns, where), source_(std::move(source)) {}

/// A float that is none, or not finite, is how a register says that nothing is shown.
Reading NumberInstrument::Read() {
  static const std::vector<std::string> nothing;
  const std::vector<double> numbers = source_->Read();
  Reading sample;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (!std::isfinite(numbers[k])) {
      sample.status = ReadingStatus::kNoLight;
    } else if (!Put(fields()[k], PrintInUnit(numbers[k], 1.0), nothing, sample)) {
      throw DeviceFault(FaultKind::kProtocol, source_->Identity(), "shows what is no " + fields()[k].name);
    }
  }
  return sample;
}

}  // namespace twinbench::hw
