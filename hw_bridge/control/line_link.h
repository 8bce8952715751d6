#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hw_bridge/control/address.h"
#include "twin/core/device_fault.h"
#include "twin/core/time.h"

namespace twinbench::hw {

/// What came of one step on a link.
struct LinkResult {
  std::string line;                  // without its end
  std::optional<FaultKind> failure;  // kTimeout: nothing (whole) in time; kDropped: the other side has closed;
                                     // kProtocol: more than a line can be long
  std::string why;                   // of the failure
};

/// One open connection that carries lines, over TCP or a serial line. Closed when it goes; after a failure there is
/// nothing else to do with it. Real time: every call returns within its `patience`.
class LineLink {
 public:
  virtual ~LineLink() = default;
  /// Sends `text` as it is.
  virtual LinkResult Send(const std::string& text, Duration patience) = 0;
  /// A line counts only with its end: LF or CR LF, unless another was named.
  virtual LinkResult ReadLine(Duration patience) = 0;
  /// @param end  Of every line that comes from here on; empty: any CR and LF, and blank lines count for nothing.
  virtual void EndLinesWith(const std::string& end) = 0;
  /// Whether something has come that no ReadLine has taken, and that it would take.
  virtual bool HasUnread() = 0;
  /// Reads and forgets until nothing has come for `quiet`, or `patience` is over.
  virtual void ReadAway(Duration quiet, Duration patience) = 0;
};

struct OpenedLink {
  std::unique_ptr<LineLink> link;    // or
  std::optional<FaultKind> failure;  // kTimeout: nobody there; kDropped: refused, no such device
  std::string why;
};
OpenedLink OpenLink(const Address& address, Duration patience);

}  // namespace twinbench::hw
