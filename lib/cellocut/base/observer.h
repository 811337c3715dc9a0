// What long work tells its caller, and how the caller stops it.
#pragma once

#include <string_view>

#include "cellocut/base/errors.h"

namespace cellocut {

class Observer {
 public:
  virtual ~Observer() = default;
  // A stage of the pipeline begins. Called from the thread that runs the pipeline.
  virtual void stage(std::string_view /*name*/) {}
  // Share of the current stage that is done, 0 to 1. May be called from any thread.
  virtual void progress(double /*done*/) {}
  // True once the work should be given up. Polled from any thread, so it has to be cheap.
  [[nodiscard]] virtual bool cancelled() const { return false; }

  // Throws Cancelled when the caller wants to stop.
  void check() const {
    if (cancelled()) throw Cancelled();
  }
};

// For callers that neither listen nor stop.
inline Observer& silent_observer() {
  static Observer observer;
  return observer;
}

}  // namespace cellocut
