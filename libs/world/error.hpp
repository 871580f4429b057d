#pragma once

#include <stdexcept>
#include <string>

namespace outrider {

/// Bad configuration or input, thrown once, at the edge. The message names the file, line or key and
/// what was expected; the program prints it and exits with 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace outrider
