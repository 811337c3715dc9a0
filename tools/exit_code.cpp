#include "tools/exit_code.h"

#include <fmt/core.h>

#include <cstdio>
#include <new>

#include "cellocut/base/errors.h"

namespace cellocut::tools {

void print_error(const std::string& what) { fmt::print(stderr, "cellocut: {}\n", what); }

int report_error(const std::exception& error, const std::string& input) {
  const auto say = [](const std::string& file, const char* what) {
    print_error(file.empty() ? what : file + ": " + what);
  };
  if (const auto* bad_input = dynamic_cast<const InputError*>(&error)) {
    say(bad_input->file().empty() ? input : bad_input->file(), error.what());
    return kBadInput;
  }
  if (const auto* output = dynamic_cast<const OutputError*>(&error)) {
    say(output->file(), error.what());
    return kLimit;
  }
  if (dynamic_cast<const UsageError*>(&error) != nullptr) {
    say({}, error.what());
    return kUsage;
  }
  if (dynamic_cast<const GuaranteeError*>(&error) != nullptr) {
    say(input, error.what());
    return kNoGuarantee;
  }
  if (dynamic_cast<const LimitError*>(&error) != nullptr) {
    say(input, error.what());
    return kLimit;
  }
  if (dynamic_cast<const Cancelled*>(&error) != nullptr) {
    say(input, error.what());
    return kInterrupted;
  }
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    say(input, "out of memory; try a lower --resolution");
    return kLimit;
  }
  say(input, error.what());
  return kNoGuarantee;
}

}  // namespace cellocut::tools
