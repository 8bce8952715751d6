#include "twin/core/errors.h"

namespace twinbench {

InputError::InputError(const std::string& where, const std::string& what, const std::string& expected)
    : std::runtime_error((where.empty() ? "" : where + ": ") + what + "; expected " + expected),
      fault_(std::make_shared<const InputFault>(InputFault{where, what, expected})) {}

}  // namespace twinbench
