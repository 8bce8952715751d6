#pragma once

#include "hw_bridge/control/instrument.h"
#include "hw_bridge/numbers/number_source.h"

namespace twinbench::hw {

/// An instrument whose numbers are read in a card or behind a gateway. It latches nothing, and is read with every
/// look.
class NumberInstrument : public Instrument {
 public:
  /// @param names, scale, columns, where  As of Instrument, one a number of the source.
  NumberInstrument(std::unique_ptr<NumberSource> source, const std::vector<std::string>& names,
                   const std::vector<double>& scale, const std::vector<ReadingColumn>& columns,
                   const std::string& where);
  Reading Read() override;

 private:
  std::unique_ptr<NumberSource> source_;
};

}  // namespace twinbench::hw
