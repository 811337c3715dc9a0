#include "cellocut/image/network.h"

#include <cmath>

#include "cellocut/base/errors.h"

namespace cellocut {

void NetworkInput::validate() const {
  if (size < 0 || size > 4096) throw InputError("size must be 0 to 4096");
  for (int c = 0; c < 3; ++c) {
    if (!std::isfinite(mean[c])) throw InputError("mean must be three finite numbers");
    if (!std::isfinite(deviation[c]) || deviation[c] == 0) {
      throw InputError("std must be three numbers other than 0");
    }
  }
}

}  // namespace cellocut
